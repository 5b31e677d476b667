#pragma once

#include <string>
#include <vector>

#include "core/flow/correction_field.h"
#include "core/flow/solver_field.h"
#include "core/flow/stokes.h"
#include "core/study/study.h"

namespace lamella {

/// A flow through a mesh, or another solver's field on it, and what it says of the mesh; zero where
/// no fluid flows.
struct FlowFields {
  std::string field;              ///< name of a solver's field; empty: a flow that was solved here
  int components = 0;             ///< of that field: 1, `number`, or 3, `velocity`
  std::vector<double> number;     ///< [node] of a solver's field; else empty
  std::size_t outside = 0;        ///< nodes beside that field's mesh, which take what is nearest
  double farthest = 0;            ///< mm, of these
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
  /// Those at some of the nodes and elements alone, without openings.
  FlowFields of(const std::vector<NodeId>& node, const std::vector<std::size_t>& element) const;
  /// Those of a part of the mesh: its nodes are `node`, its elements `element` here. Sizes fit.
  void put(const FlowFields& part, const std::vector<NodeId>& node,
           const std::vector<std::size_t>& element);
  /// mm^3/s that enter, and the largest pressure of an opening.
  double rate() const;
  double highest_pressure() const;
  /// Of the indicator, over the elements that have one; 0 where none has.
  double mean_indicator() const;
};

/// The study asks for a flow through the part called `body`, which has a gate, or for the field of
/// another solver, and the part is not left out.
bool has_flow(const Study& study, const std::string& body);

/// The gates, vents and symmetries on the part called `body`.
FlowCase<3> flow_case_of(const Study& study, const std::string& body);

/// The flow through the mesh of one body, whose groups have the names of the study, and the
/// indicator of `method`: what is made uniform, or of a gradient its field's largest difference
/// along an edge. Errors: those of `solve_stokes`.
Result<FlowFields> flow_through(const SimplexMesh<3>& mesh, const FlowCase<3>& flow,
                                FlowMethod method, int threads = 0, const Progress& progress = {});

/// The field of another solver at the nodes of a mesh, and the indicator of `method` as above.
/// `across`: extent of all bodies, mm. Errors: usage (a method that the field does not suit), those
/// of `transfer_field`.
Result<FlowFields> field_on(const SimplexMesh<3>& mesh, const SolverField& field, FlowMethod method,
                            double across, int threads = 0, const Progress& progress = {});

/// Whether the field of another solver, where the study asks for one, is there, suits its method,
/// and lies on one of the parts that it may correct, at least. Errors: usage, bad_input, cancelled.
Result<void> check_field(const Study& study, const std::vector<Part>& parts,
                         const SolverField* field, const Progress& progress = {});

/// Extent of all parts together, mm.
double extent_of(const std::vector<Part>& parts);

/// Smallest size of the correction, mm, on a body whose own is `natural`.
double flow_h_min(const Study& study, double natural);

/// Whether the fields are of what `flow` asks for now, and not of another field.
bool is_of(const FlowFields& fields, const StudyFlow& flow);

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

/// How many nodes take the nearest place of a solver's field, for the user; empty: none.
std::string outside_note(const FlowFields& fields);

/// What a round of a solver's field came to, for the user.
std::string field_note(const FlowFields& before, const FlowFields& after,
                       const FlowCorrection& made);

}  // namespace lamella
