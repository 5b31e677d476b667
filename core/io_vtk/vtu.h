#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/io/mesh_fields.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// A grid as written by `write_vtu` (core/io/vtu.h); of other writers' grids the tetrahedra and
/// triangles. VTK believes what a damaged file states: read files of unknown origin in a child.
/// Errors: io (missing, unreadable); bad_input (not a VTU file, no tetrahedra, arrays of wrong
/// size).
Result<MeshContent> read_vtu(const std::filesystem::path& file);

/// What any solver has written as VTU, or in VTK's legacy format (.vtk), read in a child: its mesh,
/// and its numbers and vectors at the nodes (`of_nodes`), nothing else. Cells that are no
/// tetrahedra are cut into such, and arrays of cells become fields of the nodes, the mean of the
/// cells around weighted by their volumes; where an array of points has the name already, that one
/// counts. Coordinates as in the file. Errors: as `read_vtu`; bad_input also for lists of files
/// (.pvtu, .pvd, .vtm); cancelled.
Result<MeshContent> read_vtk_result(const std::filesystem::path& file,
                                    const Progress& progress = {});

}  // namespace lamella
