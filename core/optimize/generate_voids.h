#pragma once

#include <functional>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// Fills a closed surface, by so many attempts at most; facets as for VolumeMesher.
using FillSurface = std::function<Result<SimplexMesh<3>>(const ReferenceSurface<3>& surface,
                                                         int attempts, const Progress& progress)>;

/// The mesh of a body with voids by as many small problems: the body without them is filled first;
/// then, around each void, the elements that it meets are cut out and what is left between their
/// boundary and the void is filled anew, in a larger hole where that fails. Facets as for
/// VolumeMesher.
/// Errors: failed (the shells are not one body and its voids), those of `fill`; cancelled.
Result<SimplexMesh<3>> generate_around_voids(const ReferenceSurface<3>& surface,
                                             const FillSurface& fill, const Progress& progress);

}  // namespace lamella
