#pragma once

#include "core/base/progress.h"
#include "core/geometry/locator.h"
#include "core/optimize/folded_mesh.h"
#include "core/optimize/generate_bridge.h"

namespace lamella {

/// A start for algorithm 2.1 that has little to mend: the boundary is taken off vertex by vertex.
///
/// Each step joins a vertex to a neighbor, or to a new point below it, and so replaces the facets
/// around it by others farther inside; the simplices between old and new facets go to `elements`.
/// What is left is a boundary again, so any order of steps gives a mesh topology; the order taken
/// keeps the simplices well oriented as long as that is possible. New nodes are added to `mesh`,
/// which must be of `surface`. Steps stop when nothing may be joined or when cancelled.
Bridged<3> peel(Bridged<3> boundary, FoldedMesh<3>& mesh, const Locator<3>& surface,
                std::uint64_t seed, const Progress& progress);

}  // namespace lamella
