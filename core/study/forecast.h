#pragma once

#include <memory>

#include "core/base/progress.h"
#include "core/multidomain/chord_metric.h"
#include "core/optimize/generate.h"
#include "core/sizing/forecast.h"
#include "core/study/first_mesh.h"
#include "core/study/study.h"

namespace lamella {

/// What rounds of the flow may make of a mesh, at the most: their budget is a bound, and not all of
/// it need be used.
struct FlowForecast {
  int solves = 0;     ///< of the flow: before each round and after the last; 0: a solver's field
  MeshForecast mesh;  ///< its memory is that of the flow solver or the adaption, whichever is more
};

/// The mesh of one body that `run` may be expected to make.
struct BodyForecast {
  std::string name;
  SizingForecast mesh;                 ///< before any flow
  std::optional<FlowForecast> flow{};  ///< of a body with a gate
  double seconds = 0;                  ///< the forecast itself took, without the first mesh
};

/// Of a body whose first mesh is there; `natural` is the detector's answer at a point, `chords`
/// what the surface asks for beside. Errors: those of `forecast_mesh`.
Result<SizingForecast> forecast_body(const Study& study, const SimplexMesh<3>& first,
                                     const MetricFunction<3>& natural, const ChordField& chords,
                                     const SizingField& sizing, const Progress& progress = {});

/// Of the body called `body`, whose mesh without a flow is `mesh`; null where none is asked for.
std::optional<FlowForecast> forecast_flow(const Study& study, const std::string& body,
                                          const MeshForecast& mesh);

/// From the first mesh of every body, without adapting it. `meshers` as for `run`.
/// Errors: those of `run`.
Result<std::vector<BodyForecast>> forecast_study(
    const Study& study, const std::vector<Part>& parts,
    const std::vector<std::shared_ptr<const VolumeMesher>>& meshers, const Progress& progress = {});

/// The first mesh of every part, for forecasts of several studies of them. Errors: those of
/// `first_mesh`.
Result<std::vector<FirstMesh>> first_meshes(
    const std::vector<Part>& parts, const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
    const Progress& progress = {});

/// The same from first meshes made before, one a part.
Result<std::vector<BodyForecast>> forecast_from(const std::vector<FirstMesh>& first,
                                                const Study& study, const std::vector<Part>& parts,
                                                const Progress& progress = {});

/// MB that solving a flow through so many nodes takes at the most.
double flow_memory(double nodes);

/// MB that making a first mesh of so many facets takes at the most, by algorithm 2.1 or by Netgen.
double first_mesh_memory(std::size_t facets, bool by_netgen);

/// Fine as long as no more MB are needed than allowed. Errors: memory; the message is `what`, a
/// beginning as "The flow through 5 nodes: about", and both numbers.
Result<void> within_memory(const std::string& what, double needed, std::optional<double> allowed,
                           const std::string& hint);

}  // namespace lamella
