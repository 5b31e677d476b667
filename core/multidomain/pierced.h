#pragma once

#include <array>
#include <optional>

#include "core/mesh/quality.h"
#include "core/multidomain/zone.h"

namespace lamella {

/// Where the border of a zone passes through a tetrahedron.
struct Pierced {
  double depth;  ///< mm, of the smaller side
  Vec<3> point;  ///< on the border, in the tetrahedron
};

/// The point of the border next to where the smaller side is deepest; nothing when that is within
/// `limit` mm. `phi`: the signed distances that the corners count as.
std::optional<Pierced> pierced_at(const Zone<3>& zone, const Corners<3>& p,
                                  const std::array<double, 4>& phi, double limit);

/// Signed distances of a zone at points inside of a tetrahedron, mm.
struct DepthIn {
  double mean = 0;
  double most = 0;  ///< largest absolute value
};
DepthIn depth_in(const Zone<3>& zone, const Corners<3>& p);

}  // namespace lamella
