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
/// $NodeData "metric" with 9 components (row by row), the thickness to "thickness". Errors: io;
/// cancelled. Nothing is left behind on failure.
Result<void> write_msh(const SimplexMesh<3>& mesh, const MeshFields& fields,
                       const std::filesystem::path& file, const MshParams& params = {},
                       const Progress& progress = {});

struct MshContent {
  SimplexMesh<3> mesh;
  MetricField<3> metric;          ///< [node]; empty when the file has none
  std::vector<double> thickness;  ///< [node]; empty when the file has none
};

/// Tetrahedra, triangles, physical names and the two fields of an MSH 4.1 file, text or binary.
/// Triangles are taken as they are listed; elements of other kinds are passed over. Where the file
/// has no physical names, bodies and groups are numbered.
/// Errors: io (missing, unreadable); bad_input (other version, truncated, no tetrahedra).
Result<MshContent> read_msh(const std::filesystem::path& file);

}  // namespace lamella
