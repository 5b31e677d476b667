#pragma once

#include <QObject>
#include <memory>
#include <vector>

#include "ui/services.h"
#include "ui/session/worker.h"

namespace lamella::ui {

class Session;

/// The wall thickness on the surfaces of the bodies, measured before there is a mesh: while it is
/// wanted and nothing else runs.
class WallMap : public QObject {
  Q_OBJECT

 public:
  using Maps = std::vector<std::shared_ptr<const ThicknessMap>>;

  explicit WallMap(Session& session);

  void want(bool on);
  /// Stops measuring, until it is wanted anew or there are other surfaces.
  void stop();
  bool busy() const { return worker_.busy(); }
  /// One a body of the session, null where there is no surface; empty while not known.
  const Maps& maps() const { return maps_; }
  /// Why there are none, for people; empty: nobody asked.
  QString status() const;

 Q_SIGNALS:
  void changed();

 private:
  void follow();

  Session& session_;
  bool wanted_ = false;
  bool stopped_ = false;
  int percent_ = 0;
  Maps maps_;
  QString failure_;
  std::shared_ptr<const std::vector<Part>> known_for_;
  std::shared_ptr<const std::vector<Part>> measured_;  // by the worker
  Worker worker_;  // last: its destructor waits for the job that uses the rest
};

}  // namespace lamella::ui
