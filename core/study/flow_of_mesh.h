#pragma once

#include "core/study/run.h"

namespace lamella {

/// The flow that `study` asks for through the bodies of a mesh that is there; without gates in the
/// study, through groups that are called gate, vent and symmetry. `parts` (may be empty) tell which
/// CAD faces belong to groups that are newer than the mesh. Where the study names the field of
/// another solver it is `field`, on the bodies that it lies on.
/// Errors: usage (no body with a gate, no way out), those of `solve_stokes` or of `field_on`.
Result<FlowFields> flow_of_mesh(const MeshState& state, const Study& study,
                                const std::vector<Part>& parts, const Progress& progress = {},
                                const SolverField* field = nullptr);

/// What a correction of the metric of `state` by its flow would come to, with the settings of
/// `study` or their defaults: elements and nodes before and after, all bodies together.
struct FlowPreview {
  double elements_before = 0, elements_after = 0;
  double nodes_before = 0, nodes_after = 0;
};
/// Errors: usage (no flow, no metric), cancelled.
Result<FlowPreview> preview_flow(const MeshState& state, const Study& study,
                                 const Progress& progress = {});

}  // namespace lamella
