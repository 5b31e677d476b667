#include "core/geometry/diagnosis.h"

#include <map>

#include "core/base/disjoint_sets.h"
#include "core/base/parallel.h"
#include "core/geometry/locator.h"
#include "core/geometry/self_intersection.h"

namespace lamella {
namespace {

using Facet = std::array<std::int32_t, 3>;

class Collector {
 public:
  explicit Collector(std::size_t most) : most_(most) {}
  void operator()(Finding& finding, const Vec<3>& place) const {
    if (finding.count++ < most_) finding.places.push_back(place);
  }

 private:
  std::size_t most_;
};

Vec<3> middle(const std::array<Vec<3>, 3>& p) { return (p[0] + p[1] + p[2]) / 3; }

/// Shell of every facet, numbered by their first facets.
std::vector<std::int32_t> shells_of(const Triangles& t, const std::vector<EdgeUse>& uses,
                                    std::int32_t& count) {
  DisjointSets shells(t.facets.size());
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    for (const EdgeUse& use : edge) shells.join(edge[0].facet, use.facet);
  });
  count = 0;
  std::vector<std::int32_t> shell(t.facets.size());
  for (std::size_t f = 0; f < shell.size(); ++f) {
    const std::int32_t r = shells.root(static_cast<std::int32_t>(f));
    shell[f] = r == static_cast<std::int32_t>(f) ? count++ : shell[r];
  }
  return shell;
}

struct Grouped {
  std::vector<std::int32_t> shell;                 // of each facet
  std::vector<std::vector<std::int32_t>> members;  // facets of each shell
  std::vector<ShellFinding> found;
};

Grouped group(const Triangles& t, const Progress& progress) {
  Grouped g;
  const std::vector<EdgeUse> uses = edge_uses(t.facets);
  std::int32_t count = 0;
  g.shell = shells_of(t, uses, count);
  g.members.resize(count);
  g.found.resize(count);
  for (ShellFinding& s : g.found) {
    s.closed = true;
    s.low = Vec<3>::Constant(1e300);
    s.high = -s.low;
  }
  for (std::size_t f = 0; f < t.facets.size(); ++f) {
    ShellFinding& s = g.found[g.shell[f]];
    g.members[g.shell[f]].push_back(static_cast<std::int32_t>(f));
    ++s.facets;
    for (const Vec<3>& p : t.corners(f)) {
      s.low = s.low.cwiseMin(p);
      s.high = s.high.cwiseMax(p);
    }
  }
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() % 2 == 1) g.found[g.shell[edge[0].facet]].closed = false;
  });
  for (std::int32_t s = 0; s < count; ++s) {
    const Vec<3> origin = g.found[s].low;
    for (const std::int32_t f : g.members[s]) {
      const auto p = t.corners(f);
      g.found[s].volume += (p[0] - origin).dot((p[1] - origin).cross(p[2] - origin)) / 6;
    }
  }
  for (std::int32_t i = 0; i < count && !progress.cancelled(); ++i) {
    ShellFinding& in = g.found[i];
    double least = 1e300;
    for (std::int32_t j = 0; j < count; ++j) {
      const ShellFinding& out = g.found[j];
      if (i == j || !in.closed || !out.closed || std::abs(out.volume) <= std::abs(in.volume) ||
          (in.low.array() < out.low.array()).any() || (in.high.array() > out.high.array()).any() ||
          !lies_inside(t, g.members[i], g.members[j]))
        continue;
      ++in.depth;
      if (std::abs(out.volume) < least) {
        least = std::abs(out.volume);
        in.around = j;
      }
    }
  }
  return g;
}

void find_duplicates(const Triangles& t, const Collector& add, Diagnosis& d) {
  std::vector<std::pair<Facet, std::size_t>> keys;
  for (std::size_t f = 0; f < t.facets.size(); ++f) {
    Facet s = t.facets[f];
    std::sort(s.begin(), s.end());
    if (s[0] != s[1] && s[1] != s[2]) keys.emplace_back(s, f);
  }
  std::sort(keys.begin(), keys.end());
  for (std::size_t k = 1; k < keys.size(); ++k)
    if (keys[k].first == keys[k - 1].first)
      add(d.duplicate_facets, middle(t.corners(keys[k].second)));
}

void measure_walls(const Triangles& t, const DiagnoseParams& params, const Collector& add,
                   const Progress& progress, Diagnosis& d) {
  const Locator<3> locator(plain_surface(t));
  const double diagonal = (d.high - d.low).norm();
  d.thin_limit = params.thin_wall > 0 ? params.thin_wall : 1e-3 * diagonal;
  std::vector<double> wall(t.facets.size(), 1e300);
  parallel_each(t.facets.size(), 0, progress, [&](std::size_t f) {
    const Vec<3> n = locator.normal(static_cast<std::int32_t>(f));
    if (n.isZero()) return;
    const auto hit = locator.exit(middle(t.corners(f)), -n, 1e-9 * diagonal);
    // Beside an edge a ray meets the next side at once: only the opposite one is a wall.
    if (hit && locator.normal(hit->facet).dot(n) < -0.7) wall[f] = hit->t;
  });
  double least = 1e300;
  for (std::size_t f = 0; f < wall.size(); ++f) {
    least = std::min(least, wall[f]);
    if (wall[f] < d.thin_limit) add(d.thin_walls, middle(t.corners(f)));
  }
  d.thinnest = least < 1e300 ? least : 0;
}

}  // namespace

Diagnosis diagnose(const Triangles& t, const DiagnoseParams& params, const Progress& progress) {
  Diagnosis d;
  const Collector add(params.most_places);
  d.facets = t.facets.size();
  d.vertices = t.points.size();
  if (t.facets.empty()) return d;
  d.low = d.high = t.points[t.facets[0][0]];
  Triangles whole = t;
  for (std::size_t f = 0; f < t.facets.size(); ++f) {
    const auto p = t.corners(f);
    for (const Vec<3>& x : p) {
      d.low = d.low.cwiseMin(x);
      d.high = d.high.cwiseMax(x);
    }
    const double twice = facet_normal<3>(p).norm();
    d.area += 0.5 * twice;
    const double longest = std::max(
        {(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
    if (!(twice > 1e-9 * longest)) add(d.degenerate_facets, middle(p));
  }
  drop_degenerate(whole);
  find_duplicates(t, add, d);
  for_each_edge(edge_uses(whole.facets), [&](std::span<const EdgeUse> edge) {
    const Vec<3> at = 0.5 * (t.points[edge[0].a] + t.points[edge[0].b]);
    if (edge.size() == 1) add(d.open_edges, at);
    if (edge.size() > 2) add(d.non_manifold_edges, at);
    if (edge.size() == 2 && edge[0].forward == edge[1].forward) add(d.wrong_windings, at);
  });
  const Grouped g = group(whole, progress.portion(0, 0.3));
  d.shells = g.found;
  for (const ShellFinding& s : d.shells)
    if (s.closed) d.volume += s.volume;
  if (progress.cancelled()) return d;
  Triangles distinct = whole;
  drop_duplicates(distinct);
  for (const auto& [f, h] :
       self_intersecting_pairs(distinct.points, distinct.facets, progress.portion(0.3, 0.7)))
    add(d.self_intersections, middle(distinct.corners(f)));
  if (d.open_edges.count + d.non_manifold_edges.count + d.wrong_windings.count == 0)
    measure_walls(whole, params, add, progress.portion(0.7, 1), d);
  return d;
}

std::vector<Diagnosis> diagnose_bodies(const Triangles& triangles, const DiagnoseParams& params,
                                       const Progress& progress) {
  const Grouped g = group(triangles, progress.portion(0, 0.2));
  std::vector<std::vector<std::int32_t>> bodies;
  std::map<std::int32_t, std::size_t> body_of;
  for (std::size_t s = 0; s < g.found.size(); ++s) {
    if (g.found[s].depth % 2 == 1) continue;
    body_of[static_cast<std::int32_t>(s)] = bodies.size();
    bodies.push_back(g.members[s]);
  }
  for (std::size_t s = 0; s < g.found.size(); ++s) {
    if (g.found[s].depth % 2 == 0) continue;
    const auto it = body_of.find(g.found[s].around);
    if (it == body_of.end()) {
      bodies.push_back(g.members[s]);  // shells that cross: counted on its own
      continue;
    }
    auto& body = bodies[it->second];
    body.insert(body.end(), g.members[s].begin(), g.members[s].end());
  }
  std::stable_sort(bodies.begin(), bodies.end(),
                   [](const auto& x, const auto& y) { return x.size() > y.size(); });
  std::vector<Diagnosis> found;
  const double step = 0.8 / static_cast<double>(std::max<std::size_t>(1, bodies.size()));
  for (std::size_t b = 0; b < bodies.size() && !progress.cancelled(); ++b) {
    const double at = 0.2 + step * static_cast<double>(b);
    found.push_back(diagnose(subset(triangles, bodies[b]), params,
                             progress.portion(at, std::min(1.0, at + step))));
  }
  return found;
}

std::string guess_unit(double diagonal) {
  if (diagonal >= 15) return "mm";
  return diagonal >= 1 ? "inch" : "m";
}

}  // namespace lamella
