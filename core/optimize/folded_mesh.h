#pragma once

#include <algorithm>

#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// The mesh topology (definition 2.2) under algorithm 2.1: simplices that all carry the orientation
/// of the boundary, whether or not their vertices lie so. Their signed volumes always add up to the
/// domain's, so the volume is minimal (2.20) when none is negative.
///
/// The boundary faces are locked in this phase: the virtual elements, which stand for them, would
/// never enter a cavity, so they are not stored and node 0 has no element.
template <int D>
class FoldedMesh {
 public:
  using Element = std::array<NodeId, D + 1>;
  using Facet = std::array<NodeId, D>;

  /// Points of the surface become nodes 1..n, without elements.
  explicit FoldedMesh(const ReferenceSurface<D>& surface)
      : surface_nodes_(static_cast<NodeId>(surface.points.size())) {
    points_.push_back(Vec<D>::Zero());
    points_.insert(points_.end(), surface.points.begin(), surface.points.end());
    around_.resize(points_.size());
  }

  const Vec<D>& point(NodeId n) const { return points_[n]; }
  NodeId node_end() const { return static_cast<NodeId>(points_.size()); }
  bool on_surface(NodeId n) const { return n <= surface_nodes_; }
  /// Elements of a node, in no order that means anything.
  const std::vector<int>& around(NodeId n) const { return around_[n]; }
  int degree(NodeId n) const { return static_cast<int>(around_[n].size()); }
  /// Slots of elements; some may be empty.
  int element_end() const { return static_cast<int>(elements_.size()); }
  bool alive(int e) const { return elements_[e][0] != 0; }
  const Element& element(int e) const { return elements_[e]; }
  /// Not certainly well oriented: inverted, or flat within rounding.
  bool bad(int e) const { return bad_[e] != 0; }
  int bad_count() const { return bad_count_; }
  int element_count() const { return element_end() - static_cast<int>(free_elements_.size()); }

  NodeId add_node(const Vec<D>& x) {
    if (!free_nodes_.empty()) {
      const NodeId n = free_nodes_.back();
      free_nodes_.pop_back();
      points_[n] = x;
      return n;
    }
    points_.push_back(x);
    around_.emplace_back();
    return node_end() - 1;
  }
  /// Gives back an inner node that has no element left.
  void drop_node_if_unused(NodeId n) {
    if (!on_surface(n) && around_[n].empty()) free_nodes_.push_back(n);
  }

  void add_element(const Element& e, bool is_bad) {
    int id;
    if (free_elements_.empty()) {
      id = element_end();
      elements_.push_back(e);
      slots_.emplace_back();
      bad_.push_back(is_bad);
    } else {
      id = free_elements_.back();
      free_elements_.pop_back();
      elements_[id] = e;
      bad_[id] = is_bad;
    }
    bad_count_ += is_bad;
    for (int k = 0; k <= D; ++k) {
      slots_[id][k] = degree(e[k]);
      around_[e[k]].push_back(id);
    }
  }
  void remove_element(int id) {
    for (int k = 0; k <= D; ++k) {
      auto& list = around_[elements_[id][k]];
      const int last = list.back();
      list[slots_[id][k]] = last;
      list.pop_back();
      if (last == id) continue;
      const auto& moved = elements_[last];
      for (int j = 0; j <= D; ++j)
        if (moved[j] == elements_[id][k]) slots_[last][j] = slots_[id][k];
    }
    bad_count_ -= bad_[id];
    elements_[id][0] = 0;
    bad_[id] = 0;
    free_elements_.push_back(id);
  }

 private:
  NodeId surface_nodes_;
  std::vector<Vec<D>> points_;
  std::vector<std::vector<int>> around_;
  std::vector<Element> elements_;
  std::vector<std::array<int, D + 1>> slots_;  // position of the element in its nodes' lists
  std::vector<char> bad_;
  std::vector<int> free_elements_;
  std::vector<NodeId> free_nodes_;
  int bad_count_ = 0;
};

}  // namespace lamella
