#pragma once

#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"
#include "core/study/study.h"

namespace lamella {

/// The bodies of a mesh as parts to be meshed anew, in its order and by its names, but that
/// "background" gets a number; one without elements is left out. The surface of each is its
/// boundary as the mesh has it, so that bodies that touch have the same triangles there. Its faces
/// are the pieces of one boundary group between feature edges, with the group's name, and
/// `Part::groups` are the groups that somebody named: neither walls nor faces between two bodies.
/// Errors: bad_input (no element, or a boundary that is not closed); cancelled.
Result<std::vector<Part>> parts_of_mesh(const SimplexMesh<3>& mesh, const Progress& progress = {});

/// Adds the groups that the part's file named to a study of it, but for those that a group of the
/// study takes up by their name.
void add_groups_of_file(const Part& part, Study& study);

}  // namespace lamella
