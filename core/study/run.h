#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"
#include "core/metric/metric.h"
#include "core/multidomain/filling.h"
#include "core/natural/boundary_distance.h"
#include "core/natural/layers.h"
#include "core/optimize/generate.h"
#include "core/study/domain.h"
#include "core/study/flow_round.h"
#include "core/study/record.h"
#include "core/study/study.h"

namespace lamella {

/// A mesh and what is known at its nodes and elements; shared, never changed.
struct MeshState {
  SimplexMesh<3> mesh;
  MetricField<3> metric;          ///< [node] natural metric asked at the node
  std::vector<double> thickness;  ///< [node] wall thickness 2 r, mm; entry 0 unused
  std::vector<double> layers;     ///< [node] layers measured back; NaN where not measured
  std::vector<double> quality;    ///< [element] c(T), eq. (3.7), in `metric`
  std::vector<PlaceBelow> below;  ///< places with fewer layers than asked, body by body
  /// Of fuzzy interfaces, regions as the bodies of the mesh; else null.
  std::shared_ptr<const Filling> filling;
  std::shared_ptr<const FlowFields> flow;  ///< null where none was solved
};

/// What became of one body.
struct BodyOutcome {
  std::string name;
  int layers_asked = 0;
  std::string first_mesh_by;           ///< name of the mesher that made the first mesh
  double cad_volume = 0;               ///< mm^3
  double mesh_volume = 0;              ///< mm^3
  BoundaryDistance boundary_distance;  ///< between the mesh and the tessellated part
  double chord_tolerance = 0;          ///< mm, the one that was used
  double h_min = 0;                    ///< mm, the one that was used
  double interface_size = 0;           ///< mm, across its borders; 0: exact, and not asked
  double interface_error = 0;          ///< relative L2 error (6.12) of its filling ratio
  LayerStats layers;
  std::vector<PlaceBelow> below;  ///< places with fewer layers than asked, the largest first
  std::vector<IterationRecord> records;
  std::vector<std::string> notes;
};

struct Outcome {
  std::shared_ptr<const MeshState> state;  ///< all bodies in one mesh
  std::vector<BodyOutcome> bodies;
  std::optional<StudyOverlaps> overlaps;  ///< between the bodies as given; unset: not looked for
  std::vector<IterationRecord> records;   ///< of the whole
  bool cancelled = false;                 ///< stopped early: `state` is the best so far
  bool converged = false;                 ///< every body has n layers in the mean and settled
  double seconds = 0;
};

/// Told after each iteration, from the worker thread; of the one before a correction by the flow
/// once more, with its flow.
using IterationSink = std::function<void(const IterationRecord&, std::shared_ptr<const MeshState>)>;

/// What the phases of progress begin with in the rounds of the flow.
inline const std::string kFlowPhase = "flow";

/// The main loop: first mesh, then metric -> adapt -> record until layers and nodes settle.
/// Cancel after the first mesh exists returns an Outcome with `cancelled` set; before, an Error.
/// `meshers` are tried in order for the first mesh of each body.
/// `field` is what the study names as the field of another solver; null where it names none.
/// Errors: usage (no body, n < 1), bad_input (a field that lies on no body), failed (no mesher
/// could mesh a body), cancelled.
Result<Outcome> run(const Study& study, const std::vector<Part>& parts,
                    const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
                    Progress progress = {}, IterationSink on_iteration = {},
                    std::shared_ptr<const SolverField> field = nullptr);

}  // namespace lamella
