#pragma once

#include "core/optimize/folded_mesh.h"
#include "core/optimize/generate_bridge.h"

namespace lamella {

/// The one operator of algorithm 2.1: cuts a cavity out of a topology and stars its boundary from
/// the best candidate, the smallest volume first and the order (2.23) of the shapes next.
/// Holds scratch memory; one at work at a time on a topology.
template <int D>
class StarOperator {
 public:
  explicit StarOperator(FoldedMesh<D>& mesh) : t_(mesh) {}

  /// Cavities of a node or an edge larger than this are left alone: there, every node of the
  /// boundary is a candidate.
  static constexpr int kLargestCavity = 600;

  /// Stars the whole boundary from `apex`: the very first topology. Apex 0 is a new node in the
  /// middle, which no facet is coplanar with by accident.
  void start(const Bridged<D>& boundary, NodeId apex);

  /// The cavity of all elements whose vertices lie in {s} and its neighbors. True if it changed.
  bool improve_node(NodeId s);
  /// The cavity of all elements whose vertices lie in {a, b} and their common neighbors.
  bool improve_edge(NodeId a, NodeId b);
  /// The cavity grown from an element, across every face that does not see `apex` on its inner
  /// side, and starred from there. Fails beyond `limit` elements, or when a locked face does not
  /// see the apex; unless `strict`, such a face is put up with. True if it changed.
  bool improve_seen_from(int seed, NodeId apex, int limit, bool strict);
  /// Cuts the given elements and stars the hole from the best node of its boundary, even if that is
  /// worse than what was there. False when no star is legal.
  bool restar(const std::vector<int>& elements);

  /// Volume of the inverted elements; twice this is what (2.20) exceeds the domain by. Also the
  /// middle of the worst one.
  double inverted_volume(Vec<D>* where = nullptr) const;
  /// Neighbors of a node; valid until the next call.
  const std::vector<NodeId>& neighbors(NodeId n);

 private:
  struct Face {
    std::array<NodeId, D> nodes;  // wound outward of the cavity
    Vec<D> normal, base;          // volume of an apex: normal . (base - apex)
    double scale;                 // product of edge lengths, for the rounding bound
    double edges;                 // sum of squared edge lengths
  };
  /// What a star, or what is there now, is worth.
  struct Worth {
    double inverted = 0;         // volume below zero
    std::vector<double> shapes;  // ascending; negative when inverted, 0 when flat
  };

  bool improve(NodeId only);
  bool take_best(NodeId id, const Vec<D>& apex, double limit);
  bool cut_vertex_set(const std::vector<NodeId>& seeds);
  bool take_boundary();
  void weigh_present();
  bool weigh(const Vec<D>& apex, NodeId id, double inverted_limit, Worth& out) const;
  bool better(const Worth& a, const Worth& b) const;
  bool legal(NodeId apex);
  bool exists_outside(NodeId apex, const std::array<NodeId, D - 1>& edge) const;
  void take_inner();
  Vec<D> kernel_point(const Vec<D>& from) const;
  void apply(NodeId apex);
  /// The other element of a face; -1 on the boundary.
  int across(int e, const std::array<NodeId, D>& face) const;
  double volume(const Face& f, const Vec<D>& apex, bool& flat) const {
    const Vec<D> w = f.base - apex;
    const double v = f.normal.dot(w);
    flat = std::abs(v) <= 1e-14 * f.scale * w.norm();
    return v;
  }
  Face make_face(const std::array<NodeId, D>& nodes) const;
  double shape(const Face& f, double v, const Vec<D>& apex) const;

  /// Starts a fresh set of marked nodes (elements).
  void clear_nodes() {
    node_mark_.resize(t_.node_end(), 0);
    ++node_stamp_;
  }
  void clear_elements() {
    element_mark_.resize(t_.element_end(), 0);
    ++element_stamp_;
  }
  bool mark_node(NodeId n) {
    if (node_mark_[n] == node_stamp_) return false;
    node_mark_[n] = node_stamp_;
    return true;
  }
  bool node_marked(NodeId n) const { return node_mark_[n] == node_stamp_; }
  bool in_cavity(int e) const { return element_mark_[e] == element_stamp_; }

  FoldedMesh<D>& t_;
  std::vector<int> cavity_;
  std::vector<Face> faces_;
  std::vector<NodeId> rim_, neighbors_, inner_;
  double tolerance_ = 0;  // of volumes, from the cavity's size
  Worth present_, best_, trial_;
  std::vector<unsigned> node_mark_, element_mark_;
  unsigned node_stamp_ = 0, element_stamp_ = 0;
  // Open hash tables for faces (D nodes) and their edges (D - 1 nodes), cleared by stamps.
  struct FaceSlot {
    std::array<NodeId, D> key;
    unsigned stamp = 0;
    int face = -1;  // element * (D + 1) + k, or -1 once seen twice
  };
  struct EdgeSlot {
    std::array<NodeId, D - 1> key;
    unsigned stamp = 0;
    int free = 0, held = 0;  // faces without and with the apex
    bool checked = false;
  };
  std::vector<FaceSlot> face_table_;
  std::vector<EdgeSlot> edge_table_;
  unsigned table_stamp_ = 0;
};

}  // namespace lamella
