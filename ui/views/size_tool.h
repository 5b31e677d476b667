#pragma once

#include <QPointF>
#include <QPolygonF>
#include <functional>
#include <optional>
#include <vector>

#include "core/sizing/sizing_object.h"

class QMouseEvent;
class QPainter;

namespace lamella::ui {

class VtkView;

/// The knobs of the selected size: the inner one moves the shape in the plane of the screen, the
/// outer ones change its extent.
class SizeTool {
 public:
  /// `drag` counts the presses, so that one drag can be one step to undo.
  using Changed = std::function<void(const SizingShape&, int drag)>;

  SizeTool(VtkView& view, Changed changed);

  /// The shape that has the knobs, or none.
  void set(const std::optional<SizingShape>& shape) { shape_ = shape; }
  /// True when the event was meant for a knob.
  bool mouse(QMouseEvent* event);
  void paint(QPainter& painter) const;

 private:
  std::vector<Vec<3>> knobs() const;
  std::vector<QPolygonF> outline() const;
  SizingShape moved(std::size_t knob, const Vec<3>& to) const;

  VtkView& view_;
  Changed changed_;
  std::optional<SizingShape> shape_;
  std::optional<SizingShape> start_;
  int held_ = -1;
  int hover_ = -1;
  int drags_ = 0;
};

}  // namespace lamella::ui
