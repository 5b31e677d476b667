#pragma once

#include <span>

#include "core/geometry/locator.h"

namespace lamella {

/// Semi-axes of the body as seen from a point, shortest first.
struct SeenAxes {
  Vec<3> length;  ///< mm, s1 <= s2 <= s3
  Mat<3> axis;    ///< columns: unit directions, right-handed up to sign
};

/// Ellipsoid fitted to the lengths of rays to the surface: the least squares of u^T M u to
/// 1/(d(u) d(-u)), exact for slabs, cylinders and ellipsoids, where long rays weigh nothing.
class EllipsoidFit {
 public:
  /// Fixed unit directions of the half sphere; each ray is also shot backward.
  static std::span<const Vec<3>> directions();

  /// Seen from c, where the nearest wall is at r; rays are cut at 20 r. `across`: unit direction
  /// in which two walls face each other at r, zero when unknown: it saves most rays in thin walls.
  static SeenAxes at(const Locator<3>& surface, const Vec<3>& c, double r,
                     const Vec<3>& across = Vec<3>::Zero());
};

}  // namespace lamella
