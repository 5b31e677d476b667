#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// Where fluid enters or leaves: a boundary group with either its pressure or its rate.
struct FlowGate {
  std::string group;
  std::optional<double> pressure{};  ///< MPa, of the traction -p n
  std::optional<double> rate{};      ///< mm^D/s into the cavity; the pressure follows from it
};

/// A Stokes flow of a Newtonian fluid, (5.1), by the boundary groups of a mesh. What is neither
/// gate, vent nor symmetry is a wall, without slip; where groups meet, walls go before symmetry and
/// symmetry before openings.
template <int D>
struct FlowCase {
  std::vector<FlowGate> gates;
  std::vector<std::string> vents;       ///< pressure 0
  std::vector<std::string> symmetries;  ///< no normal velocity; planes in any position
  double viscosity = 1;                 ///< eta, MPa s
  std::function<Vec<D>(const Vec<D>&)> body_force{};  ///< MPa/mm, thread-safe; none when empty
};

struct FlowSettings {
  double tolerance = 1e-8;  ///< of the residual, relative to that of the fluid at rest
  int most_iterations = 2000;
  /// Couples pressures that differ from node to node along long edges: what the bubbles, which see
  /// the smallest height of an element only, leave to drift on stretched elements. Vanishes where
  /// the pressure is linear; without it iterations on 1:50 elements are up to ten times as many.
  bool smooth_pressure = true;
  int threads = 0;  ///< 0: all cores; the result does not depend on it
};

/// The flow through one gate or vent.
struct OpeningFlow {
  std::string group;
  double pressure = 0;  ///< MPa
  double rate = 0;      ///< mm^D/s, positive out of the cavity
  double area = 0;      ///< mm^(D-1)
};

template <int D>
struct Flow {
  std::vector<Vec<D>> velocity;       ///< [node] mm/s; zero at the virtual node and unused ones
  std::vector<double> pressure;       ///< [node] MPa; the same
  std::vector<OpeningFlow> openings;  ///< gates, then vents, as the case lists them
  double imbalance = 0;               ///< |sum of the rates| over the sum of what enters
  std::vector<double> residuals;      ///< relative, from 1, one an iteration
};

/// Solves (5.1) by P1 velocities with a bubble in each element and P1 pressures (5.3), the bubbles
/// condensed: conjugate gradients of Bramble and Pasciak, before them a multigrid cycle for each
/// component of the velocity; for the pressure its mass, and the flow between near walls.
///
/// The viscous term is the Laplacian, the same operator where div v = 0: at an opening
/// eta dv/dn - p n = -pressure n, which lets a parallel flow out unchanged.
///
/// Errors: usage (unknown group or one named twice, no gate and no body force, no vent and no other
/// way out, viscosity not positive, a gate without exactly one of pressure and rate), bad_input (a
/// flat element, a part of the mesh without an opening), not_converged, cancelled.
template <int D>
Result<Flow<D>> solve_stokes(const SimplexMesh<D>& mesh, const FlowCase<D>& flow,
                             const FlowSettings& settings = {}, const Progress& progress = {});

}  // namespace lamella
