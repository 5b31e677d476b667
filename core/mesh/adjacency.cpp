#include "core/mesh/adjacency.h"

#include <algorithm>
#include <atomic>
#include <new>

#include "core/base/parallel.h"

namespace lamella {
namespace {

/// Elements, or nodes, that a thread takes at once.
constexpr std::size_t range = 16384;
/// What FaceUse can number.
constexpr std::size_t most_elements = std::size_t{1} << 27;

/// What it was, before one of several threads added to it.
std::size_t fetch_add(std::size_t& counter, std::size_t more) {
  return std::atomic_ref(counter).fetch_add(more, std::memory_order_relaxed);
}

/// Calls visit(element, its number) for all, on all cores.
template <class Elements, class Visit>
void each_element(const Elements& elements, const Visit& visit) {
  parallel_ranges(elements.size(), range, 0, [&](std::size_t first, std::size_t last) {
    for (std::size_t e = first; e < last; ++e) visit(elements[e], e);
  });
}

/// Running sums: counts[i] becomes the start of bucket i, counts.back() the total.
void starts_from_counts(std::vector<std::size_t>& counts) {
  std::size_t sum = 0;
  for (std::size_t& c : counts) {
    const std::size_t n = c;
    c = sum;
    sum += n;
  }
}

/// Insertion sort; the lists have D entries. Returns whether the permutation was odd.
template <std::size_t N>
bool sort_parity(std::array<NodeId, N>& v) {
  bool odd = false;
  for (std::size_t i = 1; i < N; ++i)
    for (std::size_t j = i; j > 0 && v[j - 1] > v[j]; --j) {
      std::swap(v[j - 1], v[j]);
      odd = !odd;
    }
  return odd;
}

}  // namespace

template <int D>
std::vector<FaceUse<D>> face_uses(const std::vector<std::array<NodeId, D + 1>>& elements,
                                  std::size_t node_slots) {
  // The faces of so many take 8 GB: as if there was no memory for them.
  if (elements.size() >= most_elements) throw std::bad_array_new_length();
  // One bucket per smallest node: linear in the number of faces, and the buckets stay small.
  std::vector<std::size_t> start(node_slots + 1, 0);
  each_element(elements, [&](const auto& e, std::size_t) {
    // The faces opposite to the other vertices keep the smallest node; one face does not.
    auto s = e;
    std::sort(s.begin(), s.end());
    fetch_add(start[s[0]], D);
    fetch_add(start[s[1]], 1);
  });
  starts_from_counts(start);
  std::vector<FaceUse<D>> uses(elements.size() * (D + 1));
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  each_element(elements, [&](const auto& e, std::size_t i) {
    for (int k = 0; k <= D; ++k) {
      FaceUse<D> u;
      u.nodes = opposite_facet<D>(e, k);
      u.odd = sort_parity(u.nodes);
      u.element = static_cast<std::int32_t>(i);
      u.local = static_cast<std::uint32_t>(k) & 7;
      uses[fetch_add(next[u.nodes[0]], 1)] = u;
    }
  });
  // The threads fill a bucket in any order: all that tells two uses apart is compared.
  const auto before = [](const FaceUse<D>& a, const FaceUse<D>& b) {
    for (int k = 1; k < D; ++k)
      if (a.nodes[k] != b.nodes[k]) return a.nodes[k] < b.nodes[k];
    return a.element != b.element ? a.element < b.element : a.local < b.local;
  };
  parallel_ranges(node_slots, range, 0, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      std::sort(uses.begin() + start[n], uses.begin() + start[n + 1], before);
  });
  static_assert(sizeof(FaceUse<D>) == sizeof(NodeId) * (D + 1));
  return uses;
}

template <int D>
std::vector<std::array<NodeId, 2>> unique_edges(
    const std::vector<std::array<NodeId, D + 1>>& elements, std::size_t node_slots) {
  // [node] where its greater neighbors start, once for each element.
  std::vector<std::size_t> start(node_slots + 1, 0);
  each_element(elements, [&](const auto& e, std::size_t) {
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j) fetch_add(start[std::min(e[i], e[j])], 1);
  });
  starts_from_counts(start);
  std::vector<NodeId> other(start.back());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  each_element(elements, [&](const auto& e, std::size_t) {
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j)
        other[fetch_add(next[std::min(e[i], e[j])], 1)] = std::max(e[i], e[j]);
  });
  // [node] where its edges start.
  std::vector<std::size_t> edge_start(node_slots + 1, 0);
  parallel_ranges(node_slots, range, 0, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const auto from = other.begin() + start[n], to = other.begin() + start[n + 1];
      std::sort(from, to);
      edge_start[n] = static_cast<std::size_t>(std::unique(from, to) - from);
    }
  });
  starts_from_counts(edge_start);
  std::vector<std::array<NodeId, 2>> edges(edge_start.back());
  parallel_ranges(node_slots, range, 0, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      for (std::size_t k = 0; k < edge_start[n + 1] - edge_start[n]; ++k)
        edges[edge_start[n] + k] = {static_cast<NodeId>(n), other[start[n] + k]};
  });
  return edges;
}

template std::vector<FaceUse<2>> face_uses<2>(const std::vector<std::array<NodeId, 3>>&,
                                              std::size_t);
template std::vector<FaceUse<3>> face_uses<3>(const std::vector<std::array<NodeId, 4>>&,
                                              std::size_t);
template std::vector<FaceUse<4>> face_uses<4>(const std::vector<std::array<NodeId, 5>>&,
                                              std::size_t);
template std::vector<std::array<NodeId, 2>> unique_edges<2>(
    const std::vector<std::array<NodeId, 3>>&, std::size_t);
template std::vector<std::array<NodeId, 2>> unique_edges<3>(
    const std::vector<std::array<NodeId, 4>>&, std::size_t);
template std::vector<std::array<NodeId, 2>> unique_edges<4>(
    const std::vector<std::array<NodeId, 5>>&, std::size_t);

}  // namespace lamella
