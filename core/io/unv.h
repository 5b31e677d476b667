#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/io/mesh_fields.h"

namespace lamella {

/// I-deas universal file: units (164), nodes (2411), tetrahedra of type 111 and triangles of type
/// 91 (2412), and the bodies and groups twice, as 2467, which OpenFOAM reads, and as 2477. No
/// fields. Errors: io; cancelled.
Result<void> write_unv(const SimplexMesh<3>& mesh, const MeshFields& fields,
                       const std::filesystem::path& file, const Progress& progress = {});

/// Tetrahedra (111), triangles (41, 91) and groups of these (2452, 2467, 2477). Other data sets are
/// passed over. Errors: io; bad_input, with the line.
Result<MeshContent> read_unv(const std::filesystem::path& file, const Progress& progress = {});

}  // namespace lamella
