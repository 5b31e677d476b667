#pragma once

#include <optional>

#include "core/base/progress.h"
#include "core/optimize/adapt.h"
#include "core/optimize/boundary_model.h"
#include "core/optimize/cavity.h"
#include "core/optimize/metric_carrier.h"

namespace lamella {

/// The working state of algorithm 3.1: cuts the cavity around a node or an edge and reconnects its
/// boundary to the best vertex, in the order (3.9) of sorted qualities.
template <int D>
class StarOptimizer {
 public:
  StarOptimizer(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                const ReferenceSurface<D>* surface, const AdaptParams& params,
                const MetricFunction<D>& metric_at, double tolerance);

  /// One pass over the nodes and the edges they own whose surroundings changed since their last
  /// turn. Returns the number of operations; stops early when cancelled.
  std::size_t sweep(const Progress& progress);
  /// Shape weight of the quality; changing it forgets what has been processed.
  void set_relaxation(double beta);
  std::size_t node_count() const;
  Adapted<D> result(const SimplexMesh<D>& original) const;

 private:
  using Element = std::array<NodeId, D + 1>;
  using Facet = std::array<NodeId, D>;

  struct Apex {
    NodeId node = 0;  ///< existing node, or 0 for a new or moved point
    Vec<D> point = Vec<D>::Zero();
    Packed<D> metric = Packed<D>::zero();
  };
  struct RingNode {
    NodeId node;
    std::int32_t tags[2];
    int count;
  };

  bool process_node(NodeId s);
  bool process_edge(NodeId s, NodeId n);
  void open_cavity(std::span<const std::int32_t> elements, NodeId a, NodeId b);
  bool mixed_bodies() const { return mixed_bodies_; }
  /// Evaluates the star of `apex`; true, with its qualities in trial_, when it beats best_.
  bool beats(const Apex& apex);
  void start_from_current();
  void accept_trial(const Apex& apex) {
    std::swap(best_, trial_);
    best_apex_ = apex;
  }
  void replace_cavity(const Apex& apex, NodeId moved);
  bool boundary_allows(const Apex& apex, const Vec<D>& anchor, const Vec<D>* flat_anchor,
                       std::span<const NodeId> feature_ends);
  bool follows_surface(const std::array<Vec<D>, D>& p, const Facet& nodes, NodeId replaced) const;
  bool topology_allows(const Apex& apex, NodeId a, NodeId b) const;
  void collect_ring(NodeId s);
  std::optional<Apex> point_on_boundary(const Vec<D>& x, bool on_feature, double reach) const;
  Packed<D> metric_in_star(NodeId s, const Vec<D>& x) const;
  double quality_of(std::int32_t e) const;
  void release_if_unused(NodeId n);

  Topology<D> topo_;
  BoundaryModel<D> model_;
  MetricCarrier<D> carrier_;
  std::uint64_t seed_;
  MetricFunction<D> metric_function_;
  QualityKernel<D> kernel_;
  double flat_;                      ///< mm, below which a height counts as zero
  std::vector<Packed<D>> metric_;    ///< [node]
  std::vector<Packed<D>> carried_;   ///< [node]
  std::vector<Vec<D>> asked_;        ///< [node] where the metric function was asked last
  std::vector<double> quality_;      ///< [element] c^2; virtual: infinity
  std::vector<std::uint32_t> done_;  ///< [node] clock of its last turn

  // Scratch of the open cavity; kept to allocate nothing in the sweep.
  std::vector<std::int32_t> cavity_;
  std::vector<RealFace<D>> faces_;
  std::vector<CavityFace<D>> virtual_faces_;
  std::vector<NodeId> link_;
  std::vector<std::uint32_t> mark_;
  std::uint32_t mark_value_ = 0;
  std::vector<double> best_, trial_;
  double best_worst_ = 0;
  Apex best_apex_;
  bool mixed_bodies_ = false;
  std::vector<RingNode> ring_;
  std::vector<std::int32_t> retag_;  ///< [virtual face] tag of the new facet
  std::vector<std::int32_t> best_retag_;
  std::vector<std::int32_t> star_;
  std::vector<NodeId> owned_;
};

}  // namespace lamella
