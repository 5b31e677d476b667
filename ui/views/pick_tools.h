#pragma once

#include <vtkActor.h>
#include <vtkSmartPointer.h>

#include <QPointF>
#include <QRectF>
#include <QString>
#include <optional>
#include <vector>

#include "ui/views/scene.h"

class QMouseEvent;
class QPainter;

namespace lamella::ui {

class Actions;
class Session;
class VtkView;

/// What a click in the view does in each of its modes, and what it leaves drawn over the picture:
/// measured distances, a metric as an ellipsoid, a marked place.
class PickTools {
 public:
  PickTools(Session& session, Actions& actions, VtkView& view, Scene& scene);
  ~PickTools();

  /// True when the event was meant for a tool that drags; a click is told by `click`.
  bool mouse(QMouseEvent* event);
  /// True when a mode took the click.
  bool click(const std::optional<Picked>& picked);
  /// Marks a place, until another one or `forget`.
  void mark(const Vec<3>& at, const QString& text);
  /// Drops what was measured and marked.
  void forget();
  void paint(QPainter& painter) const;
  /// What to do next in the mode that is on; empty without one.
  QString hint() const;

 private:
  void pick_face(const Picked& picked);
  void flood_from(const Picked& picked);
  void show_metric(const Picked& picked);
  double diagonal_of(int part) const;

  Session& session_;
  Actions& actions_;
  VtkView& view_;
  Scene& scene_;
  std::vector<Vec<3>> measured_;  // one to three places
  vtkSmartPointer<vtkActor> ellipsoid_;
  Vec<3> metric_at_ = Vec<3>::Zero();
  QString metric_text_;
  std::optional<Vec<3>> place_;
  QString place_text_;
  std::optional<QPointF> corner_;  // of the box to zoom to
  QPointF opposite_;
};

}  // namespace lamella::ui
