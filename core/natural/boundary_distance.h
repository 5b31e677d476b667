#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/locator.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// How far the mesh's boundary lies from the surface it stands for.
struct BoundaryDistance {
  double largest = 0;             ///< mm
  Vec<3> place = Vec<3>::Zero();  ///< where
};

/// Largest distance to the surface of 16 points of each boundary facet: its center and a lattice
/// that divides its edges by four. Does not depend on the number of threads (0: all cores). Errors:
/// bad_input (empty surface), cancelled.
Result<BoundaryDistance> boundary_distance(const SimplexMesh<3>& mesh, const Locator<3>& surface,
                                           int threads = 0, const Progress& progress = {});

}  // namespace lamella
