#pragma once

#include <array>

#include "core/geometry/simplex.h"

namespace lamella::ui {

/// A plane; what lies on the side its normal points to is cut away. mm.
struct Section {
  Vec<3> origin = Vec<3>::Zero();
  Vec<3> normal = Vec<3>::UnitX();
};

/// Through the middle of a box (x0 x1 y0 y1 z0 z1), across the longest of its sides along the
/// `axes` that are true: the section that shows most walls. One that is nearly seen edge-on by a
/// camera that looks along `direction` only if all are. The side towards the camera is cut away.
Section first_section(const std::array<double, 6>& box, const Vec<3>& direction,
                      const std::array<bool, 3>& axes);

/// What is drawn of a flow, on the first section or, without one, within the mesh.
struct FlowLook {
  bool arrows = false;
  bool lines = false;   ///< streamlines from the gates
  bool levels = false;  ///< level sets on the section

  bool any() const { return arrows || lines || levels; }
  bool operator==(const FlowLook&) const = default;
};

}  // namespace lamella::ui
