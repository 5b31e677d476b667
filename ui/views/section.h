#pragma once

#include "core/geometry/simplex.h"

namespace lamella::ui {

/// A plane; what lies on the side its normal points to is cut away. mm.
struct Section {
  Vec<3> origin = Vec<3>::Zero();
  Vec<3> normal = Vec<3>::UnitX();
};

/// What is drawn of a flow, on the first section or, without one, within the mesh.
struct FlowLook {
  bool arrows = false;
  bool lines = false;   ///< streamlines from the gates
  bool levels = false;  ///< level sets on the section

  bool any() const { return arrows || lines || levels; }
  bool operator==(const FlowLook&) const = default;
};

}  // namespace lamella::ui
