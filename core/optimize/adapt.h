#pragma once

#include <optional>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"
#include "core/metric/metric.h"

namespace lamella {

/// How the metric of a new node follows from its neighbors' (section 3.2.2); a metric function
/// given to `adapt` goes before all of them.
enum class MetricMean {
  m,     ///< mean of M, (3.10) and (3.11)
  root,  ///< mean of M^(1/2), (3.15)
  size,  ///< mean of M^(-1/2), (3.19): cheapest first iterations, the default
  log    ///< log-Euclidean
};

struct AdaptParams {
  MetricMean mean = MetricMean::size;
  std::optional<double> chord_tolerance{};  ///< mm; unset: 1e-3 of the box diagonal
  double feature_angle = 0.7;  ///< radians between facets that makes an edge a feature, where no
                               ///< reference surface tells
  int sweeps = 24;             ///< upper bound; the work set empties before
  double relaxation = 3;       ///< weight of the shape in the first sweeps, >= 1; 1: none
  int relaxed_sweeps = 3;      ///< upper bound of the relaxed sweeps
  std::uint64_t seed = 1;      ///< the node a round begins with; any seed is as good
};

template <int D>
struct Adapted {
  SimplexMesh<D> mesh;
  MetricField<D> metric;  ///< [node] of the new mesh, transported or evaluated
};

/// Algorithm 3.1: the mesh whose elements are unit and equilateral under `metric`; the input is
/// left untouched. Boundary facets keep their group and CAD face; nodes of the boundary stay on
/// `surface` within the chord tolerance (without a surface: on the boundary of the input).
/// Errors: bad_input (metric size or mesh invalid), cancelled (nothing is returned).
template <int D>
Result<Adapted<D>> adapt(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                         const ReferenceSurface<D>* surface = nullptr,
                         const AdaptParams& params = {}, const Progress& progress = {},
                         const MetricFunction<D>& metric_at = {});

}  // namespace lamella
