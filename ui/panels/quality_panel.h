#pragma once

#include <QWidget>
#include <optional>
#include <utility>
#include <vector>

class QToolButton;

namespace lamella::ui {

class Session;

/// How many elements have which quality; a range drawn in it is shown alone in the view.
class QualityPanel : public QWidget {
  Q_OBJECT

 public:
  explicit QualityPanel(Session& session, QWidget* parent = nullptr);
  const std::optional<std::pair<double, double>>& range() const { return range_; }
  /// Every bar as a line of comma-separated values: from, to, elements.
  QString csv() const;
  /// Writes the bars, or a picture of them, by the ending of the file.
  void save(const QString& file);
  void set_range(const std::optional<std::pair<double, double>>& range);
  QSize minimumSizeHint() const override { return {200, 130}; }

 Q_SIGNALS:
  void range_changed();

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;

 private:
  void follow();
  QRectF area() const;
  double value_at(double x) const;

  Session& session_;
  QToolButton* table_;
  std::vector<std::size_t> counts_;
  std::optional<std::pair<double, double>> range_;
  std::optional<double> begun_;  // where a range was begun to be drawn
  double drawn_to_ = 0;
};

}  // namespace lamella::ui
