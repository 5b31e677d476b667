#pragma once

#include <QColor>
#include <QPolygonF>
#include <QWidget>
#include <optional>
#include <vector>

namespace lamella::ui {

/// A line of a plot; x is the index of the value.
struct Series {
  QString name;
  QColor color;
  std::vector<double> values;
};

/// Lines over iterations, with hover, a marked iteration and an optional logarithmic axis.
class Plot : public QWidget {
  Q_OBJECT

 public:
  explicit Plot(const QString& title, QWidget* parent = nullptr);

  void set_title(const QString& title);
  void set_series(std::vector<Series> series);
  /// Of values of the longest series.
  int count() const;
  /// Whether any of the values is a number.
  bool measured() const;
  /// A dashed horizontal line called `name`, as the value asked for.
  void set_target(std::optional<double> value, const QString& name = {});
  /// Iteration marked by a vertical line; -1: none.
  void set_marked(int index);
  void set_logarithmic(bool on);
  /// Decimals of the values shown on hover.
  void set_decimals(int decimals) { decimals_ = decimals; }
  /// Where the name of the target is written: by its line, and on no series where there is room.
  QRectF target_label() const;
  QSize minimumSizeHint() const override { return {112, 104}; }

 Q_SIGNALS:
  void hovered(int index);
  void clicked(int index);

 public Q_SLOTS:
  /// Shows the values of an iteration; -1: none.
  void set_hovered(int index);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void leaveEvent(QEvent* event) override;

 private:
  QRectF area() const;
  QFont small_font() const;
  /// The value at each index that has one.
  QPolygonF line_of(const Series& series) const;
  /// Whether the names of the series need a line below the title.
  bool legend_below() const;
  double x_of(int index) const;
  double y_of(double value) const;
  int index_at(double x) const;
  void update_range();
  std::vector<double> ticks() const;

  QString title_;
  std::vector<Series> series_;
  std::optional<double> target_;
  QString target_name_;
  int marked_ = -1;
  int hovered_ = -1;
  int decimals_ = 0;
  bool logarithmic_ = false;
  double low_ = 0;
  double high_ = 1;
};

}  // namespace lamella::ui
