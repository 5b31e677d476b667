#pragma once

#include <QColor>
#include <QString>
#include <QStringList>
#include <vector>

namespace lamella::ui {

/// What the mesh is colored by.
enum class ColorBy {
  body,
  quality,
  thickness,
  layers,
  filling,
  size,   // smallest, that is asked
  speed,  // of the flow, up to indicator
  pressure,
  shear,
  indicator,
  field  // of another solver
};
/// Known on the surfaces of the bodies before there is a mesh, once their walls are measured.
constexpr bool of_walls(ColorBy field) {
  return field == ColorBy::thickness || field == ColorBy::size;
}
constexpr bool of_flow(ColorBy field) { return field >= ColorBy::speed; }

/// Colors at equal distances over [0, 1]; interpolated, or in bands of equal width.
struct ColorMap {
  std::vector<QColor> stops;
  int bands = 0;  ///< 0: smooth

  /// Color at t, clamped to [0, 1].
  QColor at(double t) const;
};

/// Dark violet to yellow, even in lightness.
ColorMap sequential_map();
/// Red (poor) over pale to blue (good).
ColorMap rating_map();

/// Filling ratios: empty, less than half, half and more, full.
ColorMap filling_map();

/// How values became colors; no title: colors need no explanation.
struct Legend {
  QString title;
  double low = 0;
  double high = 1;
  ColorMap map;
  QStringList bands{};     ///< what each band of the map is; empty: values are told at ticks
  bool is_length = false;  ///< values are in mm
  QString missing{};       ///< what gray stands for; empty: nothing is gray
};

}  // namespace lamella::ui
