#include "ui/views/section.h"

#include <cmath>

namespace lamella::ui {

Section first_section(const std::array<double, 6>& box, const Vec<3>& direction,
                      const std::array<bool, 3>& axes) {
  // Cosine to the camera's direction below which a plane is hardly more than a line.
  constexpr double edge_on = 0.25;
  Section section;
  double best = -1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double facing = std::abs(direction[axis]), side = box[2 * a + 1] - box[2 * a];
    const double worth = facing < edge_on ? facing / edge_on : 1 + side;
    if (!axes[a] || worth <= best) continue;
    best = worth;
    section.normal = (direction[axis] > 0 ? -1 : 1) * Vec<3>::Unit(axis);
  }
  section.origin = Vec<3>(box[0] + box[1], box[2] + box[3], box[4] + box[5]) / 2;
  return section;
}

}  // namespace lamella::ui
