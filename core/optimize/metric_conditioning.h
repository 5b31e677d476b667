#pragma once

#include <optional>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/simplex_mesh.h"
#include "core/metric/metric.h"

namespace lamella {

/// How the growth of sizes from node to node is bounded. On the edge e = pq let
/// h_p(e) = |e| / ||e||_{M_p} be the size (mm) that p asks along e.
enum class GradationKind {
  /// Nodes keep their directions and the ratios of their sizes; each is scaled by one factor <= 1,
  /// the largest with h_q(e) <= h_p(e) + |e| ln beta on every edge both ways: along e, sizes change
  /// by the factor beta at most per unit length. Only sizes along edges are compared.
  isotropic,
  /// The whole metric of p spreads: at the metric distance l = ||e||_{M_p} it has grown to
  /// M_p(q) = M_p / (1 + l ln beta)^2 (Alauzet 2010, growth in the metric space), and
  /// M_q >= M_p(q) as quadratic forms on every edge both ways, by M_q <- M_q intersected with
  /// M_p(q) (A.1.3.2). Directions that p and q share are kept; where they differ, those of the
  /// simultaneous reduction replace them.
  intersection
};

/// What to bound; an unset value bounds nothing.
struct ConditionParams {
  std::optional<double> h_min{};           ///< mm, > 0
  std::optional<double> h_max{};           ///< mm, >= h_min
  std::optional<double> max_anisotropy{};  ///< >= 1, largest over smallest size of a node
  std::optional<double> gradation{};       ///< beta > 1
  GradationKind gradation_kind = GradationKind::intersection;
  std::optional<double> elements{};  ///< > 0, forecast (1.34) wanted after all bounds
  int gradation_sweeps = 500;        ///< upper bound; information moves by one edge a sweep
  int threads = 0;                   ///< 0: all cores; the result does not depend on it

  /// Something is bounded at all.
  bool any() const { return h_min || h_max || max_anisotropy || gradation || elements; }
};

/// What one step did. Factors are >= 1 unless said otherwise, and 1 where nothing changed.
struct ConditionStep {
  enum class Kind { scale, h_min, h_max, anisotropy, gradation };
  Kind kind = Kind::scale;
  std::size_t nodes = 0;       ///< changed by the step
  double size_largest = 1;     ///< largest factor, up or down, of one of the sizes of a node
  double size_mean = 1;        ///< geometric mean of that factor over the nodes changed
  double anisotropy_lost = 1;  ///< largest quotient before / after of a node's size ratio
  double anisotropy_mean = 1;  ///< geometric mean of after / before over the nodes changed; below
                               ///< 1: anisotropy was lost
  double elements_before = 0, elements_after = 0;  ///< forecast (1.34)
  int sweeps = 0;                                  ///< of the gradation
  bool settled = true;  ///< false: the gradation ended by its bound on sweeps
};
/// "h_min", "gradation" and so on.
const char* step_name(ConditionStep::Kind kind);

struct ConditionReport {
  std::vector<ConditionStep> steps;                ///< in the order they were done
  double scale = 1;                                ///< of all sizes, before the bounds
  double elements_before = 0, elements_after = 0;  ///< forecast (1.34)
  bool elements_reached = true;  ///< false: the bounds leave no way within 1 % of `elements`
};

template <int D>
struct Conditioned {
  MetricField<D> metric;  ///< [node]
  ConditionReport report;
};

/// Conditions a nodal metric on its mesh. With h_1 <= .. <= h_D the sizes (mm) of a node, these
/// steps follow one another, each as far as it is asked:
/// 1. scale: h_k <- s h_k, one s for all nodes. It is the root of N(s) = `elements`, found by
///    bracketing, where N is the forecast after all the steps; (1.34) times the number of elements:
///    N = sum_T |T| sqrt(det M(T)) / |T_eq| with M(T) of (3.2), the integral of sqrt(det M) in unit
///    simplices.
/// 2. h_min: h_k <- max(h_k, h_min), and h_max: h_k <- min(h_k, h_max).
/// 3. anisotropy: h_k <- min(h_k, r h_1): large sizes shrink, so that no small one is lost.
/// 4. gradation, see GradationKind: a fixed point of sweeps in which every node looks at the values
///    its neighbors had before the sweep, the most violated first; it never coarsens. The bound of
///    the anisotropy is held in it. What falls below h_min (the metric of the reduction may be
///    finer than both) is raised to it at last: h_min goes before the gradation. For the
///    intersection M_q >= .999 M_p(q) is enough.
/// Steps 1 to 3 change eigenvalues only; a node that meets its bounds keeps its metric to the bit.
///
/// Errors: usage (a bound out of range, h_min above h_max), bad_input (a metric of another length
/// or not positive definite; no elements), cancelled.
template <int D>
Result<Conditioned<D>> condition_metric(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                                        const ConditionParams& params,
                                        const Progress& progress = {});

/// Steps 1 to 3 at one place, with the scale s given: what a metric that is a function of position
/// needs besides its values at the nodes.
template <int D>
Metric<D> bounded_metric(const Metric<D>& metric, const ConditionParams& params, double scale = 1);

}  // namespace lamella
