#include "core/optimize/adapt.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/parallel.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/interfaces.h"
#include "core/mesh/quality.h"
#include "core/optimize/memory_need.h"
#include "core/optimize/star_optimizer.h"

namespace lamella {
namespace {

/// Rounds of one kind.
struct Stage {
  SweepParams sweep;
  int rounds;               ///< upper bound
  double settled;           ///< ends when operations fall below this share of the nodes
  bool count_moves = true;  ///< among the operations
};

/// First the sizes with the shape relaxed, since min(shape, size) can freeze where every operation
/// must pass through worse shapes; then the elements on average, first with reconnections that cost
/// a little energy at random, which lets defects of the mesh wander and meet (simulated annealing);
/// then the worst elements; in 2D at last the nodes' places.
template <int D>
std::vector<Stage> stages(const AdaptParams& params, bool coarse, bool function) {
  std::vector<Stage> all;
  Stage sizes;
  sizes.sweep.relaxation = params.relaxation;
  sizes.sweep.good_enough = D == 4 ? 0.7 : 0.3;
  // In 4D more of these leave elements that nothing mends afterwards.
  sizes.rounds = D == 4 ? std::min(1, params.relaxed_sweeps) : params.relaxed_sweeps;
  sizes.settled = D == 3 ? 0.7 : 0.4;
  sizes.count_moves = false;
  // Nodes that the first sweeps over a coarse mesh put in too many cost twice: others take them
  // out again.
  if (D == 3 && coarse) sizes.sweep.split_above = 1.5;
  all.push_back(sizes);

  Stage average;
  average.sweep.criterion = Criterion::energy;
  average.sweep.split_above = D == 2 ? 1.2 : 1.3;
  average.sweep.collapse_below = D == 2 ? 0.9 : 0.8;
  average.sweep.good_enough = D == 2 ? 1 : D == 4 ? 0.8 : 0.5;
  average.rounds = params.sweeps;
  average.settled = D == 4 ? 0.2 : 0.9;
  Stage hot = average;
  hot.rounds = 1;
  hot.sweep.temperature = D == 2 ? 0.4 : D == 4 ? 0.8 : 0.6;
  for (int i = 0; i < (D == 2 ? 60 : D == 4 ? 4 : 2); ++i) {
    all.push_back(hot);
    hot.sweep.temperature *= D == 2 ? 0.98 : 0.7;
  }
  all.push_back(average);

  Stage worst;
  worst.sweep.attention = 0.45;
  worst.sweep.good_enough = 0.45;
  worst.rounds = 8;
  worst.settled = 1e-4;
  all.push_back(worst);
  // A metric that is only carried from node to node says too little of a single one, and a ruler of
  // metrics nothing of other averages.
  if (D == 3 && function && params.element_mean == MetricMean::m &&
      params.size_average == SizeAverage::l2) {
    worst.sweep.strict = true;
    all.push_back(worst);
  }
  if constexpr (D == 2) {
    // Hardly a triangle is left that an operation would help: the places of the nodes are the rest.
    // Sizes are as good as they get, so that shapes count for more.
    Stage places = average;
    places.sweep.moves_only = true;
    places.sweep.size_weight = 0.7;
    places.rounds = 20;
    places.settled = 0.05;
    all.push_back(places);
  }
  return all;
}

/// A mesh that has its sizes already is there to be polished: more patience.
template <int D>
void polish(Stage& stage) {
  if (D != 3 || stage.sweep.criterion != Criterion::energy) return;
  stage.sweep.good_enough = 0.8;
  stage.settled = 0.2;
}

template <int D>
class Adaption {
 public:
  Adaption(const SimplexMesh<D>& mesh, const MetricField<D>& metric, const BoundaryModel<D>& model,
           const AdaptParams& params, const MetricFunction<D>& metric_at, double scale)
      : model_(model), params_(params), metric_at_(metric_at), scale_(scale) {
    work_.points = mesh.points;
    work_.fixed = model.fixed();
    work_.metric.resize(mesh.points.size());
    parallel_each(mesh.node_count(), params.threads, {}, [&](std::size_t i) {
      work_.metric[i + 1] =
          Packed<D>::from(metric.empty() ? metric_at(mesh.points[i + 1]) : metric[i + 1]);
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

  const WorkMesh<D>& work() const { return work_; }
  void wake_all() { work_.dirty.assign(work_.points.size(), 1); }
  std::size_t node_count() const { return work_.node_count(); }
  AdaptReport& report() { return report_; }

  /// Every block once. Returns the number of operations.
  std::size_t round(const SweepParams& sweep, const Progress& progress) {
    if (work_.node_count() > sorted_at_ + sorted_at_ / 2) {
      sort_in_space(work_);
      sorted_at_ = work_.node_count();
    }
    return run(BlockPartition<D>(work_, report_.sweeps, params_.threads), sweep, 1, progress);
  }

  /// As many sweeps over the surroundings of poor elements, where they are a small part of the
  /// mesh: what is good already costs one look. Nothing when they are more than that.
  std::optional<std::size_t> mend(const SweepParams& sweep, int sweeps, const Progress& progress) {
    std::vector<std::int32_t> patch = around_poor(sweep.attention, sweep.strict);
    const auto count = static_cast<std::size_t>(std::count(patch.begin(), patch.end(), 1));
    if (count > patch.size() / 8) return std::nullopt;
    if (count == 0) return 0;
    // The rest goes through in pieces, which free their memory one by one.
    constexpr std::size_t piece = 200'000;
    for (std::size_t e = 0; e < patch.size(); ++e)
      patch[e] = patch[e] ? 0 : 1 + static_cast<std::int32_t>(e / piece);
    const auto blocks = static_cast<int>(2 + (patch.size() - 1) / piece);
    return run(BlockPartition<D>(work_, patch, blocks, params_.threads), sweep, sweeps, progress,
               1);
  }

  /// Of the elements, those that `mend` has found poor.
  double poor_share() const { return poor_share_; }

  /// Each of the blocks, or of the first `active` ones, as many times, or until nothing is left to
  /// do. Returns the number of operations of the last sweeps.
  std::size_t run(const BlockPartition<D>& partition, const SweepParams& sweep, int sweeps,
                  const Progress& progress, int active = std::numeric_limits<int>::max()) {
    std::vector<Block<D>> blocks(partition.count());
    std::vector<AdaptReport> counts(blocks.size());
    std::vector<int> swept(blocks.size(), 0);
    std::atomic<std::size_t> operations = 0, finished = 0;
    parallel_each(
        blocks.size(), params_.threads, {},
        [&](std::size_t i) {
          blocks[i] = partition.extract(work_, static_cast<int>(i));
          const int b = static_cast<int>(i);
          if (b >= active || !partition.pending(b) || progress.cancelled()) return;
          SweepParams local = sweep;
          const auto size = static_cast<double>(blocks[i].mesh.elements.size());
          const double share = most_elements_ * size / static_cast<double>(work_.elements.size());
          if (share < 1e15) local.most_elements = static_cast<std::size_t>(share);
          StarOptimizer<D> star(std::move(blocks[i]), model_, params_, metric_at_, scale_);
          std::size_t done = 0;
          for (int s = 0; s < sweeps; ++s) {
            done = star.sweep(local, progress);
            ++swept[i];
            if (done == 0) break;
          }
          operations += done;
          if (star.overfull()) overfull_ = true;
          counts[i] = star.counts();
          blocks[i] = star.take();
          progress.report(static_cast<double>(++finished) / static_cast<double>(blocks.size()));
        },
        1);
    // The blocks have them all; a mesh of ten million elements is a gigabyte in two copies.
    work_.elements = {};
    work_.label = {};
    work_ = merge(work_, blocks, params_.threads);
    report_.sweeps += std::max(1, *std::max_element(swept.begin(), swept.end()));
    for (const AdaptReport& c : counts) {
      report_.splits += c.splits;
      report_.collapses += c.collapses;
      report_.swaps += c.swaps;
      report_.moves += c.moves;
    }
    return operations;
  }

  /// Opens what blocks, then lets the nodes settle.
  void open_blocking(const Progress& progress) {
    for (int i = 0; i < 3 && !progress.cancelled(); ++i) {
      StarOptimizer<D> star(whole_block(work_), model_, params_, metric_at_, scale_);
      const std::size_t added = star.open_blocking(progress);
      report_.splits += added;
      report_.blocking_treated += added;
      work_ = std::move(star.take().mesh);
      if (added == 0) break;
    }
    wake_all();
    SweepParams settle;
    settle.criterion = Criterion::energy;
    settle.moves_only = true;
    for (int i = 0; i < 3; ++i) round(settle, progress);
  }

  /// Bound of the elements of the whole mesh.
  void set_most_elements(double most) { most_elements_ = most; }
  bool overfull() const { return overfull_; }
  std::size_t element_count() const { return work_.elements.size(); }

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
  /// [element] 1 for those that touch a neighbor of a node of an element below the quality.
  std::vector<std::int32_t> around_poor(double quality, bool strict) {
    RatingKernel<D> kernel;
    kernel.element_mean = params_.element_mean;
    kernel.size_average = params_.size_average;
    kernel.points = &work_.points;
    const MetricCarrier<D> carrier(params_.element_mean);
    std::vector<Packed<D>> own;
    if (params_.element_mean != MetricMean::m) {
      own.resize(work_.metric.size());
      for (std::size_t n = 1; n < own.size(); ++n) own[n] = carrier.carry(work_.metric[n]);
    }
    const auto& carried = own.empty() ? work_.metric : own;
    if (strict) kernel.metrics = &carried;
    std::vector<Rating> ratings(work_.elements.size());
    parallel_ranges(
        ratings.size(), 4096, params_.threads, [&](std::size_t first, std::size_t last) {
          FaceBatch<D>().rate_elements({work_.elements, work_.points, carried}, first, last, kernel,
                                       std::span(ratings).subspan(first, last - first));
        });
    // Ring by ring: an element joins when one of its nodes has.
    std::vector<std::int32_t> ring(work_.points.size(), 0), in(work_.elements.size(), 0);
    const auto mark = [&](std::size_t e, std::int32_t with) {
      for (NodeId n : work_.elements[e])
        if (n != 0 && ring[n] == 0) ring[n] = with;
    };
    std::size_t poor = 0;
    for (std::size_t e = 0; e < in.size(); ++e)
      if (ratings[e].quality < quality) {
        mark(e, 1);
        ++poor;
      }
    poor_share_ = static_cast<double>(poor) / static_cast<double>(in.size());
    for (std::int32_t r = 1; r <= 2; ++r)
      for (std::size_t e = 0; e < in.size(); ++e) {
        const auto& nodes = work_.elements[e];
        if (std::none_of(nodes.begin(), nodes.end(),
                         [&](NodeId n) { return n != 0 && ring[n] != 0 && ring[n] <= r; }))
          continue;
        if (r == 1) mark(e, 2);
        if (r == 2) in[e] = 1;
      }
    return in;
  }

  const BoundaryModel<D>& model_;
  const AdaptParams& params_;
  const MetricFunction<D>& metric_at_;
  double scale_;
  WorkMesh<D> work_;
  AdaptReport report_;
  std::size_t sorted_at_ = 0;
  double poor_share_ = 0;
  double most_elements_ = std::numeric_limits<double>::infinity();
  std::atomic<bool> overfull_ = false;
};

/// Drops listed interfaces that have become none: where a thin part of a body vanished, its two
/// sides lie on each other within the other body.
template <int D>
void drop_false_interfaces(SimplexMesh<D>& mesh) {
  using Facet = typename SimplexMesh<D>::Facet;
  std::vector<Facet> real;
  const auto uses = face_uses<D>(mesh.elements, mesh.points.size());
  for_each_face<D>(uses, [&](std::size_t first, std::size_t last) {
    if (last - first == 1 ||
        mesh.element_body[uses[first].element] != mesh.element_body[uses[first + 1].element])
      real.push_back(uses[first].nodes);
  });
  std::vector<char> seen(real.size(), 0);
  std::size_t kept = 0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    Facet nodes = mesh.facets[f];
    std::sort(nodes.begin(), nodes.end());
    const auto at = std::lower_bound(real.begin(), real.end(), nodes) - real.begin();
    const auto i = static_cast<std::size_t>(at);
    if (i == real.size() || real[i] != nodes || seen[i]) continue;
    seen[i] = 1;
    mesh.facets[kept] = mesh.facets[f];
    mesh.facet_group[kept] = mesh.facet_group[f];
    mesh.facet_face[kept++] = mesh.facet_face[f];
  }
  mesh.facets.resize(kept);
  mesh.facet_group.resize(kept);
  mesh.facet_face.resize(kept);
}

/// Elements a node in a mesh of good elements.
template <int D>
constexpr double elements_a_node = D == 2   ? 2
                                   : D == 3 ? 5.5
                                            : 16;

/// (1.34) before the start: nodes and MB.
template <int D>
void forecast(const SimplexMesh<D>& mesh, const WorkMesh<D>& work, AdaptReport& report) {
  MetricField<D> metric(work.metric.size(), Metric<D>::Identity());
  for (std::size_t n = 1; n < metric.size(); ++n) metric[n] = work.metric[n].full();
  const double elements =
      allocation_factor(mesh, metric) * static_cast<double>(mesh.elements.size());
  report.forecast_nodes = elements / elements_a_node<D>;
  report.forecast_memory = 1e-6 * bytes_an_element<D> * elements;
}

template <int D>
Error over_budget(const AdaptReport& report, double limit, std::size_t elements) {
  const auto number = [](double x) { return std::to_string(static_cast<long long>(std::ceil(x))); };
  return {Code::memory,
          "The adaption needs more than the " + number(limit) + " MB allowed: it stopped at " +
              std::to_string(elements) + " elements; " + number(report.forecast_memory) +
              " MB and " + number(report.forecast_nodes) + " nodes are forecast.",
          "Allow more memory, ask for larger sizes or fewer layers, or bound the number of "
          "elements."};
}

template <int D>
Result<void> check_input(const SimplexMesh<D>& mesh, const MetricField<D>& metric, bool function) {
  if (mesh.elements.empty() || mesh.facets.empty())
    return Error{Code::bad_input, "The mesh to adapt has no elements or no boundary facets.",
                 "Read it again with its boundary, or generate a first mesh."};
  if (function && metric.empty()) return {};
  return check_metric<D>(metric, mesh.node_count());
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
  const auto [whole, outer, given] = list_interfaces(mesh);
  const BoundaryModel<D> model(whole, surface, params.chord_tolerance.value_or(1e-3 * scale),
                               params.feature_angle, params.frozen_groups, params.frozen_bodies,
                               outer, given);
  Adaption<D> adaption(whole, metric, model, params, metric_at, scale);
  AdaptReport& report = adaption.report();
  forecast(mesh, adaption.work(), report);
  if (params.memory_limit)
    adaption.set_most_elements(*params.memory_limit * 1e6 / bytes_an_element<D>);

  // A small mesh costs little either way.
  const bool coarse = report.forecast_nodes > 50 * static_cast<double>(adaption.node_count()) &&
                      report.forecast_nodes > 2e4;
  const std::vector<Stage> all = stages<D>(params, coarse, static_cast<bool>(metric_at));
  int rounds = 0;
  for (const Stage& stage : all) rounds += stage.rounds;
  int past = 0;
  for (Stage stage : all) {
    adaption.wake_all();
    if (static_cast<double>(report.splits) < 0.1 * static_cast<double>(adaption.node_count()))
      polish<D>(stage);
    for (int i = 0; i < stage.rounds && !progress.cancelled(); ++i) {
      const double begin = static_cast<double>(past + i) / rounds;
      const std::size_t moves = report.moves;
      if (stage.sweep.attention < 1) {
        const int left = stage.rounds - i;
        const auto mended = adaption.mend(
            stage.sweep, left, progress.portion(begin, begin + 1.0 * left / rounds, "adapting"));
        if (mended) {
          report.settled = *mended == 0;
          break;
        }
        // Sizes that vary so much from node to node tell little of a single element.
        if (stage.sweep.strict && adaption.poor_share() > 0.01) break;
      }
      std::size_t done =
          adaption.round(stage.sweep, progress.portion(begin, begin + 1.0 / rounds, "adapting"));
      if (!stage.count_moves) done -= report.moves - moves;
      if (adaption.overfull())
        return over_budget<D>(report, *params.memory_limit, adaption.element_count());
      report.settled =
          static_cast<double>(done) < stage.settled * static_cast<double>(adaption.node_count());
      if (report.settled) break;
    }
    past += stage.rounds;
  }
  if (params.treat_blocking && !progress.cancelled()) adaption.open_blocking(progress);
  report.cancelled = progress.cancelled();
  if (report.cancelled) report.settled = false;
  progress.report(1);
  Adapted<D> out = adaption.result(mesh);
  if (given > outer) drop_false_interfaces(out.mesh);
  if (params.treat_blocking) out.report.blocking = blocking_faces(out.mesh).size();
  return out;
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
