#pragma once

#include <span>

#include "core/base/progress.h"
#include "core/mesh/simplex_mesh.h"
#include "core/multidomain/partition.h"

namespace lamella {

/// Moves nodes of smooth borders across them, by at most `most` mm, so that as much of what lies
/// between border and mesh is on one side as on the other: chords of a curved border with all nodes
/// on it take volume from the body inside, and are farther from it than they need be. The facets of
/// zone z have CAD faces from number `first_face[z]` on, those below are of other surfaces and
/// stay. So do nodes between zones or groups and on sharp edges, and what would make an element
/// poor. Returns how many nodes were moved; where it was cancelled the mesh is as valid as before.
std::size_t balance_borders(SimplexMesh<3>& mesh, const Partition<3>& partition,
                            std::span<const std::int32_t> first_face, double most, int threads = 0,
                            const Progress& progress = {});

}  // namespace lamella
