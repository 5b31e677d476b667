#include "core/geometry/improve_triangles.h"

#include <algorithm>
#include <optional>
#include <unordered_map>

#include "core/geometry/edge_table.h"

namespace lamella {
namespace {

using Index = std::int32_t;

class Improver {
 public:
  Improver(ReferenceSurface<3>& surface, const ImproveParams& params, const Progress& progress)
      : s_(surface), params_(params), progress_(progress) {
    for_each_edge(edge_uses(s_.facets), [&](std::span<const EdgeUse> uses) {
      if (uses.size() == 2) edges_[key(uses[0].a, uses[0].b)] = {uses[0].facet, uses[1].facet};
    });
    for (const auto& e : s_.feature_edges) {
      const auto it = edges_.find(key(e[0], e[1]));
      if (it != edges_.end()) it->second.feature = true;
    }
    const auto n = static_cast<double>(s_.facets.size());
    limit_ = static_cast<std::size_t>(std::min(params.growth * n, n + params.added)) + 2000;
  }

  void run() {
    constexpr int kRounds = 60;
    std::size_t step = 0;
    for (int round = 0; round < kRounds; ++round) {
      std::vector<std::pair<double, Index>> needles;
      for (Index f = 0; f < static_cast<Index>(s_.facets.size()); ++f) {
        if (aspect(f) > params_.max_aspect) needles.emplace_back(-longest(f).length, f);
      }
      std::sort(needles.begin(), needles.end());
      bool changed = false;
      for (const auto& [length, f] : needles) {
        if (step++ % 1024 == 0 && progress_.cancelled()) break;
        if (aspect(f) > params_.max_aspect) changed = treat(f) || changed;
      }
      if (!changed || progress_.cancelled()) break;
    }
    s_.feature_edges.clear();
    for (const auto& [k, edge] : edges_) {
      if (edge.feature) {
        s_.feature_edges.push_back({static_cast<Index>(k >> 32), static_cast<Index>(k)});
      }
    }
    std::sort(s_.feature_edges.begin(), s_.feature_edges.end());
  }

 private:
  struct Edge {
    Index f = -1, g = -1;
    bool feature = false;
  };
  struct Longest {
    Index a, b, apex;  // the facet runs a, b, apex
    double length;
  };

  static std::uint64_t key(Index a, Index b) {
    const auto low = static_cast<std::uint32_t>(std::min(a, b));
    const auto high = static_cast<std::uint32_t>(std::max(a, b));
    return static_cast<std::uint64_t>(low) << 32 | high;
  }
  const Vec<3>& at(Index v) const { return s_.points[v]; }
  Vec<3> cross(Index a, Index b, Index c) const { return (at(b) - at(a)).cross(at(c) - at(a)); }
  Longest longest(Index f) const {
    Longest best{0, 0, 0, -1};
    for (int k = 0; k < 3; ++k) {
      const auto& v = s_.facets[f];
      const double length = (at(v[k]) - at(v[(k + 1) % 3])).norm();
      if (length > best.length) best = {v[k], v[(k + 1) % 3], v[(k + 2) % 3], length};
    }
    return best;
  }
  double aspect(Index f) const {
    const auto& v = s_.facets[f];
    const double l = longest(f).length;
    return l * l / std::max(cross(v[0], v[1], v[2]).norm(), 1e-300);
  }
  /// 1 for an equilateral triangle, 0 for a flat one.
  double shape(Index a, Index b, Index c) const {
    const double sum = (at(a) - at(b)).squaredNorm() + (at(b) - at(c)).squaredNorm() +
                       (at(c) - at(a)).squaredNorm();
    return 2 * std::sqrt(3.0) * cross(a, b, c).norm() / sum;
  }
  Index apex(Index f, Index a, Index b) const {
    for (const Index v : s_.facets[f]) {
      if (v != a && v != b) return v;
    }
    return -1;
  }
  static void replace(Edge& edge, Index from, Index to) { (edge.f == from ? edge.f : edge.g) = to; }
  bool bounds_a_face(const Edge& e) const {
    return e.feature || s_.facet_face[e.f] != s_.facet_face[e.g];
  }

  /// Replaces the facets (a, b, c) = f and (b, a, d) = g by (a, d, c) and (d, b, c).
  void turn_edge(Index f, Index g, Index a, Index b, Index c, Index d) {
    edges_.erase(key(a, b));
    s_.facets[f] = {a, d, c};
    s_.facets[g] = {d, b, c};
    replace(edges_[key(b, c)], f, g);
    replace(edges_[key(a, d)], g, f);
    edges_[key(c, d)] = {f, g, false};
  }

  /// Flips the edge ab when that is allowed and makes the worse of the two triangles better.
  bool flip(Index a, Index b) {
    const auto found = edges_.find(key(a, b));
    if (found == edges_.end() || bounds_a_face(found->second)) return false;
    Index f = found->second.f;
    Index g = found->second.g;
    if (!runs(f, a, b)) std::swap(f, g);
    const Index c = apex(f, a, b);
    const Index d = apex(g, a, b);
    if (c == d || edges_.count(key(c, d)) > 0) return false;
    const double before = std::min(shape(a, b, c), shape(b, a, d));
    if (std::min(shape(a, d, c), shape(d, b, c)) <= before * (1 + 1e-9)) return false;
    const Vec<3> up = cross(a, b, c) + cross(b, a, d);
    const Vec<3> n1 = cross(a, d, c);
    const Vec<3> n2 = cross(d, b, c);
    if (n1.dot(up) <= 0.5 * n1.norm() * up.norm() || n2.dot(up) <= 0.5 * n2.norm() * up.norm()) {
      return false;
    }
    // The surface moves by the distance between the old edge and the new one.
    const Vec<3> across = (at(b) - at(a)).cross(at(d) - at(c));
    const double moved = std::abs((at(c) - at(a)).dot(across));
    if (moved > params_.tolerance * across.norm()) return false;
    turn_edge(f, g, a, b, c, d);
    return true;
  }

  bool runs(Index f, Index a, Index b) const {
    const auto& v = s_.facets[f];
    return (v[0] == a && v[1] == b) || (v[1] == a && v[2] == b) || (v[2] == a && v[0] == b);
  }

  /// A sliver flatter than the tolerance along the border of its face goes to the neighbor: the
  /// border moves from its long edge to its two short ones.
  bool absorb(Index f, const Longest& edge, double height) {
    if (height > params_.tolerance) return false;
    const Edge border = edges_.at(key(edge.a, edge.b));
    const Index g = border.f == f ? border.g : border.f;
    const Index a = edge.a, b = edge.b, c = edge.apex;
    const Index d = apex(g, a, b);
    if (c == d || edges_.count(key(c, d)) > 0) return false;
    const double along = (at(c) - at(a)).dot(at(b) - at(a)) / (edge.length * edge.length);
    if (along <= 0 || along >= 1) return false;
    const Vec<3> up = cross(b, a, d);
    const Vec<3> n1 = cross(a, d, c);
    const Vec<3> n2 = cross(d, b, c);
    if (n1.dot(up) <= 0.5 * n1.norm() * up.norm() || n2.dot(up) <= 0.5 * n2.norm() * up.norm()) {
      return false;
    }
    turn_edge(f, g, a, b, c, d);
    s_.facet_face[f] = s_.facet_face[g];
    if (border.feature) {
      edges_[key(a, c)].feature = true;
      edges_[key(b, c)].feature = true;
    }
    return true;
  }

  /// Splits ab at the share t from a, then flips around the new vertex.
  void split(Index a, Index b, double t) {
    const Edge edge = edges_.at(key(a, b));
    const auto m = static_cast<Index>(s_.points.size());
    s_.points.push_back(at(a) + t * (at(b) - at(a)));
    edges_.erase(key(a, b));
    std::array<Index, 2> fresh;
    std::array<Index, 2> tips;
    for (int k = 0; k < 2; ++k) {
      const Index f = k == 0 ? edge.f : edge.g;
      const Index c = apex(f, a, b);
      tips[k] = c;
      fresh[k] = static_cast<Index>(s_.facets.size());
      s_.facets.push_back(s_.facets[f]);
      s_.facet_face.push_back(s_.facet_face[f]);
      std::replace(s_.facets[f].begin(), s_.facets[f].end(), b, m);
      std::replace(s_.facets[fresh[k]].begin(), s_.facets[fresh[k]].end(), a, m);
      replace(edges_[key(b, c)], f, fresh[k]);
      edges_[key(m, c)] = {f, fresh[k], false};
    }
    edges_[key(a, m)] = {edge.f, edge.g, edge.feature};
    edges_[key(m, b)] = {fresh[0], fresh[1], edge.feature};
    for (const Index c : tips) {
      flip(a, c);
      flip(b, c);
    }
  }

  bool is_flat(const Edge& edge) const {
    if (bounds_a_face(edge)) return false;
    const auto& v = s_.facets[edge.f];
    const auto& w = s_.facets[edge.g];
    const Vec<3> m = cross(v[0], v[1], v[2]);
    const Vec<3> n = cross(w[0], w[1], w[2]);
    return m.cross(n).norm() < 1e-2 * m.norm() * n.norm();
  }

  /// The second longest edge of a needle when it is a crease and the longest is none.
  std::optional<Longest> crease_beside(const Longest& edge) const {
    std::optional<Longest> best;
    for (const auto& [from, to, apex_of] :
         {std::array{edge.b, edge.apex, edge.a}, std::array{edge.apex, edge.a, edge.b}}) {
      const double length = (at(from) - at(to)).norm();
      if (length > 0.7 * edge.length && (!best || length > best->length)) {
        best = Longest{from, to, apex_of, length};
      }
    }
    if (!best || !is_flat(edges_.at(key(edge.a, edge.b)))) return std::nullopt;
    const auto found = edges_.find(key(best->a, best->b));
    if (found == edges_.end() || is_flat(found->second)) return std::nullopt;
    return best;
  }

  bool treat(Index f) {
    Longest edge = longest(f);
    if (flip(edge.a, edge.b)) return true;
    const double height = edge.length / aspect(f);
    if (edges_.count(key(edge.a, edge.b)) == 0) return false;
    if (absorb(f, edge, height)) return true;
    if (s_.facets.size() + 2 > limit_) return false;
    // Between two long creases (a fillet's strips) a point inside would only halve the width.
    if (const auto crease = crease_beside(edge)) {
      if (crease->length < params_.shortest_edge) return false;
      split(crease->a, crease->b, 0.5);
      return true;
    }
    // Walk to an edge that is the longest of both its facets (Rivara's path).
    for (int step = 0; step < 100; ++step) {
      const auto found = edges_.find(key(edge.a, edge.b));
      if (found == edges_.end()) return false;
      if (!is_flat(found->second)) break;
      const Index g = found->second.f == f ? found->second.g : found->second.f;
      const Longest next = longest(g);
      if (next.length <= edge.length * (1 + 1e-12)) break;
      f = g;
      edge = next;
    }
    if (edge.length < params_.shortest_edge || edges_.count(key(edge.a, edge.b)) == 0) return false;
    const double foot =
        (at(edge.apex) - at(edge.a)).dot(at(edge.b) - at(edge.a)) / (edge.length * edge.length);
    split(edge.a, edge.b, foot > 0.3 && foot < 0.7 ? foot : 0.5);
    return true;
  }

  ReferenceSurface<3>& s_;
  const ImproveParams& params_;
  const Progress& progress_;
  std::unordered_map<std::uint64_t, Edge>
      edges_;  // only looked up, and sorted where it is read out
  std::size_t limit_ = 0;
};

}  // namespace

void improve_triangles(ReferenceSurface<3>& surface, const ImproveParams& params,
                       const Progress& progress) {
  Improver(surface, params, progress).run();
}

}  // namespace lamella
