#pragma once

#include <QObject>
#include <QTimer>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ui/services.h"
#include "ui/session/worker.h"

namespace lamella::ui {

class Session;

/// Tells the mesh to expect, while nothing else runs: on demand, and anew after every edit of a
/// study that has sizing objects.
class Forecaster : public QObject {
  Q_OBJECT

 public:
  explicit Forecaster(Session& session);

  /// Forecasts now, and from now on after every edit.
  void ask();
  bool busy() const { return worker_.busy(); }
  /// Nothing while it is not known or out of date.
  const std::optional<std::vector<BodyForecast>>& bodies() const { return bodies_; }
  MeshForecast total() const;  ///< of all bodies; memory of the largest, MB
  /// A sentence or two for people.
  QString description() const;

 Q_SIGNALS:
  void changed();

 private:
  void follow();
  void start();

  Session& session_;
  QTimer wait_;
  bool asked_ = false;
  bool again_ = false;
  std::string known_for_;  // the study of `bodies_`, as text
  std::optional<std::vector<BodyForecast>> bodies_;
  QString failure_;
  std::shared_ptr<const std::vector<Part>> parts_;  // of the first meshes
  std::uint64_t seed_ = 0;
  std::shared_ptr<const std::vector<FirstMesh>> first_;
  Worker worker_;  // last: its destructor waits for the job that uses the rest
};

}  // namespace lamella::ui
