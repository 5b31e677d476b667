#include "ui/views/color_map.h"

#include <algorithm>
#include <cmath>

namespace lamella::ui {

QColor ColorMap::at(double t) const {
  t = std::clamp(t, 0.0, 1.0);
  if (bands > 0) {
    const double band = std::min(std::floor(t * bands), bands - 1.0);
    // As many colors as bands: each has its own.
    const bool own = static_cast<std::size_t>(bands) == stops.size();
    t = own ? band / (bands - 1) : (band + 0.5) / bands;
  }
  const double place = t * static_cast<double>(stops.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  const double w = place - static_cast<double>(k);
  const auto mix = [w](int a, int b) { return static_cast<int>(std::lround(a + w * (b - a))); };
  const QColor& a = stops[k];
  const QColor& b = stops[k + 1];
  return {mix(a.red(), b.red()), mix(a.green(), b.green()), mix(a.blue(), b.blue())};
}

ColorMap sequential_map() {
  return {{QColor(0x44, 0x3a, 0x83), QColor(0x3b, 0x5b, 0x92), QColor(0x31, 0x7b, 0x8f),
           QColor(0x2a, 0x9a, 0x87), QColor(0x4f, 0xb8, 0x6f), QColor(0x9c, 0xcf, 0x4e),
           QColor(0xf4, 0xe0, 0x4d)}};
}

ColorMap filling_map() {
  return {{QColor(0xee, 0xf1, 0xf4), QColor(0xf2, 0xc1, 0x6d), QColor(0xd9, 0x6b, 0x3b),
           QColor(0x2f, 0x6f, 0xb3)},
          4};
}

ColorMap rating_map() {
  return {{QColor(0xb8, 0x2e, 0x2e), QColor(0xe0, 0x7b, 0x54), QColor(0xf5, 0xc9, 0x9b),
           QColor(0xf3, 0xf1, 0xe6), QColor(0xa9, 0xcd, 0xe3), QColor(0x5b, 0x9a, 0xca),
           QColor(0x27, 0x5f, 0xa3)}};
}

}  // namespace lamella::ui
