#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// One side of an edge a < b: the facet it belongs to, and whether that facet runs from a to b.
struct EdgeUse {
  std::int32_t a = 0;
  std::int32_t b = 0;
  std::int32_t facet = 0;
  bool forward = true;

  bool same_edge(const EdgeUse& o) const { return a == o.a && b == o.b; }
};

/// All edge uses of a triangle set, sorted by (a, b, facet): the uses of one edge are neighbors.
inline std::vector<EdgeUse> edge_uses(const std::vector<std::array<std::int32_t, 3>>& facets) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * facets.size());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const std::int32_t i = facets[f][k];
      const std::int32_t j = facets[f][(k + 1) % 3];
      uses.push_back({std::min(i, j), std::max(i, j), static_cast<std::int32_t>(f), i < j});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& x, const EdgeUse& y) {
    if (x.a != y.a) return x.a < y.a;
    return x.b != y.b ? x.b < y.b : x.facet < y.facet;
  });
  return uses;
}

/// Calls visit(std::span<const EdgeUse>) once an edge.
template <class Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, Visit&& visit) {
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t j = i + 1;
    while (j < uses.size() && uses[j].same_edge(uses[i])) ++j;
    visit(std::span<const EdgeUse>(uses.data() + i, j - i));
    i = j;
  }
}

/// Whether `uses`, sorted as by edge_uses, has the edge between i and j.
inline bool has_edge(const std::vector<EdgeUse>& uses, std::int32_t i, std::int32_t j) {
  const EdgeUse edge{std::min(i, j), std::max(i, j), 0, true};
  const auto it = std::lower_bound(
      uses.begin(), uses.end(), edge,
      [](const EdgeUse& x, const EdgeUse& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  return it != uses.end() && it->same_edge(edge);
}

}  // namespace lamella
