#include "core/optimize/adapt.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/base/parallel.h"
#include "core/mesh/quality.h"
#include "core/optimize/star_optimizer.h"

namespace lamella {
namespace {

/// Rounds of one kind.
struct Stage {
  SweepParams sweep;
  int rounds;      ///< upper bound
  double settled;  ///< ends when operations fall below this share of the nodes
};

/// First the sizes with the shape relaxed, since min(shape, size) can freeze where every operation
/// must pass through worse shapes; then the elements on average; then the worst of them.
template <int D>
std::vector<Stage> stages(const AdaptParams& params) {
  Stage sizes, average, worst;
  sizes.sweep.relaxation = params.relaxation;
  sizes.rounds = params.relaxed_sweeps;
  sizes.settled = 0.02;
  average.sweep.criterion = Criterion::energy;
  average.sweep.split_above = 1.3;
  average.sweep.collapse_below = 0.8;
  average.sweep.good_enough = 0.8;
  average.rounds = params.sweeps;
  average.settled = 0.01;
  worst.sweep.attention = 0.45;
  worst.sweep.good_enough = 0.45;
  worst.rounds = 3;
  worst.settled = 0.0001;
  return {sizes, average, worst};
}

template <int D>
class Adaption {
 public:
  Adaption(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
           const BoundaryModel<D>& model, const AdaptParams& params,
           const MetricFunction<D>& metric_at, double scale)
      : model_(model), params_(params), metric_at_(metric_at), scale_(scale) {
    work_.points = mesh.points;
    work_.fixed = model.fixed();
    work_.metric.resize(mesh.points.size());
    parallel_each(mesh.node_count(), params.threads, {}, [&](std::size_t i) {
      work_.metric[i + 1] =
          Packed<D>::from(metric_at ? metric_at(mesh.points[i + 1]) : metric[i + 1]);
    });
    if (metric_at) {
      work_.asked = mesh.points;
    } else {
      work_.asked.clear();
    }
    work_.elements = mesh.elements;
    work_.label = mesh.element_body;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      work_.elements.push_back(Topology<D>::virtual_element(mesh.facets[f]));
      work_.label.push_back(model.tag_of_facet(f));
    }
    wake_all();
  }

  void wake_all() { work_.dirty.assign(work_.points.size(), 1); }
  std::size_t node_count() const { return work_.node_count(); }
  AdaptReport& report() { return report_; }

  /// Every block once. Returns the number of operations.
  std::size_t round(const SweepParams& sweep, const Progress& progress) {
    if (work_.node_count() > sorted_at_ + sorted_at_ / 2) {
      sort_in_space(work_);
      sorted_at_ = work_.node_count();
    }
    const Partition<D> partition(work_, report_.sweeps++, params_.threads);
    std::vector<Block<D>> blocks(partition.count());
    std::vector<AdaptReport> counts(blocks.size());
    std::atomic<std::size_t> operations = 0, finished = 0;
    parallel_each(
        blocks.size(), params_.threads, {},
        [&](std::size_t i) {
          blocks[i] = partition.extract(work_, static_cast<int>(i));
          if (!partition.pending(static_cast<int>(i)) || progress.cancelled()) return;
          StarOptimizer<D> star(std::move(blocks[i]), model_, params_, metric_at_, scale_);
          operations += star.sweep(sweep, progress);
          counts[i] = star.counts();
          blocks[i] = star.take();
          progress.report(static_cast<double>(++finished) / static_cast<double>(blocks.size()));
        },
        1);
    work_ = merge(work_, blocks, params_.threads);
    for (const AdaptReport& c : counts) {
      report_.splits += c.splits;
      report_.collapses += c.collapses;
      report_.swaps += c.swaps;
      report_.moves += c.moves;
    }
    return operations;
  }

  /// MB of all arrays while a round is under way.
  double memory() const {
    const double node = sizeof(Vec<D>) * (1 + !work_.asked.empty()) + sizeof(Packed<D>) + 8;
    const double element = sizeof(typename WorkMesh<D>::Element) + 4;
    return 3e-6 * (node * static_cast<double>(work_.points.size()) +
                   element * static_cast<double>(work_.elements.size()));
  }

  Adapted<D> result(const SimplexMesh<D>& original) {
    Adapted<D> out;
    out.report = report_;
    out.mesh.bodies = original.bodies;
    out.mesh.groups = original.groups;
    out.mesh.points = std::move(work_.points);
    out.metric.reserve(work_.metric.size());
    out.metric.push_back(Metric<D>::Identity());
    for (std::size_t n = 1; n < work_.metric.size(); ++n)
      out.metric.push_back(work_.metric[n].full());
    for (std::size_t e = 0; e < work_.elements.size(); ++e) {
      const auto& nodes = work_.elements[e];
      if (nodes[0] != 0) {
        out.mesh.elements.push_back(nodes);
        out.mesh.element_body.push_back(work_.label[e]);
        continue;
      }
      const auto& tag = model_.tag(work_.label[e]);
      if (static_cast<std::size_t>(tag.group) >= original.groups.size()) continue;  // interface
      out.mesh.facets.push_back(Topology<D>::facet_of(nodes));
      out.mesh.facet_group.push_back(tag.group);
      out.mesh.facet_face.push_back(tag.face);
    }
    return out;
  }

 private:
  const BoundaryModel<D>& model_;
  const AdaptParams& params_;
  const MetricFunction<D>& metric_at_;
  double scale_;
  WorkMesh<D> work_;
  AdaptReport report_;
  std::size_t sorted_at_ = 0;
};

template <int D>
Result<void> check_input(const SimplexMesh<D>& mesh, const MetricField<D>& metric, bool function) {
  if (mesh.elements.empty() || mesh.facets.empty())
    return Error{Code::bad_input, "The mesh to adapt has no elements or no boundary facets.",
                 "Read it again with its boundary, or generate a first mesh."};
  if (function) return {};
  if (metric.size() != mesh.points.size())
    return Error{Code::bad_input,
                 "The metric has " + std::to_string(metric.empty() ? 0 : metric.size() - 1) +
                     " values for " + std::to_string(mesh.node_count()) + " nodes.",
                 "Give one metric a node, in the order of the nodes."};
  for (std::size_t n = 1; n < metric.size(); ++n)
    if (!(metric[n].determinant() > 0) || !metric[n].allFinite())
      return Error{Code::bad_input,
                   "The metric of node " + std::to_string(n) + " is not positive definite.",
                   "Sizes must be positive and finite in every direction."};
  return {};
}

}  // namespace

template <int D>
Result<Adapted<D>> adapt(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                         const ReferenceSurface<D>* surface, const AdaptParams& params,
                         const Progress& progress, const MetricFunction<D>& metric_at) {
  if (Result<void> good = check_input(mesh, metric, static_cast<bool>(metric_at)); !good)
    return good.error();
  Vec<D> lo = mesh.points[1], hi = lo;
  for (std::size_t n = 1; n < mesh.points.size(); ++n) {
    lo = lo.cwiseMin(mesh.points[n]);
    hi = hi.cwiseMax(mesh.points[n]);
  }
  const double scale = (hi - lo).norm();
  const SimplexMesh<D>& whole = mesh;
  const BoundaryModel<D> model(whole, surface, params.chord_tolerance.value_or(1e-3 * scale),
                               params.feature_angle, params.frozen_groups, params.frozen_bodies);
  Adaption<D> adaption(whole, metric, model, params, metric_at, scale);
  AdaptReport& report = adaption.report();

  const std::vector<Stage> all = stages<D>(params);
  int rounds = 0;
  for (const Stage& stage : all) rounds += stage.rounds;
  int past = 0;
  for (const Stage& stage : all) {
    adaption.wake_all();
    for (int i = 0; i < stage.rounds && !progress.cancelled(); ++i) {
      const double begin = static_cast<double>(past + i) / rounds;
      const std::size_t done = adaption.round(
          stage.sweep, progress.portion(begin, begin + 1.0 / rounds, "adapting"));
      if (getenv("VERBOSE")) fprintf(stderr, "  stage %d round %d ops %zu nodes %zu [s %zu c %zu w %zu m %zu]\n", (int)(&stage-&all[0]), i, done, adaption.node_count(), report.splits, report.collapses, report.swaps, report.moves);
      if (static_cast<double>(done) < stage.settled * static_cast<double>(adaption.node_count()))
        break;
    }
    past += stage.rounds;
  }
  report.cancelled = progress.cancelled();
  progress.report(1);
  return adaption.result(mesh);
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
