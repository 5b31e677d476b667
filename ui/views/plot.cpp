#include "ui/views/plot.h"

#include <QMouseEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ui/theme.h"
#include "ui/units.h"

namespace lamella::ui {
namespace {

/// 12500 as "12.5 k", 8.25e6 as "8.25 M".
QString short_number(double value) {
  if (std::abs(value) >= 1e9) return written(value, 'g', 3);
  if (std::abs(value) >= 1e6) return written(value / 1e6, 'g', 3) + " M";
  if (std::abs(value) >= 1e3) return written(value / 1e3, 'g', 3) + " k";
  return written(value);
}

double nice_step(double span, int steps) {
  const double raw = span / steps;
  const double power = std::pow(10, std::floor(std::log10(raw)));
  const double lead = raw / power;
  return power * (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7 ? 5 : 10);
}

/// Between the rectangle and the segment, pixels; 0 where they meet.
double distance_of(const QRectF& place, const QPointF& from, const QPointF& to) {
  constexpr int samples = 48;
  double least = std::numeric_limits<double>::max();
  for (int k = 0; k <= samples; ++k) {
    const QPointF p = from + (to - from) * k / samples;
    const double dx = std::max({place.left() - p.x(), 0.0, p.x() - place.right()});
    const double dy = std::max({place.top() - p.y(), 0.0, p.y() - place.bottom()});
    least = std::min(least, std::hypot(dx, dy));
  }
  return least;
}

}  // namespace

Plot::Plot(const QString& title, QWidget* parent) : QWidget(parent), title_(title) {
  setMouseTracking(true);
}

void Plot::set_title(const QString& title) {
  title_ = title;
  update();
}

void Plot::set_series(std::vector<Series> series) {
  series_ = std::move(series);
  update_range();
  update();
}

void Plot::set_target(std::optional<double> value, const QString& name) {
  target_ = value;
  target_name_ = name;
  update_range();
  update();
}

void Plot::set_marked(int index) {
  marked_ = index;
  update();
}

void Plot::set_hovered(int index) {
  if (index == hovered_) return;
  hovered_ = index;
  update();
}

void Plot::set_logarithmic(bool on) {
  logarithmic_ = on;
  update_range();
  update();
}

int Plot::count() const {
  std::size_t n = 0;
  for (const Series& s : series_) n = std::max(n, s.values.size());
  return static_cast<int>(n);
}

bool Plot::measured() const {
  return std::any_of(series_.begin(), series_.end(), [](const Series& s) {
    return std::any_of(s.values.begin(), s.values.end(), [](double v) { return std::isfinite(v); });
  });
}

void Plot::update_range() {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  const auto take = [&](double v) {
    if (!std::isfinite(v) || (logarithmic_ && v <= 0)) return;
    low = std::min(low, v);
    high = std::max(high, v);
  };
  for (const Series& s : series_)
    for (const double v : s.values) take(v);
  if (target_) take(*target_);
  if (low > high) {
    low = logarithmic_ ? 1 : 0;
    high = logarithmic_ ? 10 : 1;
  }
  if (logarithmic_) {
    low_ = std::log10(low) - 0.05;
    high_ = std::log10(high) + 0.05;
    if (high_ - low_ < 0.5) high_ = low_ + 0.5;
    return;
  }
  // From zero, so that heights compare.
  low_ = std::min(0.0, low);
  high_ = high > low_ ? low_ + (high - low_) * 1.14 : low_ + 1;
}

QFont Plot::small_font() const {
  QFont small = font();
  small.setPointSizeF(small.pointSizeF() - 1);
  return small;
}

QRectF Plot::area() const {
  return QRectF(rect()).adjusted(50, legend_below() ? 46 : 30, -14, -24);
}

bool Plot::legend_below() const {
  if (series_.size() < 2 || count() == 0) return false;
  QFont bold = font();
  bold.setWeight(QFont::DemiBold);
  double needed = 12 + QFontMetricsF(bold).horizontalAdvance(title_);
  for (const Series& s : series_) needed += QFontMetricsF(font()).horizontalAdvance(s.name) + 30;
  return needed > width() - 14;
}

double Plot::x_of(int index) const {
  const QRectF a = area();
  const int n = count();
  return n < 2 ? a.center().x() : a.left() + 10 + (a.width() - 20) * index / (n - 1);
}

double Plot::y_of(double value) const {
  const double v = logarithmic_ ? std::log10(std::max(value, 1e-300)) : value;
  const QRectF a = area();
  return a.bottom() - a.height() * (v - low_) / (high_ - low_);
}

int Plot::index_at(double x) const {
  const int n = count();
  if (n == 0) return -1;
  const QRectF a = area();
  if (x < a.left() - 8 || x > a.right() + 8) return -1;
  if (n == 1) return 0;
  const double place = (x - a.left() - 10) / (a.width() - 20) * (n - 1);
  return std::clamp(static_cast<int>(std::lround(place)), 0, n - 1);
}

std::vector<double> Plot::ticks() const {
  std::vector<double> values;
  if (logarithmic_) {
    const double room = std::max(2.0, area().height() / 20);
    const int stride = std::max(1, static_cast<int>(std::ceil((high_ - low_) / room)));
    const bool sparse = (high_ - low_) * 3 > room;
    for (int e = static_cast<int>(std::floor(low_)); e <= static_cast<int>(std::ceil(high_)); ++e) {
      for (const double lead : {1.0, 2.0, 5.0}) {
        if (sparse && (lead > 1 || e % stride != 0)) continue;
        const double v = std::log10(lead) + e;
        if (v >= low_ && v <= high_) values.push_back(std::pow(10, v));
      }
    }
    return values;
  }
  const double step = nice_step(high_ - low_, std::max(3, static_cast<int>(area().height() / 26)));
  for (double v = std::ceil(low_ / step) * step; v <= high_; v += step) values.push_back(v);
  return values;
}

QPolygonF Plot::line_of(const Series& series) const {
  QPolygonF line;
  for (std::size_t k = 0; k < series.values.size(); ++k)
    if (std::isfinite(series.values[k]))
      line << QPointF(x_of(static_cast<int>(k)), y_of(series.values[k]));
  return line;
}

QRectF Plot::target_label() const {
  if (!target_) return {};
  const QRectF a = area();
  const QFontMetricsF metrics(small_font());
  const QSizeF size(metrics.horizontalAdvance(target_name_) + 2, metrics.height());
  const double y = y_of(*target_);
  const double left = a.left() + 4;
  const double free = a.width() - 8 - size.width();
  constexpr int steps = 8;
  constexpr double apart = 5;  // half a dot of a series and its line
  // From the line on, above it before below it, from the left on.
  for (double off = 1; off < a.height(); off += 4)
    for (const double top : {y - off - size.height(), y + off})
      for (int k = 0; k <= steps; ++k) {
        const QRectF place(QPointF(left + free * k / steps, top), size);
        if (place.top() < a.top() - 6 || place.bottom() > a.bottom()) continue;
        const bool clear = std::all_of(series_.begin(), series_.end(), [&](const Series& s) {
          const QPolygonF line = line_of(s);
          for (qsizetype i = 0; i < line.size(); ++i)
            if (distance_of(place, line[std::max<qsizetype>(0, i - 1)], line[i]) < apart)
              return false;
          return true;
        });
        if (clear) return place;
      }
  return {QPointF(left, y - 1 - size.height()), size};
}

void Plot::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF a = area();
  const QFont small = small_font();
  QFont bold = font();
  bold.setWeight(QFont::DemiBold);
  painter.setFont(small);
  double right = a.right();
  const double lower = legend_below() ? 20 : 0;
  if (series_.size() > 1 && count() > 0) {
    double names = 0;
    for (const Series& s : series_) names += painter.fontMetrics().horizontalAdvance(s.name);
    // Beside each name its line, a space before and behind; all of it less where there is no room.
    const double room = (a.right() - names) / static_cast<double>(series_.size());
    const double stroke = std::clamp(0.5 * room, 5.0, 12.0), gap = 0.5 * stroke;
    for (auto s = series_.rbegin(); s != series_.rend(); ++s) {
      const double w = painter.fontMetrics().horizontalAdvance(s->name);
      painter.setPen(theme::soft_text);
      painter.drawText(QRectF(right - w, 4 + lower, w + 2, 20), Qt::AlignLeft | Qt::AlignVCenter,
                       s->name);
      painter.setPen(QPen(s->color, 2.5, Qt::SolidLine, Qt::RoundCap));
      const double end = right - w - gap;
      painter.drawLine(QPointF(end - stroke, 14 + lower), QPointF(end, 14 + lower));
      right = end - stroke - 2 * gap;
    }
  }
  if (lower > 0) right = a.right();
  painter.setFont(bold);
  painter.setPen(theme::text);
  painter.drawText(
      QRectF(12, 4, right - 12, 20), Qt::AlignLeft | Qt::AlignVCenter,
      painter.fontMetrics().elidedText(title_, Qt::ElideRight, static_cast<int>(right - 12)));
  painter.setFont(small);
  const int n = count();
  for (const double v : measured() ? ticks() : std::vector<double>{}) {
    const double y = y_of(v);
    painter.setPen(QPen(theme::border, 1));
    painter.drawLine(QPointF(a.left(), y), QPointF(a.right(), y));
    painter.setPen(theme::faint_text);
    painter.drawText(QRectF(0, y - 9, a.left() - 7, 18), Qt::AlignRight | Qt::AlignVCenter,
                     short_number(v));
  }
  if (n == 0 || !measured()) {
    painter.setPen(theme::faint_text);
    painter.drawText(QRectF(0, a.top(), width(), a.height()), Qt::AlignCenter,
                     n == 0 ? tr("Nothing yet") : tr("not measured"));
    return;
  }
  const int stride = std::max(1, static_cast<int>(std::ceil(n * 26.0 / std::max(1.0, a.width()))));
  for (int k = 0; k < n; k += stride) {
    painter.setPen(theme::faint_text);
    painter.drawText(QRectF(x_of(k) - 20, a.bottom() + 3, 40, 18), Qt::AlignCenter,
                     QString::number(k));
  }
  if (marked_ >= 0 && marked_ < n) {
    painter.setPen(QPen(QColor(0xa9, 0xcd, 0xf0), 2));
    painter.drawLine(QPointF(x_of(marked_), a.top()), QPointF(x_of(marked_), a.bottom()));
  }
  if (target_) {
    painter.setPen(QPen(theme::good, 1.3, Qt::DashLine));
    painter.drawLine(QPointF(a.left(), y_of(*target_)), QPointF(a.right(), y_of(*target_)));
    painter.setPen(theme::good);
    painter.drawText(target_label(), Qt::AlignCenter, target_name_);
  }
  for (const Series& s : series_) {
    const QPolygonF line = line_of(s);
    painter.setPen(QPen(s.color, 2, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    painter.drawPolyline(line);
    painter.setBrush(theme::panel);
    for (const QPointF& p : line) painter.drawEllipse(p, 3, 3);
    painter.setBrush(Qt::NoBrush);
  }
  if (hovered_ < 0 || hovered_ >= n) return;
  QStringList lines{tr("Iteration %1").arg(hovered_)};
  for (const Series& s : series_) {
    if (hovered_ >= static_cast<int>(s.values.size())) continue;
    const double value = s.values[hovered_];
    const QString number =
        std::isfinite(value) ? QString("%L1").arg(value, 0, 'f', decimals_) : tr("not measured");
    lines << (series_.size() > 1 ? s.name + "  " + number : number);
  }
  double box_width = 0;
  for (const QString& line : lines)
    box_width = std::max<double>(box_width, painter.fontMetrics().horizontalAdvance(line));
  const double x = x_of(hovered_);
  QRectF box(x + 10, a.top() + 2, box_width + 18, 18.0 * static_cast<double>(lines.size()) + 8);
  if (box.right() > width() - 4) box.moveRight(x - 10);
  painter.setPen(QPen(theme::soft_text, 1, Qt::DotLine));
  painter.drawLine(QPointF(x, a.top()), QPointF(x, a.bottom()));
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(0x1f, 0x29, 0x33, 235));
  painter.drawRoundedRect(box, 5, 5);
  painter.setPen(Qt::white);
  for (int k = 0; k < lines.size(); ++k)
    painter.drawText(QRectF(box.left() + 9, box.top() + 4 + 18 * k, box_width + 4, 18),
                     Qt::AlignLeft | Qt::AlignVCenter, lines[k]);
}

void Plot::mouseMoveEvent(QMouseEvent* event) {
  const int index = index_at(event->position().x());
  set_hovered(index);
  Q_EMIT hovered(index);
}

void Plot::mousePressEvent(QMouseEvent* event) {
  const int index = index_at(event->position().x());
  if (index >= 0 && event->button() == Qt::LeftButton) Q_EMIT clicked(index);
}

void Plot::leaveEvent(QEvent*) {
  set_hovered(-1);
  Q_EMIT hovered(-1);
}

}  // namespace lamella::ui
