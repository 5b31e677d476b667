#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/io/mesh_format.h"

namespace lamella {

/// MED 4.1 (Salome, Code_Aster): a family with one group for each body (number below 0, cells) and
/// for each group (triangles); numbers of elements and the metric as fields of float64, the latter
/// with the components xx yy zz xy yz xz. The unit is that of the axes. Errors: io; cancelled.
Result<void> write_med(const SimplexMesh<3>& mesh, const MeshFields& fields,
                       const std::filesystem::path& file, const Progress& progress = {});

/// TETRA4 and TRIA3 of the first mesh of a file, with the first group of their families. Errors:
/// io; bad_input (damaged, no tetrahedra).
Result<MeshContent> read_med(const std::filesystem::path& file, const Progress& progress = {});

MeshFormat med_format();

}  // namespace lamella
