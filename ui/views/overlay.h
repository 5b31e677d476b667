#pragma once

#include <QWidget>
#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "ui/views/color_map.h"

namespace lamella::ui {

class VtkView;

/// What is drawn over the 3D picture: legend, scale in mm, axes and the handles of tools. Lets
/// every mouse event through.
class Overlay : public QWidget {
  Q_OBJECT

 public:
  explicit Overlay(VtkView& view);

  using Painting = std::function<void(QPainter&)>;
  /// Drawn over the picture, in the order given; a handle is left out of pictures.
  void add(Painting painting, bool handle);
  /// A line at the bottom that tells what to do; empty: none.
  void set_hint(const QString& hint);

  void set_legend(const Legend& legend);
  /// Off while there is nothing to measure.
  void set_scale_visible(bool on);
  void set_handle_visible(bool on);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void follow_camera();
  void paint_hint(QPainter& painter) const;
  void paint_legend(QPainter& painter) const;
  void paint_scale(QPainter& painter) const;
  void paint_axes(QPainter& painter) const;

  VtkView& view_;
  std::vector<std::pair<Painting, bool>> paintings_;
  QString hint_;
  Legend legend_;
  bool scale_visible_ = false;
  bool handle_visible_ = true;
  std::array<double, 18> camera_{};
};

}  // namespace lamella::ui
