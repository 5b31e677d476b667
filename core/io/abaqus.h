#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/io/mesh_fields.h"

namespace lamella {

/// Abaqus and CalculiX input: nodes and C3D4 elements, an element set for each body, and for each
/// group a surface of element faces and a node set, both with its name. No triangles, which
/// CalculiX would take for shells, and no fields. Errors: io; cancelled.
Result<void> write_abaqus(const SimplexMesh<3>& mesh, const MeshFields& fields,
                          const std::filesystem::path& file, const Progress& progress = {});

/// C3D4 elements, their sets (an element that is in several belongs to the first that is not of all
/// elements) and surfaces of element faces. Other keywords are passed over. Errors: io; bad_input,
/// with the line.
Result<MeshContent> read_abaqus(const std::filesystem::path& file, const Progress& progress = {});

}  // namespace lamella
