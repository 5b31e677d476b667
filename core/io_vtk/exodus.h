#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/io/mesh_fields.h"

namespace lamella {

/// Exodus II through the library that VTK brings: a block of TETRA for each body, a side set for
/// each group, both with names of up to 80 bytes; nodal variables metric_xx .. metric_xz, element
/// variables for the numbers of elements. Bodies and groups without entries are left out. Errors:
/// io; cancelled.
Result<void> write_exodus(const SimplexMesh<3>& mesh, const MeshFields& fields,
                          const std::filesystem::path& file, const Progress& progress = {});

/// Blocks of linear tetrahedra and side sets of their faces; the boundary is completed. Errors: io;
/// bad_input (damaged, no tetrahedra).
Result<MeshContent> read_exodus(const std::filesystem::path& file, const Progress& progress = {});

}  // namespace lamella
