#pragma once

#include <algorithm>
#include <functional>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// The point of one surface that lies farthest from another.
struct FarthestPoint {
  double distance = 0;            ///< mm
  Vec<3> place = Vec<3>::Zero();  ///< where
};

/// How far the mesh's boundary and the surface it stands for lie apart.
struct BoundaryDistance {
  FarthestPoint to_surface;    ///< of the mesh's boundary, from the surface
  FarthestPoint from_surface;  ///< of the surface, from the mesh's boundary
  double largest() const { return std::max(to_surface.distance, from_surface.distance); }
};

/// How deep a point lies under something else, mm: no more than the distance to where that ends;
/// 0 or less where it does not.
using Covered = std::function<double(const Vec<3>&)>;

/// Farthest point of `from`, as far as it is not covered, from `to` (the one-sided Hausdorff
/// distance). The distance is that of the place told, and no point of `from` lies farther by more
/// than `resolution` mm (0: 1e-5 of the diagonal). Does not depend on the number of threads (0: all
/// cores). Errors: bad_input (empty surface), cancelled.
Result<FarthestPoint> farthest_point(const ReferenceSurface<3>& from, const ReferenceSurface<3>& to,
                                     double resolution = 0, int threads = 0,
                                     const Progress& progress = {}, const Covered& covered = {});

/// Both directions, between the facets of the mesh and the surface. Errors: those of
/// `farthest_point`.
Result<BoundaryDistance> boundary_distance(const SimplexMesh<3>& mesh,
                                           const ReferenceSurface<3>& surface, int threads = 0,
                                           const Progress& progress = {});

}  // namespace lamella
