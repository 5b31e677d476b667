#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/io/mesh_fields.h"

namespace lamella {

/// Nastran bulk data: GRID* of 16 columns, CTETRA with a PSOLID for each body, CTRIA3 with a PSHELL
/// for each group, whose names are in comments as HyperMesh writes them. The material and the
/// thickness of the PSHELL are there because the format wants some. No fields. Errors: io;
/// cancelled.
Result<void> write_nastran(const SimplexMesh<3>& mesh, const MeshFields& fields,
                           const std::filesystem::path& file, const Progress& progress = {});

/// GRID, CTETRA of four nodes and CTRIA3, in fields of 8 or 16 columns or between commas. Other
/// cards are passed over. Errors: io; bad_input, with the line.
Result<MeshContent> read_nastran(const std::filesystem::path& file, const Progress& progress = {});

}  // namespace lamella
