#pragma once

#include <set>
#include <span>

#include "core/mesh/quality.h"
#include "core/multidomain/hold.h"
#include "core/multidomain/interface_cut.h"
#include "core/optimize/metric_carrier.h"
#include "core/optimize/topology.h"

namespace lamella {

/// The mesh while it is cut: nodes are moved and added, never removed. Virtual elements stand for
/// the boundary and for the interfaces of the zones that are done; nodes on them stay on them.
class CutTopology {
 public:
  using Element = std::array<NodeId, 4>;
  using Weights = std::array<double, 4>;  ///< barycentric

  CutTopology(const SimplexMesh<3>& mesh, const MetricField<3>& metric,
              const Partition<3>& partition, const CutParams& params,
              const MetricFunction<3>& metric_at);

  Topology<3> topo;
  std::vector<Packed<3>> metric;  ///< [node]
  std::vector<char> locked;       ///< [node] on a corner or feature edge
  std::set<std::array<NodeId, 2>> features;
  std::int32_t first_interface;  ///< label of the interface of zone 0; below: facets
  double on;                     ///< mm: what is this near to a border lies on it
  double exact;                  ///< mm: points this near are one
  double merge;                  ///< mm: features nearer to each other than this become one
  std::size_t moves = 0;

  std::int32_t count() const { return static_cast<std::int32_t>(topo.elements.size()); }
  bool is_wall(std::int32_t e) const { return topo.label[e] < first_interface; }
  /// Of the background still.
  bool active(std::int32_t e) const {
    return topo.alive(e) && !topo.is_virtual(e) && topo.label[e] == partition_.background();
  }
  const Vec<3>& at(NodeId n) const { return topo.points[n]; }
  Corners<3> corners(const Element& e) const { return {at(e[0]), at(e[1]), at(e[2]), at(e[3])}; }
  Weights weights_in(std::int32_t e, const Vec<3>& x) const;
  static std::array<NodeId, 2> key(NodeId a, NodeId b) { return {std::min(a, b), std::max(a, b)}; }

  /// The edges of the background that have a node from number `first` on, sorted.
  std::vector<std::array<NodeId, 2>> edges_from(std::size_t first) const;
  /// What holds all of the nodes: the virtual elements that contain them.
  Hold hold(std::span<const NodeId> nodes) const;
  /// Moves a node, unless that makes elements poor; whether it did.
  bool move(NodeId n, const Vec<3>& x);
  /// Puts a node at x, on or near the edge, face or inside of the element that the nodes make, into
  /// all elements that contain them. 0 when an element would be turned or flat.
  NodeId split_at(std::span<const NodeId> of, const Vec<3>& x, std::span<const double> weights);
  /// Brings a node to x, which lies in the element: one that is there, a near one that may move, or
  /// a new one, and locks it. `weights` that are zero are so on purpose. It may be what is locked
  /// already nearby, on the way from a node to `goal` if that is nearer to the goal. 0 when it
  /// cannot be done.
  NodeId bring_node(std::int32_t e, const Weights& weights, const Vec<3>& x, NodeId from = 0,
                    const Vec<3>& goal = Vec<3>::Zero());

 private:
  bool hold_allows(std::span<const NodeId> nodes, const Vec<3>& x) const {
    return hold(nodes).allows(partition_, x, on);
  }
  double quality_of(const Element& e, NodeId moved, const Vec<3>& x) const;
  NodeId add_node(const Vec<3>& x, std::span<const NodeId> of, std::span<const double> weights);
  NodeId lock(NodeId n) {
    locked[n] = 1;
    return n;
  }
  Vec<3> nearest_in(const Element& nodes, unsigned bits, const Weights& weights) const;

  const Partition<3>& partition_;
  const MetricFunction<3>& metric_at_;
  double snap_;
  MetricCarrier<3> carrier_{MetricMean::size};
  std::vector<std::int32_t> star_;
};

}  // namespace lamella
