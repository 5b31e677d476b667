#pragma once

#include <array>
#include <vector>

#include "core/geometry/surface.h"

namespace lamella::ui {

/// From where parts in a box (x0 x1 y0 y1 z0 z1) are looked at first, unit: flat ones on their flat
/// side, and from where they have more to show.
Vec<3> first_direction(const std::array<double, 6>& box, const std::vector<Part>& parts);

}  // namespace lamella::ui
