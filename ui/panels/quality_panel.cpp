#include "ui/panels/quality_panel.h"

#include <QMouseEvent>
#include <QPainter>
#include <QToolButton>
#include <algorithm>
#include <cmath>

#include "ui/panels/save_figures.h"
#include "ui/session/session.h"
#include "ui/theme.h"
#include "ui/units.h"
#include "ui/views/color_map.h"

namespace lamella::ui {
namespace {

constexpr int bins = 40;

}  // namespace

QualityPanel::QualityPanel(Session& session, QWidget* parent) : QWidget(parent), session_(session) {
  setObjectName("quality");
  setToolTip(
      tr("Draw a range to see only its elements; click to see all again.\n"
         "The bars grow with the logarithm of the count"));
  setCursor(Qt::CrossCursor);
  table_ = new QToolButton(this);
  table_->setIcon(icon("export"));
  table_->setCursor(Qt::ArrowCursor);
  table_->setAutoRaise(true);
  table_->setToolTip(tr("Save the counts as a table, or the histogram as a picture"));
  table_->setAccessibleName(tr("Save figures"));
  connect(table_, &QToolButton::clicked, this, [this] {
    save(ask_figures_file(this, QString::fromStdString(session_.study().name) + " quality"));
  });
  connect(&session, &Session::shown_changed, this, &QualityPanel::follow);
  connect(&session, &Session::iterations_changed, this, &QualityPanel::follow);
  follow();
}

void QualityPanel::follow() {
  counts_.assign(bins, 0);
  if (const auto state = session_.shown_state())
    for (const double q : state->quality)
      ++counts_[static_cast<std::size_t>(std::clamp(static_cast<int>(q * bins), 0, bins - 1))];
  update();
}

QString QualityPanel::csv() const {
  QString text = "from,to,elements\n";
  for (int k = 0; k < bins; ++k)
    text += QString("%1,%2,%3\n")
                .arg(double(k) / bins)
                .arg(double(k + 1) / bins)
                .arg(counts_[static_cast<std::size_t>(k)]);
  return text;
}

void QualityPanel::save(const QString& file) {
  if (file.isEmpty()) return;
  session_.wrote(file, save_figures(file, csv(), *this));
}

void QualityPanel::resizeEvent(QResizeEvent*) {
  table_->adjustSize();
  table_->move(width() - table_->width() - 8, 6);
}

void QualityPanel::set_range(const std::optional<std::pair<double, double>>& range) {
  if (range == range_) return;
  range_ = range;
  update();
  Q_EMIT range_changed();
}

QRectF QualityPanel::area() const { return QRectF(rect()).adjusted(54, 34, -20, -30); }

double QualityPanel::value_at(double x) const {
  return std::clamp((x - area().left()) / area().width(), 0.0, 1.0);
}

void QualityPanel::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF box = area();
  QFont bold = font();
  bold.setWeight(QFont::DemiBold);
  painter.setFont(bold);
  painter.setPen(theme::text);
  std::size_t all = 0, most = 0, chosen = 0;
  for (int k = 0; k < bins; ++k) {
    const std::size_t n = counts_[static_cast<std::size_t>(k)];
    all += n;
    most = std::max(most, n);
    const double middle = (k + 0.5) / bins;
    if (range_ && middle >= range_->first && middle <= range_->second) chosen += n;
  }
  QString title = tr("Quality of the elements, 1 is best");
  if (range_ && all > 0)
    title += tr("     %1 to %2: %L3 of %L4 elements")
                 .arg(written(range_->first, 'f', 2))
                 .arg(written(range_->second, 'f', 2))
                 .arg(chosen)
                 .arg(all);
  painter.drawText(QPointF(18, 22), title);
  painter.setFont(font());
  if (all == 0) {
    painter.setPen(theme::faint_text);
    painter.drawText(box, Qt::AlignCenter, tr("Nothing yet"));
    return;
  }
  const double top = std::log1p(static_cast<double>(most));
  painter.setPen(QPen(theme::border, 1));
  for (double n = 1; n <= static_cast<double>(most); n *= 10) {
    const double y = box.bottom() - box.height() * std::log1p(n) / top;
    painter.setPen(QPen(theme::border, 1));
    painter.drawLine(QPointF(box.left(), y), QPointF(box.right(), y));
    painter.setPen(theme::faint_text);
    painter.drawText(QRectF(0, y - 9, box.left() - 8, 18), Qt::AlignRight | Qt::AlignVCenter,
                     n >= 1000 ? QString("%1 k").arg(n / 1000) : QString::number(n));
  }
  const ColorMap map = rating_map();
  const double width = box.width() / bins;
  for (int k = 0; k < bins; ++k) {
    const auto n = static_cast<double>(counts_[static_cast<std::size_t>(k)]);
    const double height = box.height() * std::log1p(n) / top;
    const double middle = (k + 0.5) / bins;
    const bool out = range_ && (middle < range_->first || middle > range_->second);
    QColor color = map.at(middle);
    if (color.lightness() > 215) color = color.darker(112);
    if (out) color.setAlpha(70);
    painter.fillRect(QRectF(box.left() + k * width + 0.5, box.bottom() - height, width - 1, height),
                     color);
  }
  painter.setPen(theme::soft_text);
  for (int k = 0; k <= 5; ++k)
    painter.drawText(QRectF(box.left() + box.width() * k / 5 - 30, box.bottom() + 6, 60, 18),
                     Qt::AlignHCenter | Qt::AlignTop, written(0.2 * k));
  if (begun_) {
    QColor fill = theme::accent;
    fill.setAlpha(45);
    const double a = box.left() + box.width() * *begun_, b = box.left() + box.width() * drawn_to_;
    painter.fillRect(
        QRectF(QPointF(std::min(a, b), box.top()), QPointF(std::max(a, b), box.bottom())), fill);
  }
}

void QualityPanel::mousePressEvent(QMouseEvent* event) {
  begun_ = drawn_to_ = value_at(event->position().x());
}

void QualityPanel::mouseMoveEvent(QMouseEvent* event) {
  if (!begun_) return;
  drawn_to_ = value_at(event->position().x());
  update();
}

void QualityPanel::mouseReleaseEvent(QMouseEvent* event) {
  if (!begun_) return;
  drawn_to_ = value_at(event->position().x());
  // Whole bars are chosen.
  const double low = std::floor(std::min(*begun_, drawn_to_) * bins) / bins;
  const double high = std::ceil(std::max(*begun_, drawn_to_) * bins) / bins;
  const bool drawn = std::abs(drawn_to_ - *begun_) * area().width() > 4;
  begun_.reset();
  set_range(drawn ? std::optional(std::pair(low, high)) : std::nullopt);
  update();
}

}  // namespace lamella::ui
