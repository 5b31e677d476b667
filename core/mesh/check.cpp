#include "core/mesh/check.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>

#include "core/mesh/adjacency.h"
#include "core/mesh/quality.h"

namespace lamella {
namespace {

/// Calls work(i) for 0 <= i < n on all cores; stops early when cancelled. Each call writes its own
/// entries only, so that the result does not depend on the threads.
template <class Work>
void for_all(std::size_t n, const Progress& progress, Work work) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, 1024), [&](const auto& range) {
    if (progress.cancelled()) return;
    for (std::size_t i = range.begin(); i != range.end(); ++i) work(i);
  });
}

/// Criteria that are summed up over the elements, [element].
struct ElementSamples {
  std::vector<double> mean_ratio, mean_ratio_mean, shape, quality, frobenius, invariant, aspect;
  std::vector<char> flat;
  explicit ElementSamples(std::size_t n)
      : mean_ratio(n),
        mean_ratio_mean(n),
        shape(n),
        quality(n),
        frobenius(n),
        invariant(n),
        aspect(n),
        flat(n) {}
};

/// The entries of elements that are not flat.
std::vector<double> solid(std::vector<double> values, const std::vector<char>& flat) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!flat[i]) values[kept++] = values[i];
  values.resize(kept);
  return values;
}

/// Errors: cancelled.
template <int D>
Result<void> measure_edges(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                           CheckReport& report, const Progress& progress) {
  const auto edges = unique_edges<D>(mesh.elements, mesh.points.size());
  std::vector<double> lengths(edges.size());
  for_all(edges.size(), progress, [&](std::size_t i) {
    const auto [a, b] = edges[i];
    lengths[i] = edge_length<D>(mesh.points[b] - mesh.points[a], metric[a], metric[b]);
  });
  if (progress.cancelled()) return cancelled_error();
  report.edges = edges.size();
  const auto unit = std::count_if(lengths.begin(), lengths.end(), is_unit_length);
  if (!lengths.empty())
    report.unit_edges = static_cast<double>(unit) / static_cast<double>(lengths.size());
  report.edge_length = stats_of(std::move(lengths));
  return {};
}

}  // namespace

Stats stats_of(std::vector<double> sample) {
  Stats s;
  s.count = sample.size();
  if (sample.empty()) return s;
  for (const double v : sample) s.mean += v;
  s.mean /= static_cast<double>(s.count);
  const auto [least, greatest] = std::minmax_element(sample.begin(), sample.end());
  s.min = *least;
  s.max = *greatest;
  // From the lowest up: what lies before one is sorted out for those after it.
  auto from = sample.begin();
  const auto at = [&](double share) {
    const auto place =
        sample.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(s.count - 1));
    std::nth_element(from, place, sample.end());
    from = place;
    return *place;
  };
  s.p1 = at(0.01);
  s.p5 = at(0.05);
  s.p25 = at(0.25);
  s.p50 = at(0.5);
  s.p75 = at(0.75);
  s.p95 = at(0.95);
  s.p99 = at(0.99);
  return s;
}

template <int D>
Result<CheckReport> check(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                          const Progress& progress) {
  if (metric.size() != mesh.points.size())
    return Error{Code::bad_input,
                 "The metric has " + std::to_string(metric.empty() ? 0 : metric.size() - 1) +
                     " nodal values, the mesh has " + std::to_string(mesh.node_count()) + " nodes.",
                 "Give the metric that was made for this mesh."};
  auto topology = inspect(mesh, progress.portion(0, 0.4));
  if (!topology) return topology.error();
  if (topology->bad_arrays + topology->bad_indices + topology->bad_points > 0)
    return Error{Code::bad_input, "The mesh cannot be measured: " + topology->first_finding, ""};
  CheckReport report;
  report.mesh = std::move(*topology);
  report.dimension = D;

  // Before there are samples of the elements, which take as much memory.
  if (Result<void> done = measure_edges(mesh, metric, report, progress); !done) return done.error();
  progress.report(0.6);

  const std::size_t n = mesh.elements.size();
  ElementSamples samples(n);
  for_all(n, progress, [&](std::size_t i) {
    const auto& e = mesh.elements[i];
    const auto p = mesh.corners(e);
    const Metric<D> mean = mean_metric<D>(metric, e);
    const ElementQuality q = element_quality<D>(p, mean);
    samples.shape[i] = q.shape;
    samples.quality[i] = q.quality;
    samples.mean_ratio_mean[i] = q.mean_ratio;
    samples.mean_ratio[i] = element_quality<D>(p, densest_metric<D>(metric, e)).mean_ratio;
    samples.flat[i] = signed_measure<D>(p) == 0;
    if (samples.flat[i]) return;
    const Conformity c = conformity<D>(p, mean);
    samples.frobenius[i] = c.frobenius;
    samples.invariant[i] = c.invariant;
    samples.aspect[i] = aspect_ratio<D>(p);
  });
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.9);

  report.flat = static_cast<std::size_t>(std::count(samples.flat.begin(), samples.flat.end(), 1));
  report.allocation = allocation_factor(mesh, metric);
  const auto of = [&](Stats& stats, std::vector<double>& sample) {
    return [&] { stats = stats_of(std::move(sample)); };
  };
  const auto of_solid = [&](Stats& stats, std::vector<double>& sample) {
    return [&] { stats = stats_of(solid(std::move(sample), samples.flat)); };
  };
  tbb::parallel_invoke(of(report.mean_ratio, samples.mean_ratio),
                       of(report.mean_ratio_mean, samples.mean_ratio_mean),
                       of(report.shape, samples.shape), of(report.quality, samples.quality),
                       of_solid(report.conformity, samples.frobenius),
                       of_solid(report.conformity_invariant, samples.invariant),
                       of_solid(report.aspect_ratio, samples.aspect));
  progress.report(1);
  return report;
}

template Result<CheckReport> check<2>(const SimplexMesh<2>&, const MetricField<2>&,
                                      const Progress&);
template Result<CheckReport> check<3>(const SimplexMesh<3>&, const MetricField<3>&,
                                      const Progress&);
template Result<CheckReport> check<4>(const SimplexMesh<4>&, const MetricField<4>&,
                                      const Progress&);

}  // namespace lamella
