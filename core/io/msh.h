#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/io/mesh_fields.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

struct MshParams {
  bool binary = true;  ///< false: text
};

/// Gmsh MSH 4.1. Bodies are physical volumes 1.., groups are physical surfaces that follow them,
/// all with names; each (group, CAD face) is a surface entity of its own. The metric goes to
/// $NodeData "metric" with 9 components (row by row), the thickness to "thickness", numbers of
/// elements to $ElementData. Errors: io; cancelled. Nothing is left behind on failure.
Result<void> write_msh(const SimplexMesh<3>& mesh, const MeshFields& fields,
                       const std::filesystem::path& file, const MshParams& params = {},
                       const Progress& progress = {});

/// Gmsh MSH 2.2, as text, for programs that do not read 4.1 yet. Bodies, groups and fields as
/// there. Errors: io; cancelled.
Result<void> write_msh22(const SimplexMesh<3>& mesh, const MeshFields& fields,
                         const std::filesystem::path& file, const Progress& progress = {});

/// Tetrahedra, triangles, physical names, the two fields of nodes and all numbers of elements of an
/// MSH file, 4.1 as text or binary or 2 as text. Triangles are taken as they are listed; elements
/// of other kinds are passed over. Where the file has no physical names, bodies and groups are
/// numbered. Errors: io (missing, unreadable); bad_input (other version, truncated, no tetrahedra).
Result<MeshContent> read_msh(const std::filesystem::path& file);

}  // namespace lamella
