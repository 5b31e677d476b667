#include "ui/views/size_tool.h"

#include <vtkCamera.h>
#include <vtkRenderer.h>

#include <QMouseEvent>
#include <QPainter>
#include <QPolygonF>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "ui/theme.h"
#include "ui/views/vtk_view.h"

namespace lamella::ui {
namespace {

constexpr double grip_pixels = 11;
constexpr double smallest = 1e-4;  // mm

}  // namespace

SizeTool::SizeTool(VtkView& view, Changed changed) : view_(view), changed_(std::move(changed)) {}

std::vector<Vec<3>> SizeTool::knobs() const {
  if (!shape_) return {};
  if (const auto* s = std::get_if<SphereShape>(&*shape_)) {
    // The outer knob is to the right of the center, as seen.
    const QPointF c = view_.project(s->center);
    Vec<3> right = view_.unproject(c + QPointF(100, 0), s->center) - s->center;
    return {s->center, s->center + s->radius * right.normalized()};
  }
  if (const auto* b = std::get_if<BoxShape>(&*shape_)) {
    const Vec<3> x = b->x_axis.normalized();
    const Vec<3> y = (b->y_axis - b->y_axis.dot(x) * x).normalized();
    return {b->center, b->center + 0.5 * b->size[0] * x, b->center + 0.5 * b->size[1] * y,
            b->center + 0.5 * b->size[2] * x.cross(y)};
  }
  if (const auto* c = std::get_if<CylinderShape>(&*shape_)) {
    const Vec<3> middle = 0.5 * (c->from + c->to);
    return {middle, c->from, c->to, middle + c->radius * (c->to - c->from).unitOrthogonal()};
  }
  return {};
}

SizingShape SizeTool::moved(std::size_t knob, const Vec<3>& to) const {
  SizingShape shape = *start_;
  if (auto* s = std::get_if<SphereShape>(&shape)) {
    if (knob == 0)
      s->center = to;
    else
      s->radius = std::max(smallest, (to - s->center).norm());
  } else if (auto* b = std::get_if<BoxShape>(&shape)) {
    if (knob == 0) {
      b->center = to;
    } else {
      const Vec<3> x = b->x_axis.normalized();
      const Vec<3> y = (b->y_axis - b->y_axis.dot(x) * x).normalized();
      const Vec<3> axes[] = {x, y, x.cross(y)};
      const int k = static_cast<int>(knob) - 1;
      b->size[k] = std::max(smallest, 2 * std::abs((to - b->center).dot(axes[k])));
    }
  } else if (auto* c = std::get_if<CylinderShape>(&shape)) {
    if (knob == 0) {
      const Vec<3> by = to - 0.5 * (c->from + c->to);
      c->from += by;
      c->to += by;
    } else if (knob == 3) {
      const Vec<3> axis = (c->to - c->from).normalized();
      const Vec<3> arm = to - c->from;
      c->radius = std::max(smallest, (arm - arm.dot(axis) * axis).norm());
    } else {
      Vec<3>& end = knob == 1 ? c->from : c->to;
      const Vec<3>& other = knob == 1 ? c->to : c->from;
      if ((to - other).norm() > smallest) end = to;
    }
  }
  return shape;
}

bool SizeTool::mouse(QMouseEvent* event) {
  if (!shape_) {
    held_ = hover_ = -1;
    return false;
  }
  const std::vector<Vec<3>> at = knobs();
  int under = -1;
  double nearest = grip_pixels;
  for (std::size_t k = 0; k < at.size(); ++k) {
    const QPointF d = event->position() - view_.project(at[k]);
    if (std::hypot(d.x(), d.y()) >= nearest) continue;
    nearest = std::hypot(d.x(), d.y());
    under = static_cast<int>(k);
  }
  if (event->type() == QEvent::MouseButtonPress && event->button() == Qt::LeftButton &&
      event->modifiers() == Qt::NoModifier) {
    held_ = under;
    start_ = shape_;
    if (held_ >= 0) ++drags_;
    return held_ >= 0;
  }
  if (event->type() == QEvent::MouseButtonRelease) {
    const bool had = held_ >= 0;
    held_ = -1;
    return had;
  }
  if (event->type() != QEvent::MouseMove) return false;
  if (held_ < 0) {
    if (event->buttons() == Qt::NoButton && under != hover_) {
      hover_ = under;
      view_.setCursor(under < 0 ? Qt::ArrowCursor : Qt::OpenHandCursor);
    }
    return false;
  }
  const auto knob = static_cast<std::size_t>(held_);
  if (knob < at.size()) changed_(moved(knob, view_.unproject(event->position(), at[knob])), drags_);
  return true;
}

std::vector<QPolygonF> SizeTool::outline() const {
  std::vector<QPolygonF> lines;
  const auto ring = [&](const Vec<3>& center, const Vec<3>& u, const Vec<3>& v) {
    constexpr int count = 64;
    QPolygonF line;
    for (int k = 0; k <= count; ++k) {
      const double a = 2 * std::numbers::pi * k / count;
      line << view_.project(center + std::cos(a) * u + std::sin(a) * v);
    }
    lines.push_back(line);
  };
  if (const auto* s = std::get_if<SphereShape>(&*shape_)) {
    const QPointF c = view_.project(s->center);
    const Vec<3> u = (view_.unproject(c + QPointF(100, 0), s->center) - s->center).normalized();
    const Vec<3> v = (view_.unproject(c + QPointF(0, 100), s->center) - s->center).normalized();
    ring(s->center, s->radius * u, s->radius * v);
  } else if (const auto* b = std::get_if<BoxShape>(&*shape_)) {
    const Vec<3> x = b->x_axis.normalized();
    const Vec<3> y = (b->y_axis - b->y_axis.dot(x) * x).normalized();
    const Vec<3> z = x.cross(y);
    const auto corner = [&](int k) {
      return view_.project(b->center + ((k & 1) - 0.5) * b->size[0] * x +
                           (((k >> 1) & 1) - 0.5) * b->size[1] * y +
                           (((k >> 2) & 1) - 0.5) * b->size[2] * z);
    };
    for (int k = 0; k < 8; ++k)
      for (const int axis : {1, 2, 4})
        if (!(k & axis)) lines.push_back(QPolygonF() << corner(k) << corner(k | axis));
  } else if (const auto* c = std::get_if<CylinderShape>(&*shape_)) {
    const Vec<3> axis = (c->to - c->from).normalized();
    const Vec<3> u = c->radius * axis.unitOrthogonal();
    const Vec<3> v = axis.cross(u);
    ring(c->from, u, v);
    ring(c->to, u, v);
  }
  return lines;
}

void SizeTool::paint(QPainter& painter) const {
  const std::vector<Vec<3>> at = knobs();
  if (at.empty()) return;
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  // Also where the shape is hidden by the part.
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(QColor(255, 255, 255, 150), 3.5));
  const std::vector<QPolygonF> lines = outline();
  for (const QPolygonF& line : lines) painter.drawPolyline(line);
  painter.setPen(QPen(theme::warning, 1.6));
  for (const QPolygonF& line : lines) painter.drawPolyline(line);
  const QPointF center = view_.project(at[0]);
  for (std::size_t k = 1; k < at.size(); ++k) {
    painter.setPen(QPen(theme::warning, 1.2, Qt::DashLine));
    painter.drawLine(center, view_.project(at[k]));
  }
  for (std::size_t k = 0; k < at.size(); ++k) {
    const bool lit = static_cast<int>(k) == (held_ >= 0 ? held_ : hover_);
    painter.setPen(QPen(Qt::white, 2));
    painter.setBrush(lit ? theme::warning.darker(120) : theme::warning);
    const double r = (k == 0 ? 7 : 5.5) + (lit ? 1 : 0);
    painter.drawEllipse(view_.project(at[k]), r, r);
  }
  painter.restore();
}

}  // namespace lamella::ui
