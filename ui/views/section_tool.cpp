#include "ui/views/section_tool.h"

#include <QMouseEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>

#include "ui/theme.h"
#include "ui/views/vtk_view.h"

namespace lamella::ui {
namespace {

constexpr double shaft_pixels = 74;
constexpr double grip_pixels = 12;
/// A turned plane snaps to an axis within this angle, as a cosine (4 degrees).
constexpr double snap_cosine = 0.9976;

double distance_to_segment(const QPointF& p, const QPointF& a, const QPointF& b) {
  const QPointF ab = b - a;
  const double length2 = QPointF::dotProduct(ab, ab);
  const double t =
      length2 > 0 ? std::clamp(QPointF::dotProduct(p - a, ab) / length2, 0.0, 1.0) : 0.0;
  const QPointF d = p - (a + t * ab);
  return std::hypot(d.x(), d.y());
}

Vec<3> snapped(const Vec<3>& n) {
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(n[axis]) > snap_cosine) return Vec<3>::Unit(axis) * (n[axis] > 0 ? 1 : -1);
  return n;
}

}  // namespace

std::vector<Vec<3>> box_section(const std::array<double, 6>& box, const Section& section,
                                double margin) {
  Vec<3> low(box[0], box[2], box[4]);
  Vec<3> high(box[1], box[3], box[5]);
  const double grow = margin * (high - low).norm();
  low.array() -= grow;
  high.array() += grow;
  const auto corner = [&](int k) {
    return Vec<3>(k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]);
  };
  std::vector<Vec<3>> points;
  for (int k = 0; k < 8; ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      if (k & (1 << axis)) continue;
      const Vec<3> a = corner(k);
      const Vec<3> b = corner(k | (1 << axis));
      const double da = (a - section.origin).dot(section.normal);
      const double db = (b - section.origin).dot(section.normal);
      if ((da > 0) != (db > 0)) points.push_back(a + (b - a) * (da / (da - db)));
    }
  }
  if (points.size() < 3) return {};
  Vec<3> middle = Vec<3>::Zero();
  for (const Vec<3>& p : points) middle += p;
  middle /= static_cast<double>(points.size());
  const Vec<3> u = (points.front() - middle).normalized();
  const Vec<3> v = section.normal.cross(u);
  std::sort(points.begin(), points.end(), [&](const Vec<3>& a, const Vec<3>& b) {
    const auto angle = [&](const Vec<3>& p) {
      return std::atan2((p - middle).dot(v), (p - middle).dot(u));
    };
    return angle(a) < angle(b);
  });
  return points;
}

SectionTool::SectionTool(VtkView& view, Changed changed)
    : view_(view), changed_(std::move(changed)) {}

Vec<3> SectionTool::center() const {
  const Vec<3> middle((bounds_[0] + bounds_[1]) / 2, (bounds_[2] + bounds_[3]) / 2,
                      (bounds_[4] + bounds_[5]) / 2);
  return middle - section_->normal * (middle - section_->origin).dot(section_->normal);
}

Vec<3> SectionTool::tip() const {
  return center() + section_->normal * (shaft_pixels * view_.pixel_size());
}

SectionTool::Grip SectionTool::grip_at(const QPointF& position) const {
  if (!section_) return Grip::none;
  const QPointF a = view_.project(center());
  const QPointF b = view_.project(tip());
  const QPointF to_tip = position - b;
  const QPointF to_knob = position - a;
  const double tip_distance = std::hypot(to_tip.x(), to_tip.y());
  const double knob_distance = std::hypot(to_knob.x(), to_knob.y());
  if (knob_distance < grip_pixels && knob_distance <= tip_distance) return Grip::move;
  if (tip_distance < grip_pixels) return Grip::turn;
  if (distance_to_segment(position, a, b) < grip_pixels / 2) return Grip::move;
  return Grip::none;
}

bool SectionTool::mouse(QMouseEvent* event) {
  if (!section_) return false;
  if (event->type() == QEvent::MouseButtonPress && event->button() == Qt::LeftButton &&
      event->modifiers() == Qt::NoModifier) {
    grip_ = grip_at(event->position());
    start_ = event->position();
    start_section_ = *section_;
    start_section_.origin = center();
    return grip_ != Grip::none;
  }
  if (event->type() == QEvent::MouseButtonRelease) {
    const bool held = grip_ != Grip::none;
    grip_ = Grip::none;
    return held;
  }
  if (event->type() != QEvent::MouseMove) return false;
  if (grip_ == Grip::none) {
    if (event->buttons() != Qt::NoButton) return false;
    const Grip hover = grip_at(event->position());
    if (hover != hover_) {
      hover_ = hover;
      view_.setCursor(hover == Grip::none ? Qt::ArrowCursor : Qt::OpenHandCursor);
      changed_(*section_);
    }
    return false;
  }
  Section next = start_section_;
  if (grip_ == Grip::move) {
    const double length = shaft_pixels * view_.pixel_size();
    const QPointF axis =
        view_.project(next.origin + next.normal * length) - view_.project(next.origin);
    const QPointF by = event->position() - start_;
    const double axis2 = QPointF::dotProduct(axis, axis);
    // A plane seen face on has no direction on the screen: up and down move it then.
    const double share =
        axis2 > 400 ? QPointF::dotProduct(by, axis) / axis2 : -by.y() / shaft_pixels;
    next.origin += next.normal * (share * length);
  } else {
    const Vec<3> anchor = next.origin + next.normal * (shaft_pixels * view_.pixel_size());
    const Vec<3> arm = view_.unproject(event->position(), anchor) - next.origin;
    if (arm.norm() < 1e-12) return true;
    next.normal = snapped(arm.normalized());
  }
  section_ = next;
  changed_(next);
  return true;
}

void SectionTool::paint(QPainter& painter) const {
  if (!section_) return;
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  QPolygonF outline;
  for (const Vec<3>& p : box_section(bounds_, *section_, 0.04)) outline << view_.project(p);
  QColor fill = theme::accent;
  fill.setAlpha(14);
  QColor line = theme::accent;
  line.setAlpha(190);
  painter.setBrush(fill);
  painter.setPen(QPen(line, 1.2, Qt::DashLine));
  painter.drawPolygon(outline);

  const QPointF a = view_.project(center());
  const QPointF b = view_.project(tip());
  const Grip lit = grip_ != Grip::none ? grip_ : hover_;
  painter.setPen(QPen(Qt::white, 6, Qt::SolidLine, Qt::RoundCap));
  painter.drawLine(a, b);
  painter.setPen(QPen(theme::accent, lit == Grip::move ? 4 : 3, Qt::SolidLine, Qt::RoundCap));
  painter.drawLine(a, b);
  painter.setPen(QPen(Qt::white, 2));
  painter.setBrush(lit == Grip::move ? theme::accent.darker(125) : theme::accent);
  painter.drawEllipse(a, lit == Grip::move ? 9 : 8, lit == Grip::move ? 9 : 8);
  painter.setBrush(lit == Grip::turn ? theme::warning.darker(115) : theme::warning);
  painter.drawEllipse(b, lit == Grip::turn ? 8 : 6.5, lit == Grip::turn ? 8 : 6.5);
  painter.restore();
}

}  // namespace lamella::ui
