#pragma once

#include <QWidget>
#include <array>

#include "ui/views/color_map.h"

namespace lamella::ui {

class SectionTool;
class VtkView;

/// What is drawn over the 3D picture: legend, scale in mm, axes and the section handle. Lets every
/// mouse event through.
class Overlay : public QWidget {
  Q_OBJECT

 public:
  Overlay(VtkView& view, const SectionTool& tool);

  void set_legend(const Legend& legend);
  /// Off while there is nothing to measure.
  void set_scale_visible(bool on);
  void set_handle_visible(bool on);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void follow_camera();
  void paint_legend(QPainter& painter) const;
  void paint_scale(QPainter& painter) const;
  void paint_axes(QPainter& painter) const;

  VtkView& view_;
  const SectionTool& tool_;
  Legend legend_;
  bool scale_visible_ = false;
  bool handle_visible_ = true;
  std::array<double, 18> camera_{};
};

}  // namespace lamella::ui
