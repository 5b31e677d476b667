#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/io/mesh_fields.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// VTK unstructured grid (XML): the tetrahedra, then the boundary triangles.
///
/// Cell arrays, Int32: `body` (-1 on triangles), `group` and `face` (-1 on tetrahedra); `quality`
/// and further fields of elements are NaN on triangles. Point arrays: `metric` (active tensors, XX
/// YY ZZ XY YZ XZ, mm^-2), `thickness` (mm), `layers` and further fields of nodes. Field arrays of
/// strings: `body_names`, `group_names`, `unit`, `generator`, `provenance`. Errors: io; cancelled.
/// Nothing is left behind on failure.
Result<void> write_vtu(const SimplexMesh<3>& mesh, const MeshFields& fields,
                       const std::filesystem::path& file, const Progress& progress = {});

/// A grid as written by `write_vtu`; of other writers' grids the tetrahedra and triangles.
/// Errors: io (missing, unreadable); bad_input (not a VTU file, no tetrahedra, arrays of wrong
/// size).
Result<MeshContent> read_vtu(const std::filesystem::path& file);

/// What a solver has written: its mesh, and its numbers and vectors at the nodes.
struct SolverResult {
  SimplexMesh<3> mesh;
  std::vector<NodeField> fields;
};

/// Any solver's grid: cells that are no tetrahedra are cut into such, and arrays of cells become
/// fields of the nodes, the mean of the cells around weighted by their volumes; where an array of
/// points has the name already, that one counts. Coordinates as in the file.
/// Errors: as `read_vtu`.
Result<SolverResult> read_vtu_result(const std::filesystem::path& file);

}  // namespace lamella
