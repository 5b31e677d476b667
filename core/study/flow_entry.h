#pragma once

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>

#include "core/study/study_input.h"

namespace lamella {

/// What the flow, or the field of another solver, corrects the metric by.
enum class FlowMethod {
  acceleration,  ///< gradient of ||(grad v) v|| (5.6)
  velocity,      ///< (grad v)^T grad v (5.7)
  strain,        ///< eps(v) (5.8)
  combined,      ///< (5.7) and the curvature of v
  field,         ///< gradient of a solver's number or vector, (5.6) or (5.7)
  direction,     ///< change of the velocity's direction (5.22), made uniform
  residual,      ///< residual indicator (5.24), made uniform
  directional,   ///< the directional one (5.28)
  indicator      ///< a solver's number, not negative, made uniform
};
/// Of a flow that is solved here.
inline constexpr FlowMethod kFlowMethods[] = {
    FlowMethod::acceleration, FlowMethod::velocity, FlowMethod::strain,     FlowMethod::combined,
    FlowMethod::direction,    FlowMethod::residual, FlowMethod::directional};
/// Of another solver's field.
inline constexpr FlowMethod kFieldMethods[] = {FlowMethod::field,     FlowMethod::acceleration,
                                               FlowMethod::strain,    FlowMethod::combined,
                                               FlowMethod::direction, FlowMethod::indicator};
/// As in the enumeration.
constexpr std::string_view flow_method_name(FlowMethod m) {
  constexpr std::string_view names[] = {"acceleration", "velocity",    "strain",
                                        "combined",     "field",       "direction",
                                        "residual",     "directional", "indicator"};
  return names[static_cast<int>(m)];
}
/// A gradient is added with a strength; an indicator is made uniform with beta.
constexpr bool adds_gradient(FlowMethod m) { return m <= FlowMethod::field; }
/// Whether a field of so many components can be used so: a number has no direction.
constexpr bool suits_field(FlowMethod m, int components) {
  if (m == FlowMethod::field) return true;
  const bool known =
      std::find(std::begin(kFieldMethods), std::end(kFieldMethods), m) != std::end(kFieldMethods);
  return known && (m == FlowMethod::indicator) == (components == 1);
}

/// A field that another solver has found.
struct StudyField {
  StudyInput source;  ///< its file, on any mesh of the bodies
  std::string name;   ///< in the file

  bool operator==(const StudyField&) const = default;
};

/// A Stokes flow through the bodies that have a gate, or the field of another solver in its place,
/// and the correction of their mesh by it.
struct StudyFlow {
  FlowMethod method = FlowMethod::combined;  ///< see decision 0014
  double strength = 1;                       ///< of a gradient, > 0
  double beta = 1;                           ///< of an indicator, > 0: below 1 its mean falls too
  double growth = 1.5;            ///< budget: elements over those of the natural metric, > 1
  int rounds = 1;                 ///< of flow and correction; 0: the flow is solved, the mesh stays
  double viscosity = 1;           ///< MPa s
  std::optional<double> h_min{};  ///< mm, of the correction; unset: that of the body alone
  std::optional<StudyField> field{};  ///< in place of the flow; unset: the flow is solved

  bool operator==(const StudyFlow&) const = default;
};

}  // namespace lamella
