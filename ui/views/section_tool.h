#pragma once

#include <QPointF>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "ui/views/scene.h"

class QMouseEvent;
class QPainter;

namespace lamella::ui {

class VtkView;

/// The handle of the section plane: its knob and shaft move the plane, its tip turns it.
/// Drawn over the picture, so it is never hidden by the part.
class SectionTool {
 public:
  using Changed = std::function<void(const Section&)>;

  SectionTool(VtkView& view, Changed changed);

  /// Where the plane is, or nothing; does not call `changed`.
  void set(const std::optional<Section>& section) { section_ = section; }
  /// Box the plane belongs to: its center carries the handle.
  void set_bounds(const std::array<double, 6>& bounds) { bounds_ = bounds; }

  /// True when the event was meant for the handle.
  bool mouse(QMouseEvent* event);
  void paint(QPainter& painter) const;

 private:
  enum class Grip { none, move, turn };

  Vec<3> center() const;
  Vec<3> tip() const;
  Grip grip_at(const QPointF& position) const;

  VtkView& view_;
  Changed changed_;
  std::optional<Section> section_;
  std::array<double, 6> bounds_{1, -1, 1, -1, 1, -1};
  Grip grip_ = Grip::none;
  Grip hover_ = Grip::none;
  QPointF start_;
  Section start_section_;
};

/// Corners, in order, of the polygon in which `section` cuts the box grown by `margin` (a share of
/// its diagonal); empty when it misses.
std::vector<Vec<3>> box_section(const std::array<double, 6>& box, const Section& section,
                                double margin);

}  // namespace lamella::ui
