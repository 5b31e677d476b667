#include "ui/views/overlay.h"

#include <vtkCamera.h>
#include <vtkMatrix4x4.h>
#include <vtkRenderer.h>

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "ui/theme.h"
#include "ui/units.h"
#include "ui/views/vtk_view.h"

namespace lamella::ui {
namespace {

/// Largest of 1, 2, 5 times a power of ten that is at most `x`.
double round_down(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  const double lead = x / power;
  return power * (lead >= 5 ? 5 : lead >= 2 ? 2 : 1);
}

}  // namespace

Overlay::Overlay(VtkView& view) : QWidget(&view), view_(view) {
  setAttribute(Qt::WA_TransparentForMouseEvents);
  setAttribute(Qt::WA_NoSystemBackground);
  connect(&view, &VtkView::rendered, this, &Overlay::follow_camera);
}

void Overlay::set_legend(const Legend& legend) {
  legend_ = legend;
  update();
}

void Overlay::add(Painting painting, bool handle) {
  paintings_.emplace_back(std::move(painting), handle);
}

void Overlay::set_hint(const QString& hint) {
  if (hint == hint_) return;
  hint_ = hint;
  update();
}

void Overlay::set_scale_visible(bool on) {
  scale_visible_ = on;
  update();
}

void Overlay::set_handle_visible(bool on) {
  handle_visible_ = on;
  update();
}

void Overlay::follow_camera() {
  // Painting the overlay makes Qt draw the view again, so it may only follow real changes.
  std::array<double, 18> now{};
  const double aspect = view_.height() > 0 ? double(view_.width()) / view_.height() : 1;
  const vtkMatrix4x4* matrix =
      view_.renderer()->GetActiveCamera()->GetCompositeProjectionTransformMatrix(aspect, -1, 1);
  std::copy_n(matrix->GetData(), 16, now.begin());
  now[16] = view_.width();
  now[17] = view_.height();
  if (now == camera_) return;
  camera_ = now;
  setGeometry(view_.rect());
  update();
}

void Overlay::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  for (const auto& [painting, handle] : paintings_)
    if (handle_visible_ || !handle) painting(painter);
  if (handle_visible_ && !hint_.isEmpty()) paint_hint(painter);
  if (!scale_visible_) return;
  paint_axes(painter);
  paint_scale(painter);
  paint_legend(painter);
}

void Overlay::paint_hint(QPainter& painter) const {
  painter.setFont(font());
  const double text_width = painter.fontMetrics().horizontalAdvance(hint_);
  // Below, since legends are above.
  const QRectF box((width() - text_width) / 2 - 16, height() - 84, text_width + 32, 32);
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(0x1f, 0x29, 0x33, 225));
  painter.drawRoundedRect(box, 16, 16);
  painter.setPen(Qt::white);
  painter.drawText(box, Qt::AlignCenter, hint_);
}

void Overlay::paint_legend(QPainter& painter) const {
  if (legend_.title.isEmpty()) return;
  constexpr int bar_height = 12;
  constexpr int bar_width = 230;
  constexpr int margin = 16;
  QFont small = font();
  small.setPointSizeF(small.pointSizeF() - 1);
  const int height = legend_.map.stops.empty() ? 58 : legend_.missing.isEmpty() ? 68 : 88;
  const QString title = legend_.is_length ? legend_.title + ", " + units::name() : legend_.title;
  QFont bold = font();
  bold.setWeight(QFont::DemiBold);
  const int width = std::max(bar_width, QFontMetrics(bold).horizontalAdvance(title) + 2);
  const QRectF box(margin, margin, width + 28, height);
  painter.setPen(QPen(theme::border, 1));
  QColor paper = theme::panel;
  paper.setAlpha(232);
  painter.setBrush(paper);
  painter.drawRoundedRect(box, 8, 8);
  painter.setPen(theme::text);
  painter.setFont(bold);
  painter.drawText(box.adjusted(14, 7, -14, 0), Qt::AlignLeft | Qt::AlignTop, title);

  painter.setFont(small);
  if (legend_.map.stops.empty()) {  // nothing to read off
    painter.setPen(theme::soft_text);
    painter.drawText(box.adjusted(14, 29, -14, 0), Qt::AlignLeft | Qt::AlignTop, legend_.missing);
    return;
  }
  const QRectF bar(box.left() + 14, box.top() + 29, bar_width, bar_height);
  painter.setRenderHint(QPainter::Antialiasing, false);
  for (int x = 0; x < bar_width; ++x) {
    painter.fillRect(QRectF(bar.left() + x, bar.top(), 1, bar_height),
                     legend_.map.at((x + 0.5) / bar_width));
  }
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setFont(small);
  painter.setPen(theme::soft_text);
  constexpr int ticks = 4;
  const double unit = legend_.is_length ? units::per_unit() : 1;
  const auto bands = legend_.bands.size();
  for (int k = 0; k < bands; ++k)
    painter.drawText(
        QRectF(bar.left() + bar.width() * k / bands, bar.bottom() + 3, bar.width() / bands, 18),
        int(Qt::AlignHCenter) | int(Qt::AlignTop), legend_.bands[k]);
  for (int k = 0; k <= ticks && bands == 0; ++k) {
    const double range = (legend_.high - legend_.low) / unit;
    double value = legend_.low / unit + range * k / ticks;
    // Digits that the range tells apart: long numbers near 0 would run into their neighbors.
    if (range > 0) {
      const double last = std::pow(10, std::floor(std::log10(range)) - 2);
      value = std::round(value / last) * last;
    }
    const double x = bar.left() + bar.width() * k / ticks;
    const auto align = k == 0 ? Qt::AlignLeft : k == ticks ? Qt::AlignRight : Qt::AlignHCenter;
    const double left = k == 0 ? x : k == ticks ? x - 60 : x - 30;
    painter.drawText(QRectF(left, bar.bottom() + 3, 60, 18), int(align) | int(Qt::AlignTop),
                     written(value, 'g', 3));
  }
  if (legend_.missing.isEmpty()) return;
  const QRectF swatch(bar.left(), bar.bottom() + 25, 12, 12);
  painter.fillRect(swatch, theme::missing);
  painter.drawText(QRectF(swatch.right() + 7, swatch.top() - 3, 200, 18),
                   Qt::AlignLeft | Qt::AlignVCenter, legend_.missing);
}

void Overlay::paint_scale(QPainter& painter) const {
  const double pixel = view_.pixel_size();
  if (!(pixel > 0)) return;
  const double unit = units::per_unit();
  const double length = round_down(pixel * 150 / unit) * unit;
  const double width_px = length / pixel;
  const double right = width() - 20;
  const double y = height() - 20;
  painter.setPen(QPen(theme::text, 1.6));
  painter.drawLine(QPointF(right - width_px, y), QPointF(right, y));
  painter.drawLine(QPointF(right - width_px, y - 4), QPointF(right - width_px, y + 4));
  painter.drawLine(QPointF(right, y - 4), QPointF(right, y + 4));
  painter.setFont(font());
  painter.drawText(QRectF(right - 200, y - 24, 200, 18), Qt::AlignRight | Qt::AlignVCenter,
                   units::length(length));
}

void Overlay::paint_axes(QPainter& painter) const {
  const vtkMatrix4x4* eye = view_.renderer()->GetActiveCamera()->GetViewTransformMatrix();
  struct Axis {
    QPointF to;
    double depth;
    QColor color;
    QString name;
  };
  const QPointF origin(46, height() - 46);
  std::array<Axis, 3> axes{Axis{{}, 0, QColor(0xc5, 0x3a, 0x30), "x"},
                           Axis{{}, 0, QColor(0x2f, 0x85, 0x5a), "y"},
                           Axis{{}, 0, theme::accent, "z"}};
  for (int k = 0; k < 3; ++k) {
    axes[k].to = QPointF(eye->GetElement(0, k), -eye->GetElement(1, k));
    axes[k].depth = eye->GetElement(2, k);
  }
  std::sort(axes.begin(), axes.end(),
            [](const Axis& a, const Axis& b) { return a.depth < b.depth; });
  QFont bold = font();
  bold.setWeight(QFont::DemiBold);
  painter.setFont(bold);
  for (const Axis& axis : axes) {
    painter.setPen(QPen(axis.color, 2.4, Qt::SolidLine, Qt::RoundCap));
    painter.drawLine(origin, origin + axis.to * 28);
    const QPointF at = origin + axis.to * 37;
    painter.drawText(QRectF(at.x() - 9, at.y() - 9, 18, 18), Qt::AlignCenter, axis.name);
  }
}

}  // namespace lamella::ui
