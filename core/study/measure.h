#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/study/run.h"

namespace lamella {

/// What one iteration's mesh is worth in the metric of its state: counts, volume, qualities, which
/// also go to `state.quality`, conformity, edges. Layers and time are left to the caller.
/// Errors: cancelled.
Result<IterationRecord> measure(MeshState& state, const Progress& progress = {});

/// The boundary of one body of a mesh as a surface, as the mesh has it: no CAD is asked.
ReferenceSurface<3> boundary_surface(const SimplexMesh<3>& mesh, std::int32_t body);

/// The elements and facets of one body alone, with its nodes renumbered in order; `old_id` gets the
/// node of `mesh` for each of the new nodes.
SimplexMesh<3> extract_body(const SimplexMesh<3>& mesh, std::int32_t body,
                            std::vector<NodeId>* old_id = nullptr);

}  // namespace lamella
