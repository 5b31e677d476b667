#include "core/geometry/repair.h"

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "core/base/disjoint_sets.h"
#include "core/geometry/self_intersection.h"

namespace lamella {
namespace {

using Facet = std::array<std::int32_t, 3>;

void note(Notes* notes, std::string text) {
  if (notes) notes->push_back(std::move(text));
}

// --------------------------------------------------------------------------------- cracks

struct NearPair {
  double distance2;
  std::int32_t i, j;
};

/// Pairs of `vertices` nearer than `reach`, nearest first.
std::vector<NearPair> near_pairs(const Triangles& t, const std::vector<std::int32_t>& vertices,
                                 double reach) {
  using Cell = std::array<std::int64_t, 3>;
  std::vector<std::pair<Cell, std::int32_t>> cells;
  cells.reserve(vertices.size());
  for (const std::int32_t v : vertices) {
    Cell c;
    for (int k = 0; k < 3; ++k) {
      c[k] = static_cast<std::int64_t>(std::floor(t.points[v][k] / reach));
    }
    cells.emplace_back(c, v);
  }
  std::sort(cells.begin(), cells.end());
  std::vector<NearPair> pairs;
  for (const auto& [cell, v] : cells) {
    for (int n = 0; n < 27; ++n) {
      const Cell next{cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1};
      auto it = std::lower_bound(cells.begin(), cells.end(), std::pair(next, v + 1));
      for (; it != cells.end() && it->first == next; ++it) {
        const double d2 = (t.points[v] - t.points[it->second]).squaredNorm();
        if (d2 <= reach * reach) pairs.push_back({d2, v, it->second});
      }
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const NearPair& x, const NearPair& y) {
    if (x.distance2 != y.distance2) return x.distance2 < y.distance2;
    return x.i != y.i ? x.i < y.i : x.j < y.j;
  });
  return pairs;
}

/// Merges vertices of open edges nearer than `reach`; two ends of one edge only with `collapse`.
void weld(Triangles& t, double reach, bool collapse) {
  const std::vector<EdgeUse> uses = edge_uses(t.facets);
  std::vector<std::int32_t> vertices;
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 1) vertices.insert(vertices.end(), {edge[0].a, edge[0].b});
  });
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

  DisjointSets welded(t.points.size());
  for (const NearPair& pair : near_pairs(t, vertices, reach)) {
    const std::int32_t i = welded.root(pair.i);
    const std::int32_t j = welded.root(pair.j);
    if (i == j || (!collapse && has_edge(uses, pair.i, pair.j))) continue;
    // A chain of near vertices must not walk farther than the tolerance.
    if ((t.points[i] - t.points[j]).norm() > reach) continue;
    welded.join(i, j);
  }
  for (Facet& f : t.facets) {
    for (std::int32_t& v : f) v = welded.root(v);
  }
  drop_degenerate(t);
}

// ------------------------------------------------------------------------------------ fans

/// One facet at an edge, by its angle around it. Material lies towards smaller angles of a facet
/// that runs along the edge, and towards larger ones of a facet that runs against it.
struct Blade {
  double angle;
  std::int32_t facet;
  bool forward;
};

std::vector<Blade> blades_of(const Triangles& t, std::span<const EdgeUse> edge) {
  const Vec<3> origin = t.points[edge[0].a];
  const Vec<3> axis = (t.points[edge[0].b] - origin).stableNormalized();
  Vec<3> x = Vec<3>::Zero();
  std::vector<Blade> blades;
  for (const EdgeUse& use : edge) {
    const Facet& f = t.facets[use.facet];
    std::int32_t apex = f[0];
    for (const std::int32_t v : f)
      if (v != use.a && v != use.b) apex = v;
    Vec<3> d = t.points[apex] - origin;
    d -= d.dot(axis) * axis;
    if (blades.empty()) x = d.stableNormalized();
    double angle = std::atan2(axis.dot(x.cross(d)), x.dot(d));
    if (angle < 0) angle += 2 * std::numbers::pi;
    if (angle > 2 * std::numbers::pi - 1e-7) angle = 0;
    blades.push_back({angle, use.facet, use.forward});
  }
  // Facets that lie on each other: a gap without thickness between two materials, not the reverse.
  std::sort(blades.begin(), blades.end(), [](const Blade& p, const Blade& q) {
    const auto p7 = static_cast<std::int64_t>(p.angle * 1e7 + 0.5);
    const auto q7 = static_cast<std::int64_t>(q.angle * 1e7 + 0.5);
    if (p7 != q7) return p7 < q7;
    return p.forward != q.forward ? p.forward : p.facet < q.facet;
  });
  return blades;
}

/// Pairs of facets with material between them; empty when the windings do not match up.
std::vector<std::array<std::int32_t, 2>> pair_blades(const std::vector<Blade>& blades) {
  const auto n = static_cast<std::ptrdiff_t>(blades.size());
  const auto forward =
      std::count_if(blades.begin(), blades.end(), [](auto& b) { return b.forward; });
  if (2 * forward != n) return {};
  // Brackets around a circle: begin where no bracket is open.
  std::ptrdiff_t depth = 0, least = 0, start = 0;
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    depth += blades[k].forward ? -1 : 1;
    if (depth < least) {
      least = depth;
      start = k + 1;
    }
  }
  std::vector<std::array<std::int32_t, 2>> pairs;
  std::vector<std::int32_t> open;
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    const Blade& b = blades[(start + k) % n];
    if (!b.forward) {
      open.push_back(b.facet);
    } else {
      pairs.push_back({open.back(), b.facet});
      open.pop_back();
    }
  }
  return pairs;
}

/// Edges whose ends hang together around both sides cannot come apart there: each pair of facets
/// gets a point of its own in the middle, moved into its material.
void part_middles(Triangles& t, double gap) {
  constexpr int kRounds = 6;  // a facet is split at one edge a round
  for (int round = 0; round < kRounds; ++round) {
    std::vector<char> touched(t.facets.size(), 0);
    std::vector<Facet> added;
    for_each_edge(edge_uses(t.facets), [&](std::span<const EdgeUse> edge) {
      if (edge.size() <= 2) return;
      for (const EdgeUse& use : edge)
        if (touched[use.facet]) return;
      for (const auto& pair : pair_blades(blades_of(t, edge))) {
        const Vec<3> inward = -(facet_normal<3>(t.corners(pair[0])).stableNormalized() +
                                facet_normal<3>(t.corners(pair[1])).stableNormalized());
        const auto m = static_cast<std::int32_t>(t.points.size());
        t.points.push_back(0.5 * (t.points[edge[0].a] + t.points[edge[0].b]) +
                           gap * inward.stableNormalized());
        for (const std::int32_t f : pair) {
          touched[f] = 1;
          Facet& facet = t.facets[f];
          int k = 0;
          while (facet[k] == edge[0].a || facet[k] == edge[0].b) ++k;
          const std::int32_t apex = facet[k], x = facet[(k + 1) % 3], y = facet[(k + 2) % 3];
          facet = {apex, x, m};
          added.push_back({apex, m, y});
        }
      }
    });
    t.facets.insert(t.facets.end(), added.begin(), added.end());
    if (added.empty()) return;
  }
}

int corner_of(const Facet& f, std::int32_t v) { return f[0] == v ? 0 : f[1] == v ? 1 : 2; }

// ----------------------------------------------------------------------------------- holes

struct Loop {
  std::vector<std::int32_t> vertices;  // in the direction of the facets that fill it
  double extent = 0;                   // diagonal of its box, mm
  Vec<3> center = Vec<3>::Zero();
};

std::vector<Loop> open_loops(const Triangles& t) {
  std::map<std::int32_t, std::vector<std::int32_t>> next;
  for_each_edge(edge_uses(t.facets), [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 1) return;
    const auto [from, to] =
        edge[0].forward ? std::pair(edge[0].b, edge[0].a) : std::pair(edge[0].a, edge[0].b);
    next[from].push_back(to);
  });
  std::vector<Loop> loops;
  const auto close = [&](std::vector<std::int32_t> vertices) {
    Loop loop;
    std::vector<Vec<3>> points;
    for (const std::int32_t v : vertices) {
      points.push_back(t.points[v]);
      loop.center += t.points[v] / static_cast<double>(vertices.size());
    }
    loop.extent = diagonal_of(points);
    loop.vertices = std::move(vertices);
    loops.push_back(std::move(loop));
  };
  for (auto& [seed, targets] : next) {
    while (!targets.empty()) {
      // A walk that meets itself has closed a simple loop.
      std::vector<std::int32_t> walk{seed};
      std::map<std::int32_t, std::size_t> at{{seed, 0}};
      for (;;) {
        const auto found = next.find(walk.back());
        if (found == next.end() || found->second.empty()) break;  // wrongly wound: an open chain
        const std::int32_t v = found->second.back();
        found->second.pop_back();
        const auto met = at.find(v);
        if (met == at.end()) {
          at[v] = walk.size();
          walk.push_back(v);
          continue;
        }
        const std::size_t first = met->second;
        close({walk.begin() + static_cast<std::ptrdiff_t>(first), walk.end()});
        for (std::size_t k = first + 1; k < walk.size(); ++k) at.erase(walk[k]);
        walk.resize(first + 1);
        if (walk.size() == 1) break;
      }
    }
  }
  return loops;
}

/// Triangulation of least area of a closed polygon (dynamic programming over its diagonals);
/// diagonals that `taken` tells are not used. Empty when there is none.
std::vector<Facet> least_area(const Triangles& t, const std::vector<std::int32_t>& loop,
                              const std::set<std::array<std::int32_t, 2>>& taken) {
  const std::size_t n = loop.size();
  constexpr double kNone = 1e300;
  std::vector<double> cost(n * n, 0);
  std::vector<std::size_t> apex(n * n, 0);
  for (std::size_t span = 2; span < n; ++span) {
    for (std::size_t i = 0; i + span < n; ++i) {
      const std::size_t j = i + span;
      double best = kNone;
      const bool side = span + 1 == n;
      if (side || taken.count({std::min(loop[i], loop[j]), std::max(loop[i], loop[j])}) == 0) {
        for (std::size_t k = i + 1; k < j; ++k) {
          if (cost[i * n + k] >= kNone || cost[k * n + j] >= kNone) continue;
          const double area =
              0.5 *
              facet_normal<3>({t.points[loop[i]], t.points[loop[k]], t.points[loop[j]]}).norm();
          const double sum = cost[i * n + k] + cost[k * n + j] + area;
          if (sum < best) {
            best = sum;
            apex[i * n + j] = k;
          }
        }
      }
      cost[i * n + j] = best;
    }
  }
  if (n < 3 || cost[n - 1] >= kNone) return {};
  std::vector<Facet> facets;
  std::vector<std::pair<std::size_t, std::size_t>> todo{{0, n - 1}};
  while (!todo.empty()) {
    const auto [i, j] = todo.back();
    todo.pop_back();
    if (j - i < 2) continue;
    const std::size_t k = apex[i * n + j];
    facets.push_back({loop[i], loop[k], loop[j]});
    todo.push_back({i, k});
    todo.push_back({k, j});
  }
  return facets;
}

}  // namespace

void weld_cracks(Triangles& t, double tolerance, Notes* notes) {
  const EdgeDefects before = find_edge_defects(t);
  if (before.open == 0 || !(tolerance > 0)) return;
  const double first = std::min(1e-4 * tolerance, tolerance);
  double reached = 0;
  EdgeDefects now = before;
  for (const bool collapse : {false, true}) {
    double reach = first;
    for (bool last = false; !last && now.open > 0; reach *= std::sqrt(10.0)) {
      last = reach >= tolerance * (1 - 1e-9);
      Triangles trial = t;
      weld(trial, std::min(reach, tolerance), collapse);
      drop_duplicates(trial);
      const EdgeDefects then = find_edge_defects(trial);
      if (then.non_manifold > before.non_manifold || trial.facets.empty()) break;
      if (then.open < now.open) reached = std::max(reached, std::min(reach, tolerance));
      now = then;
      t = std::move(trial);
    }
  }
  if (now.open < before.open)
    note(notes, "Cracks along " + counted(before.open - now.open, "open edge") +
                    " were closed by welding vertices nearer than " + length_text(reached) +
                    " mm.");
}

std::size_t split_at_t_vertices(Triangles& t, double tolerance, Notes* notes) {
  std::size_t met = 0;
  for (int round = 0; round < 8; ++round) {
    std::vector<EdgeUse> open;
    std::vector<std::int32_t> vertices;
    for_each_edge(edge_uses(t.facets), [&](std::span<const EdgeUse> edge) {
      if (edge.size() != 1) return;
      open.push_back(edge[0]);
      vertices.insert(vertices.end(), {edge[0].a, edge[0].b});
    });
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::sort(vertices.begin(), vertices.end(), [&](std::int32_t i, std::int32_t j) {
      return t.points[i][0] != t.points[j][0] ? t.points[i][0] < t.points[j][0] : i < j;
    });
    std::vector<char> touched(t.facets.size(), 0);
    std::vector<Facet> added;
    std::size_t here = 0;
    for (const EdgeUse& use : open) {
      if (touched[use.facet]) continue;
      const Vec<3> a = t.points[use.a];
      const Vec<3> e = t.points[use.b] - a;
      const double length = e.norm();
      if (!(length > 2 * tolerance)) continue;
      std::vector<std::pair<double, std::int32_t>> on;
      auto it = std::lower_bound(vertices.begin(), vertices.end(),
                                 std::min(a[0], a[0] + e[0]) - tolerance,
                                 [&](std::int32_t v, double x) { return t.points[v][0] < x; });
      for (; it != vertices.end() && t.points[*it][0] <= std::max(a[0], a[0] + e[0]) + tolerance;
           ++it) {
        const Facet& f = t.facets[use.facet];
        if (*it == f[0] || *it == f[1] || *it == f[2]) continue;
        const Vec<3> d = t.points[*it] - a;
        const double s = d.dot(e) / length;
        if (s > tolerance && s < length - tolerance && (d - s / length * e).norm() <= tolerance)
          on.emplace_back(s, *it);
      }
      if (on.empty()) continue;
      std::sort(on.begin(), on.end());
      touched[use.facet] = 1;
      here += on.size();
      const Facet f = t.facets[use.facet];
      int apex = 0;
      while (f[apex] == use.a || f[apex] == use.b) ++apex;
      std::vector<std::int32_t> along{use.a};
      for (const auto& [s, v] : on) along.push_back(v);
      along.push_back(use.b);
      if (f[(apex + 1) % 3] != use.a) std::reverse(along.begin(), along.end());
      t.facets[use.facet] = {f[apex], along[0], along[1]};
      for (std::size_t k = 1; k + 1 < along.size(); ++k)
        added.push_back({f[apex], along[k], along[k + 1]});
    }
    t.facets.insert(t.facets.end(), added.begin(), added.end());
    met += here;
    if (here == 0) break;
  }
  if (met > 0)
    note(notes, "Facets were split at " + std::to_string(met) +
                    " places where a vertex lies on an open edge, within " +
                    length_text(tolerance) + " mm.");
  return met;
}

std::size_t split_fans(Triangles& t, double gap, Notes* notes) {
  const std::size_t corners = 3 * t.facets.size();
  DisjointSets joined(corners), together(t.facets.size());
  std::vector<char> at_fan(t.points.size(), 0);
  std::size_t split = 0;
  const auto join = [&](std::int32_t f, std::int32_t g, const EdgeUse& edge) {
    together.join(f, g);
    for (const std::int32_t v : {edge.a, edge.b})
      joined.join(3 * f + corner_of(t.facets[f], v), 3 * g + corner_of(t.facets[g], v));
  };
  for_each_edge(edge_uses(t.facets), [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 2) join(edge[0].facet, edge[1].facet, edge[0]);
    if (edge.size() <= 2) return;
    const auto pairs = pair_blades(blades_of(t, edge));
    for (const auto& [f, g] : pairs) join(f, g, edge[0]);
    if (pairs.empty()) {
      for (const EdgeUse& use : edge) join(edge[0].facet, use.facet, edge[0]);
    } else {
      ++split;
      at_fan[edge[0].a] = at_fan[edge[0].b] = 1;
    }
  });
  if (split == 0) return 0;

  struct Copy {
    std::int32_t vertex, shell;
    Vec<3> normal;
  };
  std::map<std::int32_t, std::vector<Copy>> copies;  // of the vertices that may come apart
  std::map<std::int32_t, std::size_t> copy_of;       // root corner -> index among its copies
  for (std::size_t c = 0; c < corners; ++c) {
    const std::size_t f = c / 3;
    const std::int32_t v = t.facets[f][c % 3];
    if (!at_fan[v]) continue;
    const std::int32_t root = joined.root(static_cast<std::int32_t>(c));
    auto& mine = copies[v];
    const auto [it, added] = copy_of.emplace(root, mine.size());
    if (added) mine.push_back({v, together.root(static_cast<std::int32_t>(f)), Vec<3>::Zero()});
    mine[it->second].normal += facet_normal<3>(t.corners(f));
  }
  std::size_t moved = 0;
  for (auto& [v, mine] : copies) {
    for (std::size_t k = 1; k < mine.size(); ++k) {
      mine[k].vertex = static_cast<std::int32_t>(t.points.size());
      t.points.push_back(t.points[v]);
    }
    for (std::size_t k = 0; k < mine.size(); ++k) {
      bool touches = false;
      for (std::size_t j = 0; j < mine.size(); ++j)
        touches = touches || (j != k && mine[j].shell == mine[k].shell);
      if (!touches) continue;
      t.points[mine[k].vertex] -= gap * mine[k].normal.stableNormalized();
      ++moved;
    }
  }
  std::vector<Facet> facets = t.facets;
  for (std::size_t c = 0; c < corners; ++c) {
    const std::int32_t v = t.facets[c / 3][c % 3];
    if (at_fan[v])
      facets[c / 3][c % 3] = copies[v][copy_of[joined.root(static_cast<std::int32_t>(c))]].vertex;
  }
  t.facets = std::move(facets);
  part_middles(t, gap);
  std::string text = counted(split, "non-manifold edge") +
                     " were split: facets that bound the same material stay together.";
  if (split == 1) text.replace(text.find("were"), 4, "was");
  if (moved > 0)
    text += " Where a body touches itself its sides moved inward by " + length_text(gap) + " mm.";
  note(notes, text);
  return split;
}

Result<void> fill_holes(Triangles& t, double limit, Notes* notes) {
  std::vector<Loop> loops = open_loops(t);
  if (loops.empty()) {
    if (const EdgeDefects d = find_edge_defects(t); d.open > 0)
      return Error{Code::bad_input,
                   "the surface is not closed: " + counted(d.open, "open edge") +
                       " whose windings form no loop, the first at " + place_text(d.open_at),
                   "Repair the surface in the CAD program."};
    return {};
  }
  constexpr std::size_t kLongest = 400;  // the cost grows with the cube
  DisjointSets together(t.points.size());
  for (const Facet& f : t.facets) {
    together.join(f[0], f[1]);
    together.join(f[0], f[2]);
  }
  std::map<std::int32_t, double> area;
  double all = 0;
  for (std::size_t f = 0; f < t.facets.size(); ++f) {
    const double a = 0.5 * facet_normal<3>(t.corners(f)).norm();
    area[together.root(t.facets[f][0])] += a;
    all += a;
  }
  std::size_t open_edges = 0, refused = 0;
  const Loop* worst = nullptr;
  std::set<std::int32_t> stray;
  for (const Loop& loop : loops) {
    open_edges += loop.vertices.size();
    if (loop.extent <= limit && loop.vertices.size() <= kLongest) continue;
    const std::int32_t shell = together.root(loop.vertices[0]);
    if (area[shell] <= all / 50) {
      stray.insert(shell);
      continue;
    }
    ++refused;
    if (!worst || loop.extent > worst->extent) worst = &loop;
  }
  if (worst) {
    return Error{Code::bad_input,
                 "the surface is not closed: " + counted(open_edges, "open edge") + " around " +
                     counted(loops.size(), "hole") + ", the largest of " +
                     counted(worst->vertices.size(), "edge") + " and " +
                     length_text(worst->extent) + " mm at " + place_text(worst->center),
                 "Holes up to " + length_text(limit) +
                     " mm are filled; close this one in the CAD program, or let the surface be "
                     "wrapped."};
  }
  std::set<std::array<std::int32_t, 2>> taken;
  std::vector<char> on_loop(t.points.size(), 0);
  for (const Loop& loop : loops)
    for (const std::int32_t v : loop.vertices) on_loop[v] = 1;
  for (const Facet& f : t.facets)
    for (int k = 0; k < 3; ++k) {
      const std::int32_t i = f[k], j = f[(k + 1) % 3];
      if (on_loop[i] && on_loop[j]) taken.insert({std::min(i, j), std::max(i, j)});
    }
  std::size_t filled = 0;
  double widest = 0;
  Vec<3> where = Vec<3>::Zero();
  for (const Loop& loop : loops) {
    if (stray.count(together.root(loop.vertices[0])) > 0) continue;
    const std::vector<Facet> patch = least_area(t, loop.vertices, taken);
    if (patch.empty())
      return Error{Code::bad_input,
                   "a hole of " + counted(loop.vertices.size(), "edge") + " and " +
                       length_text(loop.extent) + " mm at " + place_text(loop.center) +
                       " cannot be filled without folding the surface",
                   "Close it in the CAD program, or let the surface be wrapped."};
    t.facets.insert(t.facets.end(), patch.begin(), patch.end());
    for (const Facet& f : patch)
      for (int k = 0; k < 3; ++k)
        taken.insert({std::min(f[k], f[(k + 1) % 3]), std::max(f[k], f[(k + 1) % 3])});
    ++filled;
    if (loop.extent > widest) {
      widest = loop.extent;
      where = loop.center;
    }
  }
  if (filled > 0)
    note(notes, counted(filled, "hole") + " filled, the largest of " + length_text(widest) +
                    " mm at " + place_text(where) + ".");
  if (!stray.empty()) {
    std::erase_if(t.facets, [&](const Facet& f) { return stray.count(together.root(f[0])) > 0; });
    note(notes, counted(stray.size(), "open shell") + " beside the bodies left out.");
  }
  return {};
}

bool mend_crossings(Triangles& t, double limit, Notes* notes, const Progress& progress) {
  constexpr std::size_t kFew = 300;
  const auto pairs = self_intersecting_pairs(t.points, t.facets, progress);
  if (pairs.empty()) return true;
  if (pairs.size() > kFew) return false;
  std::vector<char> cut(t.facets.size(), 0);
  for (const auto& pair : pairs)
    for (const std::int32_t f : pair) cut[f] = 1;
  for (int rings = 0; rings < 4 && !progress.cancelled(); ++rings) {
    if (rings > 0) {
      std::vector<char> at(t.points.size(), 0);
      for (std::size_t f = 0; f < cut.size(); ++f)
        if (cut[f])
          for (const std::int32_t v : t.facets[f]) at[v] = 1;
      for (std::size_t f = 0; f < cut.size(); ++f)
        for (const std::int32_t v : t.facets[f])
          if (at[v]) cut[f] = 1;
    }
    Triangles trial = t;
    std::size_t f = 0;
    std::erase_if(trial.facets, [&](const Facet&) { return cut[f++] != 0; });
    const std::size_t left = trial.facets.size();
    Notes told;
    if (left == 0 || !fill_holes(trial, limit, &told) || trial.facets.size() <= left) continue;
    drop_duplicates(trial);
    const EdgeDefects defects = find_edge_defects(trial);
    if (defects.open + defects.non_manifold > 0 ||
        !self_intersecting_pairs(trial.points, trial.facets, progress).empty())
      continue;
    note(notes, counted(pairs.size(), "pair") + " of facets that crossed, the first at " +
                    place_text(t.points[t.facets[pairs[0][0]][0]]) +
                    ", cut out: " + (told.empty() ? "" : told[0]));
    t = std::move(trial);
    return !progress.cancelled();
  }
  return false;
}

Result<Shells> orient(Triangles& t, Notes* notes) {
  std::vector<std::array<std::int32_t, 3>> across(t.facets.size());
  std::vector<std::array<char, 3>> agrees(t.facets.size());
  const std::vector<EdgeUse> uses = edge_uses(t.facets);
  const auto side = [&](std::int32_t f, const EdgeUse& use) {
    for (int k = 0; k < 2; ++k) {
      const std::int32_t i = t.facets[f][k];
      const std::int32_t j = t.facets[f][k + 1];
      if (std::min(i, j) == use.a && std::max(i, j) == use.b) return k;
    }
    return 2;
  };
  for (auto& a : across) a = {-1, -1, -1};
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 2) return;
    const bool good = edge[0].forward != edge[1].forward;
    for (int s = 0; s < 2; ++s) {
      const int k = side(edge[s].facet, edge[s]);
      across[edge[s].facet][k] = edge[1 - s].facet;
      agrees[edge[s].facet][k] = good;
    }
  });

  Shells shells;
  shells.of_facet.assign(t.facets.size(), -1);
  std::vector<char> turned(t.facets.size(), 0);
  std::size_t flipped = 0;
  std::vector<std::int32_t> shell;
  for (std::size_t seed = 0; seed < t.facets.size(); ++seed) {
    if (shells.of_facet[seed] >= 0) continue;
    shell.assign(1, static_cast<std::int32_t>(seed));
    shells.of_facet[seed] = shells.count;
    std::size_t minority = 0;
    for (std::size_t k = 0; k < shell.size(); ++k) {
      const std::int32_t f = shell[k];
      minority += turned[f] ? 1 : 0;
      for (int s = 0; s < 3; ++s) {
        const std::int32_t g = across[f][s];
        if (g < 0) continue;
        const char turn = agrees[f][s] ? turned[f] : !turned[f];
        if (shells.of_facet[g] < 0) {
          shells.of_facet[g] = shells.count;
          turned[g] = turn;
          shell.push_back(g);
        } else if (turned[g] != turn) {
          return Error{Code::bad_input,
                       "the surface is one-sided (like a Moebius strip) near " +
                           place_text(t.points[t.facets[g][0]]),
                       "Such a surface encloses no volume; repair it in the CAD program."};
        }
      }
    }
    // The larger side keeps its winding, so that an inner void keeps its own direction.
    if (2 * minority > shell.size()) {
      for (const std::int32_t f : shell) turned[f] = !turned[f];
      minority = shell.size() - minority;
    }
    flipped += minority;
    ++shells.count;
  }
  for (std::size_t f = 0; f < t.facets.size(); ++f) {
    if (turned[f]) std::swap(t.facets[f][1], t.facets[f][2]);
  }
  if (flipped > 0) note(notes, counted(flipped, "facet") + " wound against the others: turned.");
  return shells;
}

}  // namespace lamella
