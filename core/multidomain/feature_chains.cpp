#include "core/multidomain/feature_chains.h"

#include <algorithm>

#include "core/geometry/edge_table.h"
#include "core/geometry/foot.h"

namespace lamella {
namespace {

/// Keeps of chain[first, last] what is farther than the tolerance from the straight line
/// (Douglas and Peucker).
void thin(const std::vector<Vec<3>>& chain, std::size_t first, std::size_t last, double tolerance,
          std::vector<char>& keep) {
  keep[first] = keep[last] = 1;
  std::size_t worst = first;
  double most = tolerance * tolerance;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double off2 =
        (foot_on_segment<3>(chain[first], chain[last], chain[i]).point - chain[i]).squaredNorm();
    if (off2 > most) {
      most = off2;
      worst = i;
    }
  }
  if (worst == first) return;
  thin(chain, first, worst, tolerance, keep);
  thin(chain, worst, last, tolerance, keep);
}

}  // namespace

std::vector<std::vector<Vec<3>>> feature_chains(const ReferenceSurface<3>& surface,
                                                double tolerance) {
  struct End {
    std::int32_t vertex, other;
    std::size_t edge;
    bool operator<(const End& o) const {
      return vertex != o.vertex ? vertex < o.vertex : edge < o.edge;
    }
  };
  std::vector<End> ends;
  for (std::size_t e = 0; e < surface.feature_edges.size(); ++e) {
    const auto [a, b] = surface.feature_edges[e];
    ends.push_back({a, b, e});
    ends.push_back({b, a, e});
  }
  std::sort(ends.begin(), ends.end());
  const auto around = [&](std::int32_t v) {
    return std::equal_range(ends.begin(), ends.end(), End{v, 0, 0},
                            [](const End& a, const End& b) { return a.vertex < b.vertex; });
  };
  std::vector<char> stop(surface.points.size(), 0), used(surface.feature_edges.size(), 0);
  for (auto c : surface.corners) stop[c] = 1;
  for (const auto& e : surface.feature_edges)
    for (auto v : e) {
      const auto [first, last] = around(v);
      if (last - first != 2) stop[v] = 1;
    }
  std::vector<std::vector<Vec<3>>> chains;
  const auto follow = [&](End from) {
    std::vector<Vec<3>> chain{surface.points[from.vertex]};
    const std::int32_t begin = from.vertex;
    while (true) {
      used[from.edge] = 1;
      chain.push_back(surface.points[from.other]);
      if (stop[from.other] || from.other == begin) break;
      const auto [first, last] = around(from.other);
      from = first->edge == from.edge ? *(last - 1) : *first;
    }
    std::vector<char> keep(chain.size(), 0);
    std::size_t middle = chain.size() - 1;
    if (from.other == begin) {
      // Around: thinned from the point farthest from the start.
      for (std::size_t i = 0; i < chain.size(); ++i)
        if ((chain[i] - chain[0]).squaredNorm() > (chain[middle] - chain[0]).squaredNorm())
          middle = i;
      thin(chain, middle, chain.size() - 1, tolerance, keep);
    }
    thin(chain, 0, middle, tolerance, keep);
    std::vector<Vec<3>> kept;
    for (std::size_t i = 0; i < chain.size(); ++i)
      if (keep[i]) kept.push_back(chain[i]);
    chains.push_back(std::move(kept));
  };
  for (const bool anywhere : {false, true})
    for (const End& e : ends)
      if (!used[e.edge] && (anywhere || stop[e.vertex])) follow(e);
  return chains;
}

ReferenceSurface<3> with_creases(ReferenceSurface<3> surface, double tolerance) {
  std::vector<std::array<std::int32_t, 2>> known;
  for (const auto& [a, b] : surface.feature_edges)
    known.push_back({std::min(a, b), std::max(a, b)});
  std::sort(known.begin(), known.end());
  const auto normal = [&](std::int32_t f) {
    const auto& v = surface.facets[f];
    return facet_normal<3>({surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]});
  };
  for_each_edge(edge_uses(surface.facets), [&](std::span<const EdgeUse> uses) {
    if (uses.size() != 2 ||
        std::binary_search(known.begin(), known.end(), std::array{uses[0].a, uses[0].b}))
      return;
    const Vec<3> m = normal(uses[0].facet), n = normal(uses[1].facet);
    const double length = (surface.points[uses[0].b] - surface.points[uses[0].a]).norm();
    const double one = m.norm() / length, two = n.norm() / length;  // heights over the edge
    if (!(one > 0 && two > 0)) return;
    const double angle = std::atan2(m.cross(n).norm(), m.dot(n));
    if (angle * one * two / (one + two) > tolerance)
      surface.feature_edges.push_back({uses[0].a, uses[0].b});
  });
  return surface;
}

}  // namespace lamella
