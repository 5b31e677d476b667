#pragma once

#include <optional>

#include "core/multidomain/cut_topology.h"

namespace lamella {

/// What `cut` has become of the mesh `original`, with the faces between regions; `lost` is left to
/// the caller. Nothing when cancelled.
std::optional<CutMesh> mesh_of_cut(const CutTopology& cut, const SimplexMesh<3>& original,
                                   const Partition<3>& partition, int threads,
                                   const Progress& progress);

}  // namespace lamella
