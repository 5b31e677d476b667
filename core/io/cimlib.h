#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/io/mesh_fields.h"

namespace lamella {

/// CIMlib and Rem3D (.t): nodes, tetrahedra and, as elements with node 0, the triangles of the
/// boundary. It knows neither bodies nor groups nor fields. Errors: io; cancelled.
Result<void> write_cimlib(const SimplexMesh<3>& mesh, const std::filesystem::path& file,
                          const Progress& progress = {});

/// Errors: io; bad_input (not 3D, truncated, a node out of range), with the line.
Result<MeshContent> read_cimlib(const std::filesystem::path& file, const Progress& progress = {});

}  // namespace lamella
