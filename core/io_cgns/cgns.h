#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/io/mesh_format.h"

namespace lamella {

/// CGNS 3.4 in HDF5: one zone with a section of TETRA_4 and a Family_t for each body, a section of
/// TRI_3, a BC_t and a Family_t for each group (faces between bodies get no BC_t), the unit as
/// DimensionalUnits_t, the metric as FlowSolution_t at vertices, numbers of elements as one at cell
/// centers. Bodies and groups without entries are left out. Errors: io; cancelled.
Result<void> write_cgns(const SimplexMesh<3>& mesh, const MeshFields& fields,
                        const std::filesystem::path& file, const Progress& progress = {});

/// TETRA_4 and TRI_3 sections of the first zone. Errors: io; bad_input (damaged, no tetrahedra).
Result<MeshContent> read_cgns(const std::filesystem::path& file, const Progress& progress = {});

MeshFormat cgns_format();

}  // namespace lamella
