#pragma once

#include <string_view>

namespace lamella {

/// What the flow corrects the metric by.
enum class FlowMethod {
  acceleration,  ///< gradient of ||(grad v) v|| (5.6)
  velocity,      ///< (grad v)^T grad v (5.7)
  strain,        ///< eps(v) (5.8)
  combined,      ///< (5.7) and the curvature of v
  direction,     ///< change of the velocity's direction (5.22), made uniform
  residual,      ///< residual indicator (5.24), made uniform
  directional    ///< the directional one (5.28)
};
inline constexpr FlowMethod kFlowMethods[] = {
    FlowMethod::acceleration, FlowMethod::velocity, FlowMethod::strain,     FlowMethod::combined,
    FlowMethod::direction,    FlowMethod::residual, FlowMethod::directional};
/// As in the enumeration.
constexpr std::string_view flow_method_name(FlowMethod m) {
  constexpr std::string_view names[] = {"acceleration", "velocity", "strain",     "combined",
                                        "direction",    "residual", "directional"};
  return names[static_cast<int>(m)];
}
/// A gradient is added with a strength; an indicator is made uniform with beta.
constexpr bool adds_gradient(FlowMethod m) { return m <= FlowMethod::combined; }

/// A Stokes flow through the bodies that have a gate, and the correction of their mesh by it.
struct StudyFlow {
  FlowMethod method = FlowMethod::combined;  ///< see decision 0014
  double strength = 1;                       ///< of a gradient, > 0
  double beta = 1;                           ///< of an indicator, > 0: below 1 its mean falls too
  double growth = 1.5;   ///< budget: elements over those of the natural metric, > 1
  int rounds = 1;        ///< of flow and correction; 0: the flow is solved, the mesh stays
  double viscosity = 1;  ///< MPa s

  bool operator==(const StudyFlow&) const = default;
};

}  // namespace lamella
