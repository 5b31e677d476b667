#include "core/mesh/adjacency.h"

#include <algorithm>

namespace lamella {
namespace {

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
  // One bucket per smallest node: linear in the number of faces, and the buckets stay small.
  std::vector<std::size_t> start(node_slots + 1, 0);
  for (const auto& e : elements) {
    // The faces opposite to the other vertices keep the smallest node; one face does not.
    auto s = e;
    std::sort(s.begin(), s.end());
    start[s[0]] += D;
    start[s[1]] += 1;
  }
  starts_from_counts(start);
  std::vector<FaceUse<D>> uses(elements.size() * (D + 1));
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for (std::size_t i = 0; i < elements.size(); ++i)
    for (int k = 0; k <= D; ++k) {
      FaceUse<D> u;
      u.nodes = opposite_facet<D>(elements[i], k);
      u.odd = sort_parity(u.nodes);
      u.element = static_cast<std::int32_t>(i);
      u.local = static_cast<std::int8_t>(k);
      uses[next[u.nodes[0]]++] = u;
    }
  for (std::size_t n = 0; n < node_slots; ++n)
    std::sort(uses.begin() + start[n], uses.begin() + start[n + 1],
              [](const FaceUse<D>& a, const FaceUse<D>& b) {
                if (a.nodes != b.nodes) return a.nodes < b.nodes;
                return a.element != b.element ? a.element < b.element : a.local < b.local;
              });
  return uses;
}

template <int D>
std::vector<std::array<NodeId, 2>> unique_edges(
    const std::vector<std::array<NodeId, D + 1>>& elements, std::size_t node_slots) {
  std::vector<std::size_t> start(node_slots + 1, 0);
  for (const auto& e : elements)
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j) ++start[std::min(e[i], e[j])];
  starts_from_counts(start);
  std::vector<NodeId> other(start.back());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for (const auto& e : elements)
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j) other[next[std::min(e[i], e[j])]++] = std::max(e[i], e[j]);
  std::vector<std::array<NodeId, 2>> edges;
  for (std::size_t n = 0; n < node_slots; ++n) {
    const auto first = other.begin() + start[n], last = other.begin() + start[n + 1];
    std::sort(first, last);
    for (auto it = first; it != last; ++it)
      if (it == first || *it != *(it - 1)) edges.push_back({static_cast<NodeId>(n), *it});
  }
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
