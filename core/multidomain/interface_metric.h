#pragma once

#include <optional>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/simplex_mesh.h"
#include "core/metric/metric.h"
#include "core/multidomain/filling.h"

namespace lamella {

/// A gradient that is not zero, 1/mm.
template <int D>
struct FillingGradient {
  std::int32_t element = 0;
  std::int32_t region = 0;
  Vec<D> gradient = Vec<D>::Zero();
};

/// The gradients of all g_k (6.22), by ascending element, then region. Across a boundary facet
/// nothing jumps (adiabatic) but on the facet groups `jump` (ids), where outside of the mesh an
/// empty element without measure is seen: the infinite jump that makes a boundary layer (7.3.1).
template <int D>
std::vector<FillingGradient<D>> filling_gradients(const SimplexMesh<D>& mesh,
                                                  const Filling& filling,
                                                  const std::vector<std::int32_t>& jump = {});

/// How the tensors g_k g_k^T of the regions at a node become one.
enum class Combination {
  sum,          ///< their sum
  intersection  ///< the intersection of their metrics: sharper where three regions meet
};

struct InterfaceParams {
  /// [region] mm, size across its borders; of two regions the smaller counts.
  std::vector<double> h_min;
  int round = 1000;  ///< of the iteration, from 0: halves sizes step by step, h0 / 2^(round + 1)
  Combination combination = Combination::sum;
  std::vector<std::int32_t> jump{};  ///< facet groups with an infinite jump
  int threads = 0;                   ///< 0: all cores; the result does not depend on it
};

/// The multidomain metric (6.24) at the nodes, `natural` being M_natural there:
///   M = M_natural + T / (h^2 lambda_max(T)),  h = max(h_min, h0 / 2^(round + 1)),
/// clipped at eigenvalues of 1 / h_min^2 beside what `natural` asks for. T is the regularized
/// tensor of the gradients (6.25) and h0 the size of `natural` along its first direction. Against
/// (6.23) and (6.27) of the thesis: components are not compared (their maximum mirrors oblique
/// normals), and the size across is reached in steps rather than at a fixed ratio.
/// Errors: usage (a size that is not positive, or not one a region); cancelled.
template <int D>
Result<MetricField<D>> interface_metric(const SimplexMesh<D>& mesh, const Filling& filling,
                                        const MetricField<D>& natural,
                                        const InterfaceParams& params,
                                        const Progress& progress = {});

/// The same by distance, at any point: at the distance d from the nearest border with the normal n
///   M = M_natural + n n^T / h(d)^2,  h(d) = h_min + slope max(0, d - 2 h_min).
/// `natural` is asked where the result is and must live as long. It takes the smaller h_min of the
/// regions that the point and the border's other side belong to; that of a region without one is
/// `share` of the smallest natural size at the point.
template <int D>
MetricFunction<D> interface_metric_at(const Partition<D>& partition, MetricFunction<D> natural,
                                      std::vector<std::optional<double>> h_min, double share = 0.25,
                                      double slope = 0.5);

}  // namespace lamella
