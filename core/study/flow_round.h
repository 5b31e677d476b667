#pragma once

#include <string>
#include <vector>

#include "core/flow/correction_field.h"
#include "core/flow/stokes.h"
#include "core/study/study.h"

namespace lamella {

/// A flow through a mesh and what it says of it; zero where no fluid flows.
struct FlowFields {
  std::vector<Vec<3>> velocity;   ///< [node] mm/s
  std::vector<double> pressure;   ///< [node] MPa
  std::vector<double> shear;      ///< [element] 1/s, (5.4)
  std::vector<double> indicator;  ///< [element] what the correction is to even out
  std::vector<OpeningFlow> openings;
  double imbalance = 0;           ///< the largest of the bodies
  std::vector<double> residuals;  ///< of the body that took most iterations

  /// Zeros behind, or all cut to the sizes; `nodes` counts the virtual one.
  void resize(std::size_t nodes, std::size_t elements);
  /// The nodes and elements of another mesh behind those here.
  void append(const FlowFields& other);
  /// Those of a part of the mesh: its nodes are `node`, its elements `element` here. Sizes fit.
  void put(const FlowFields& part, const std::vector<NodeId>& node,
           const std::vector<std::size_t>& element);
  /// mm^3/s that enter, and the largest pressure of an opening.
  double rate() const;
  double highest_pressure() const;
};

/// The study asks for a flow through the part called `body`: it has a gate and is not left out.
bool has_flow(const Study& study, const std::string& body);

/// The gates, vents and symmetries on the part called `body`.
FlowCase<3> flow_case_of(const Study& study, const std::string& body);

/// The flow through the mesh of one body, whose groups have the names of the study, and the
/// indicator of `method`: what is made uniform, or of a gradient its field's largest difference
/// along an edge. Errors: those of `solve_stokes`.
Result<FlowFields> flow_through(const SimplexMesh<3>& mesh, const FlowCase<3>& flow,
                                FlowMethod method, int threads = 0, const Progress& progress = {});

struct FlowCorrection {
  CorrectionField field;
  double elements_before = 0, elements_after = 0;  ///< forecast (1.34)
};

/// What `flow` asks for beyond `natural`, [node] the metric that is asked without a flow. `before`
/// is the correction that the mesh was made with: a gradient takes its place, an indicator, which
/// saw a mesh that was corrected already, goes on from it.
/// Errors: those of `add_tensors`.
Result<FlowCorrection> flow_correction(const SimplexMesh<3>& mesh, const MetricField<3>& natural,
                                       const FlowFields& flow, const StudyFlow& asked,
                                       const CorrectionField& before, double h_min, int threads = 0,
                                       const Progress& progress = {});

}  // namespace lamella
