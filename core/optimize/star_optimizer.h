#pragma once

#include <optional>

#include "core/base/progress.h"
#include "core/optimize/adapt.h"
#include "core/optimize/boundary_model.h"
#include "core/optimize/face_batch.h"
#include "core/optimize/metric_carrier.h"
#include "core/optimize/work_mesh.h"

namespace lamella {

/// c(T) below which a node may join any of its neighbors, and go anywhere.
inline constexpr double poor_quality = 0.3;

/// By what the star chooses among local topologies.
enum class Criterion {
  order,  ///< the lexicographic order (3.9) of sorted qualities
  energy  ///< the mean energy (cavity.h) of the elements: what is good on average
};

/// One pass over a block.
struct SweepParams {
  Criterion criterion = Criterion::order;
  double relaxation = 1;         ///< weight of the shape in the quality
  double size_weight = 0;        ///< in the energy; 0: the usual one
  double split_above = 1.41;     ///< metric length above which an edge may get a node
  double collapse_below = 0.71;  ///< metric length below which a node may join its neighbor
  double good_enough = 0.7;      ///< c(T) above which elements are not reconnected
  double temperature = 0;        ///< energy that a reconnection may cost, at random
  std::size_t most_elements = std::numeric_limits<std::size_t>::max();  ///< of a block
  bool moves_only = false;  ///< nodes move, nothing is reconnected
  bool strict = false;  ///< quality is taken in the densest metric of the nodes as well; M, L2 only
  double attention = 2;  ///< c(T) above which nodes are left alone altogether
};

/// The working state of algorithm 3.1 on one block of the mesh: cuts the cavity around a node or an
/// edge and reconnects its boundary to the best vertex.
template <int D>
class StarOptimizer {
 public:
  StarOptimizer(Block<D> block, const BoundaryModel<D>& model, const AdaptParams& params,
                const MetricFunction<D>& metric_at, double scale);

  /// One pass over the nodes and the edges they own whose surroundings changed since their last
  /// turn. Returns the number of operations; stops early when cancelled.
  std::size_t sweep(const SweepParams& params, const Progress& progress);
  /// Puts a node into every inner edge between two boundary nodes, then into every inner face whose
  /// nodes all lie on the boundary, wherever the elements stay well oriented (C.1.1). The block
  /// must be the whole mesh. Returns the number of new nodes.
  std::size_t open_blocking(const Progress& progress);
  /// Whether the sweep stopped because the block grew beyond its bound.
  bool overfull() const { return overfull_; }
  const AdaptReport& counts() const { return counts_; }
  /// The block as it is now, numbered without gaps.
  Block<D> take();

 private:
  using Element = std::array<NodeId, D + 1>;
  using Facet = std::array<NodeId, D>;

  struct Apex {
    NodeId node = 0;  ///< existing node, or 0 for a new or moved point
    Vec<D> point = Vec<D>::Zero();
    Packed<D> metric = Packed<D>::zero();
    Packed<D> averaged = Packed<D>::zero();  ///< what elements average of it
    bool asked = false;                      ///< the metric is what the function says there
  };
  struct RingNode {
    NodeId node;
    std::int32_t tags[2];
    int count;
  };
  /// What the boundary says of a cavity.
  struct BoundarySite {
    bool boundary = false, on_feature = false;
    Vec<D> anchor;  ///< the point that is removed
    /// Where a feature of the mesh ends that is none of the surface's to end there, or meets
    /// others beside their corner: the node may only join another.
    bool stray = false;
    const Vec<D>* second = nullptr;  ///< of an edge that is no feature: its other end
    std::array<NodeId, 4> ends{};    ///< the neighbors along features, then 0
    NodeId a = 0, b = 0;             ///< node or edge that is removed
  };

  void set_weights(double relaxation, double size_weight, bool strict);
  void open_pair(std::int32_t e, std::int32_t other, const Facet& face);
  bool process_node(NodeId s);
  bool process_edge(NodeId s, NodeId n, bool is_long);
  std::size_t improve_edges(NodeId s, std::uint32_t before);
  void list_edges(NodeId s, std::uint32_t before);
  bool movable(NodeId n) const { return !fixed_[n] && !locked(n); }
  bool locked(NodeId n) const { return shared_[n] != 0; }
  void open_cavity(std::span<const std::int32_t> elements, NodeId a, NodeId b);
  void offer(const Apex& apex, const BoundarySite& site) {
    if (beats(apex.node, apex.point, apex.averaged)) take_if_allowed(apex, site);
  }
  void offer(NodeId v, const BoundarySite& site) {
    if (beats(v, topo_.points[v], averaged()[v])) take_if_allowed(existing(v), site);
  }
  bool beats(NodeId node, const Vec<D>& point, const Packed<D>& averaged);
  void take_if_allowed(Apex apex, const BoundarySite& site);
  bool still_known(NodeId n, const Apex& apex) const;
  void start_from_current();
  Apex existing(NodeId v) const { return {v, topo_.points[v], metric_[v], averaged()[v], false}; }
  Apex new_point(const Vec<D>& x, const Packed<D>& metric) const;
  void replace_cavity(const Apex& apex, NodeId moved);
  const Packed<D>& carried(NodeId n) const;
  Packed<D> metric_in_star(NodeId s, const Vec<D>& x);
  /// Fourth power of the length of an edge in the metric, the geometric mean of what its ends say.
  double length4(NodeId a, NodeId b) const {
    const Vec<D> e = topo_.points[b] - topo_.points[a];
    return metric_[a].quad(e) * metric_[b].quad(e);
  }
  bool longest(NodeId s, NodeId n, double limit4) const;
  bool edges_matter(NodeId s) const;
  void rate_all(const Apex& apex);
  void grow_nodes();
  void release_if_unused(NodeId n);

  const std::vector<Packed<D>>& averaged() const { return plain_ ? metric_ : own_averaged_; }
  FaceBatch<D>::Nodes nodes() const { return {topo_.elements, topo_.points, averaged()}; }

  // In star_boundary.cpp.
  bool node_site(NodeId s, BoundarySite& site);
  bool edge_site(NodeId s, NodeId n, BoundarySite& site);
  bool boundary_allows(const Apex& apex, const BoundarySite& site);
  bool borders_allow(const Apex& apex, const BoundarySite& site) const;
  bool boundary_within(const Apex& apex, const BoundarySite& site, double limit,
                       double feature_limit);
  bool keeps_vertices(const Apex& apex, const BoundarySite& site);
  bool looks_away(const Nearest<D>& at, const Vec<D>& normal, std::int32_t t) const;
  double star_deviation(const BoundarySite& site) const;
  double feature_deviation(const BoundarySite& site) const;
  bool topology_allows(const Apex& apex, const BoundarySite& site) const;
  void collect_ring(NodeId s);
  bool takes_stray(NodeId v, const BoundarySite& site) const;
  std::optional<Vec<D>> point_on_boundary(const Vec<D>& x, bool on_feature, double reach) const;
  int free_directions(const BoundarySite& site, Mat<D>& basis) const;

  // In star_smooth.cpp.
  void offer_moves(NodeId s, const BoundarySite& site);
  std::optional<Vec<D>> newton_step(NodeId s, const BoundarySite& site);

  Topology<D> topo_;
  const BoundaryModel<D>& model_;
  MetricCarrier<D> carrier_, averager_;
  std::uint64_t seed_;
  const MetricFunction<D>& metric_function_;
  RatingKernel<D> kernel_;
  SweepParams sweep_;
  AdaptReport counts_;
  bool overfull_ = false;
  double flat_;                              ///< mm, below which a height counts as zero
  std::vector<Packed<D>> metric_;            ///< [node]
  mutable std::vector<Packed<D>> carried_;   ///< [node] what new nodes average of the metric
  mutable std::vector<char> carried_known_;  ///< [node]
  std::vector<Packed<D>> own_averaged_;  ///< [node] what elements average, if not the metric itself
  bool plain_;                           ///< elements average the metric itself
  std::vector<char> dirty_;              ///< [node] as it came
  std::vector<Vec<D>> asked_;            ///< [node] where the metric function was asked last
  std::vector<char> fixed_;              ///< [node]
  std::vector<NodeId> shared_;           ///< [node] global id of a locked node, else 0
  std::vector<Rating> rating_;           ///< [element] virtual: infinite quality, no energy
  std::vector<std::uint32_t> done_;      ///< [node] clock of its last turn

  // Scratch of the open cavity; kept to allocate nothing in the sweep.
  std::vector<std::int32_t> cavity_;
  FaceBatch<D> faces_;
  std::vector<CavityFace<D>> virtual_faces_;
  std::vector<NodeId> link_;
  std::vector<std::uint32_t> mark_;
  std::uint32_t mark_value_ = 0;
  SortedQualities best_, trial_;
  double best_worst_ = 0, trial_worst_ = 0;  ///< quality
  double best_cost_ = 0, trial_cost_ = 0;    ///< energy above that of a typical element
  double cavity_worst_ = 0;
  Apex best_apex_;
  bool found_ = false;
  std::uint64_t dice_ = 0;
  NodeId moving_ = 0;  ///< whose star is open; 0 for that of an edge
  struct Birth {
    Element nodes;
    std::int32_t label;
    Rating rating;
    std::int32_t element, place;  ///< of which it keeps all nodes but one
  };
  std::vector<Birth> births_;
  std::vector<Rating> rates_;  ///< [face], and some behind the last
  std::vector<RingNode> ring_;
  std::vector<std::int32_t> retag_;  ///< [virtual face] tag of the new facet
  std::vector<std::int32_t> best_retag_;
  std::vector<Vec<D>> vertices_;  ///< of the surface, near the star
  std::vector<std::array<Vec<D>, D>> new_facets_;
  std::vector<std::int32_t> star_;
  struct OwnedEdge {
    NodeId node;   ///< its other end
    double worst;  ///< quality of the elements around
    bool fresh;    ///< whether one of them is new
    void see(double quality, bool is_new) {
      worst = std::min(worst, quality);
      fresh = fresh || is_new;
    }
  };
  std::vector<OwnedEdge> owned_;
  std::vector<std::int32_t> place_;  ///< [node] in owned_, where marked
};

}  // namespace lamella
