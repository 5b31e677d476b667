#include "core/optimize/adapt.h"

#include "core/optimize/star_optimizer.h"

namespace lamella {

template <int D>
Result<Adapted<D>> adapt(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                         const ReferenceSurface<D>* surface, const AdaptParams& params,
                         const Progress& progress, const MetricFunction<D>& metric_at) {
  if (mesh.elements.empty() || mesh.facets.empty())
    return Error{Code::bad_input, "The mesh to adapt has no elements or no boundary facets.",
                 "Read it again with its boundary, or generate a first mesh."};
  if (!metric_at && metric.size() != mesh.points.size())
    return Error{Code::bad_input,
                 "The metric has " + std::to_string(metric.empty() ? 0 : metric.size() - 1) +
                     " values for " + std::to_string(mesh.node_count()) + " nodes.",
                 "Give one metric a node, in the order of the nodes."};
  if (!metric_at)
    for (std::size_t n = 1; n < metric.size(); ++n)
      if (!(metric[n].determinant() > 0) || !metric[n].allFinite())
        return Error{Code::bad_input,
                     "The metric of node " + std::to_string(n) + " is not positive definite.",
                     "Sizes must be positive and finite in every direction."};
  Vec<D> lo = mesh.points[1], hi = lo;
  for (std::size_t n = 1; n < mesh.points.size(); ++n) {
    lo = lo.cwiseMin(mesh.points[n]);
    hi = hi.cwiseMax(mesh.points[n]);
  }
  const double tolerance = params.chord_tolerance.value_or(1e-3 * (hi - lo).norm());
  StarOptimizer<D> optimizer(mesh, metric, surface, params, metric_at, tolerance);
  // min(shape, size) can freeze where every operation must pass through worse shapes: sizes are
  // sought first with the shape relaxed, then both count.
  bool relaxed = params.relaxation > 1;
  if (relaxed) optimizer.set_relaxation(params.relaxation);
  for (int i = 0; i < params.sweeps; ++i) {
    const double begin = static_cast<double>(i) / params.sweeps;
    const std::size_t done =
        optimizer.sweep(progress.portion(begin, begin + 1.0 / params.sweeps, "adapting"));
    if (progress.cancelled()) return cancelled_error();
    const bool settled = done * (relaxed ? 50 : 1000) < optimizer.node_count();
    if (relaxed && (settled || i + 1 >= params.relaxed_sweeps)) {
      relaxed = false;
      optimizer.set_relaxation(1);
    } else if (settled) {
      break;
    }
  }
  progress.report(1);
  return optimizer.result(mesh);
}

template Result<Adapted<2>> adapt(const SimplexMesh<2>&, const MetricField<2>&,
                                  const ReferenceSurface<2>*, const AdaptParams&, const Progress&,
                                  const MetricFunction<2>&);
template Result<Adapted<3>> adapt(const SimplexMesh<3>&, const MetricField<3>&,
                                  const ReferenceSurface<3>*, const AdaptParams&, const Progress&,
                                  const MetricFunction<3>&);
template Result<Adapted<4>> adapt(const SimplexMesh<4>&, const MetricField<4>&,
                                  const ReferenceSurface<4>*, const AdaptParams&, const Progress&,
                                  const MetricFunction<4>&);

}  // namespace lamella
