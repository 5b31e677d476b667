#pragma once

#include <algorithm>
#include <bit>
#include <span>

#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// Lists of elements around nodes in one pool: no allocation while elements come and go, removal by
/// swapping with the last.
class NodeElements {
 public:
  void resize(std::size_t nodes) {
    if (nodes > begin_.size()) {
      begin_.resize(nodes, -1);
      size_.resize(nodes, 0);
      capacity_.resize(nodes, 0);
    }
  }
  std::span<const std::int32_t> of(NodeId n) const {
    return {pool_.data() + std::max(begin_[n], 0), static_cast<std::size_t>(size_[n])};
  }
  bool empty(NodeId n) const { return size_[n] == 0; }

  /// The lists of all elements at once.
  template <class Element>
  void fill(std::size_t nodes, const std::vector<Element>& elements) {
    begin_.assign(nodes, -1);
    size_.assign(nodes, 0);
    capacity_.assign(nodes, 0);
    for (const Element& e : elements)
      for (NodeId n : e) ++size_[n];
    std::int32_t place = 0;
    for (std::size_t n = 1; n < nodes; ++n) {
      if (size_[n] == 0) continue;
      capacity_[n] = static_cast<std::int32_t>(std::bit_ceil(static_cast<unsigned>(size_[n])));
      capacity_[n] = std::max(capacity_[n], 16);
      begin_[n] = place;
      place += capacity_[n];
      size_[n] = 0;
    }
    size_[0] = 0;
    pool_.resize(place);
    for (std::size_t e = 0; e < elements.size(); ++e)
      for (NodeId n : elements[e])
        if (n != 0) pool_[begin_[n] + size_[n]++] = static_cast<std::int32_t>(e);
  }

  void add(NodeId n, std::int32_t element) {
    if (size_[n] == capacity_[n]) grow(n);
    pool_[begin_[n] + size_[n]++] = element;
  }
  void remove(NodeId n, std::int32_t element) {
    std::int32_t* list = pool_.data() + begin_[n];
    std::int32_t i = 0;
    while (list[i] != element) ++i;
    list[i] = list[--size_[n]];
  }

 private:
  void grow(NodeId n) {
    const std::int32_t old = capacity_[n];
    const std::int32_t wanted = old == 0 ? 16 : 2 * old;
    auto& blocks = free_[std::countr_zero(static_cast<unsigned>(wanted))];
    std::int32_t place;
    if (!blocks.empty()) {
      place = blocks.back();
      blocks.pop_back();
    } else {
      place = static_cast<std::int32_t>(pool_.size());
      pool_.resize(pool_.size() + wanted);
    }
    if (old > 0) {
      std::copy_n(pool_.begin() + begin_[n], size_[n], pool_.begin() + place);
      free_[std::countr_zero(static_cast<unsigned>(old))].push_back(begin_[n]);
    }
    begin_[n] = place;
    capacity_[n] = wanted;
  }

  std::vector<std::int32_t> begin_, size_, capacity_, pool_;
  std::array<std::vector<std::int32_t>, 32> free_;
};

/// A mesh being worked on: real and virtual elements in one array, so that boundary and interior go
/// through the same code (section 2.2.2.3).
///
/// A virtual element has node 0 at place 0 and the facet's nodes after it, in an order that makes
/// it well oriented as if node 0 lay outside: every face is then seen with opposite windings by its
/// two elements, virtual or not. `label` is the body of a real element and the boundary tag of a
/// virtual one.
template <int D>
struct Topology {
  using Element = std::array<NodeId, D + 1>;
  using Facet = std::array<NodeId, D>;

  std::vector<Vec<D>> points;
  std::vector<Element> elements;     ///< dead ones have elements[e][1] == 0
  std::vector<std::int32_t> label;   ///< [element]
  std::vector<std::uint32_t> birth;  ///< [element] clock at creation, or when a node moved far
  std::vector<std::uint32_t> touch;  ///< [element] clock when it was born or a node moved
  std::vector<std::int32_t> free_elements;
  std::vector<NodeId> free_nodes;
  NodeElements around;  ///< no list for node 0
  std::uint32_t clock = 1;

  static Topology from(std::vector<Vec<D>> points, std::vector<Element> elements,
                       std::vector<std::int32_t> label) {
    Topology t;
    t.points = std::move(points);
    t.elements = std::move(elements);
    t.label = std::move(label);
    t.birth.assign(t.elements.size(), t.clock);
    t.touch = t.birth;
    t.around.fill(t.points.size(), t.elements);
    return t;
  }

  /// The element made of node 0 and a facet with outward normal: well oriented when 0 is outside.
  static Element virtual_element(const Facet& f) {
    Element e;
    e[0] = 0;
    for (int k = 0; k < D; ++k) e[k + 1] = f[k];
    // det(f, 0) > 0 for 0 outside; moving the apex from the last to the first place is D swaps.
    if constexpr (D % 2 == 1) std::swap(e[1], e[2]);
    return e;
  }
  static Facet facet_of(const Element& e) {
    Facet f;
    for (int k = 0; k < D; ++k) f[k] = e[k + 1];
    if constexpr (D % 2 == 1) std::swap(f[0], f[1]);
    return f;
  }

  bool alive(std::int32_t e) const { return elements[e][1] != 0; }
  bool is_virtual(std::int32_t e) const { return elements[e][0] == 0; }

  std::int32_t add(const Element& nodes, std::int32_t element_label) {
    std::int32_t e;
    if (!free_elements.empty()) {
      e = free_elements.back();
      free_elements.pop_back();
      elements[e] = nodes;
      label[e] = element_label;
      birth[e] = touch[e] = clock;
    } else {
      e = static_cast<std::int32_t>(elements.size());
      elements.push_back(nodes);
      label.push_back(element_label);
      birth.push_back(clock);
      touch.push_back(clock);
    }
    for (NodeId n : nodes)
      if (n != 0) around.add(n, e);
    return e;
  }
  void remove(std::int32_t e) {
    for (NodeId n : elements[e])
      if (n != 0) around.remove(n, e);
    elements[e].fill(0);
    free_elements.push_back(e);
  }
  void replace_node(std::int32_t e, int place, NodeId with) {
    around.remove(elements[e][place], e);
    elements[e][place] = with;
    around.add(with, e);
  }
  NodeId add_node(const Vec<D>& x) {
    if (!free_nodes.empty()) {
      const NodeId n = free_nodes.back();
      free_nodes.pop_back();
      points[n] = x;
      return n;
    }
    points.push_back(x);
    around.resize(points.size());
    return static_cast<NodeId>(points.size() - 1);
  }

  static bool has(const Element& e, NodeId n) {
    for (NodeId m : e)
      if (m == n) return true;
    return false;
  }
};

}  // namespace lamella
