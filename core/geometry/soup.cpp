#include "core/geometry/soup.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

#include "core/geometry/edge_table.h"

namespace lamella {
namespace {

using Facet = std::array<std::int32_t, 3>;
using Notes = std::vector<std::string>;

struct Triangles {
  std::vector<Vec<3>> points;
  std::vector<Facet> facets;
};

std::string place(const Vec<3>& p) {
  char text[96];
  std::snprintf(text, sizeof(text), "(%.6g, %.6g, %.6g)", p[0], p[1], p[2]);
  return text;
}

/// "1 edge", "4 edges"
std::string counted(std::size_t n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

void note(Notes* notes, std::string text) {
  if (notes) notes->push_back(std::move(text));
}

Error bad(std::string finding, std::string hint) {
  return {Code::bad_input, std::move(finding), std::move(hint)};
}

bool has_repeated_vertex(const Facet& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; }

// --------------------------------------------------------------------------- connectivity

/// Equal coordinates become one vertex; vertices are numbered in the order of the soup.
Triangles merge_exact(const std::vector<std::array<Vec<3>, 3>>& soup) {
  const std::size_t n = 3 * soup.size();
  const auto point = [&](std::size_t i) -> const Vec<3>& { return soup[i / 3][i % 3]; };
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const Vec<3>& p = point(i);
    const Vec<3>& q = point(j);
    for (int k = 0; k < 3; ++k) {
      if (p[k] != q[k]) return p[k] < q[k];
    }
    return i < j;
  });
  std::vector<std::uint32_t> first(n);
  for (std::size_t k = 0; k < n; ++k) {
    const bool same = k > 0 && point(order[k]) == point(order[k - 1]);
    first[order[k]] = same ? first[order[k - 1]] : order[k];
  }
  Triangles t;
  t.facets.resize(soup.size());
  std::vector<std::int32_t> id(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (first[i] == i) {
      id[i] = static_cast<std::int32_t>(t.points.size());
      t.points.push_back(point(i));
    }
    t.facets[i / 3][i % 3] = id[first[i]];
  }
  return t;
}

std::size_t drop_degenerate(Triangles& t) { return std::erase_if(t.facets, has_repeated_vertex); }

/// Facets on the same three vertices: copies of the same winding leave one, opposite pairs enclose
/// nothing and leave none. Returns how many went.
std::size_t drop_duplicates(Triangles& t) {
  struct Key {
    Facet sorted;
    int sign;
    std::size_t facet;
  };
  std::vector<Key> keys;
  keys.reserve(t.facets.size());
  for (std::size_t f = 0; f < t.facets.size(); ++f) {
    Facet s = t.facets[f];
    std::sort(s.begin(), s.end());
    const int at = static_cast<int>(std::find(t.facets[f].begin(), t.facets[f].end(), s[0]) -
                                    t.facets[f].begin());
    keys.push_back({s, t.facets[f][(at + 1) % 3] == s[1] ? 1 : -1, f});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& x, const Key& y) {
    return x.sorted != y.sorted ? x.sorted < y.sorted : x.facet < y.facet;
  });
  std::vector<char> keep(t.facets.size(), 1);
  for (std::size_t i = 0; i < keys.size();) {
    std::size_t j = i;
    int net = 0;
    for (; j < keys.size() && keys[j].sorted == keys[i].sorted; ++j) net += keys[j].sign;
    bool taken = false;
    for (std::size_t k = i; k < j; ++k) {
      const bool chosen = !taken && net * keys[k].sign > 0;
      taken = taken || chosen;
      keep[keys[k].facet] = chosen ? 1 : 0;
    }
    i = j;
  }
  std::size_t f = 0;
  return std::erase_if(t.facets, [&](const Facet&) { return !keep[f++]; });
}

struct Defects {
  std::size_t open = 0;          // edges of one facet
  std::size_t non_manifold = 0;  // edges of more than two
  Vec<3> open_at = Vec<3>::Zero();
  Vec<3> non_manifold_at = Vec<3>::Zero();
};

Defects find_defects(const Triangles& t) {
  Defects d;
  for_each_edge(edge_uses(t.facets), [&](std::span<const EdgeUse> uses) {
    if (uses.size() == 2) return;
    const Vec<3> middle = 0.5 * (t.points[uses[0].a] + t.points[uses[0].b]);
    if (uses.size() == 1) {
      if (d.open++ == 0) d.open_at = middle;
    } else if (d.non_manifold++ == 0) {
      d.non_manifold_at = middle;
    }
  });
  return d;
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

  std::vector<std::int32_t> parent(t.points.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::int32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  const auto joined = [&](std::int32_t i, std::int32_t j) {
    const EdgeUse edge{std::min(i, j), std::max(i, j), 0, true};
    const auto it = std::lower_bound(
        uses.begin(), uses.end(), edge,
        [](const EdgeUse& x, const EdgeUse& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
    return it != uses.end() && it->same_edge(edge);
  };
  for (const NearPair& pair : near_pairs(t, vertices, reach)) {
    const std::int32_t i = root(pair.i);
    const std::int32_t j = root(pair.j);
    if (i == j || (!collapse && joined(pair.i, pair.j))) continue;
    // A chain of near vertices must not walk farther than the tolerance.
    if ((t.points[i] - t.points[j]).norm() > reach) continue;
    parent[std::max(i, j)] = std::min(i, j);
  }
  for (Facet& f : t.facets) {
    for (std::int32_t& v : f) v = root(v);
  }
  drop_degenerate(t);
}

/// Widens the weld by half decades until nothing is open: near vertices elsewhere stay apart.
void close_cracks(Triangles& t, double size, double tolerance, Notes* notes) {
  const Defects before = find_defects(t);
  if (before.open == 0 || tolerance <= 0) return;
  for (const bool collapse : {false, true}) {
    double reach = std::min(1e-8, tolerance);
    for (bool last = false; !last; reach *= std::sqrt(10.0)) {
      last = reach >= tolerance * (1 - 1e-9);
      Triangles trial = t;
      weld(trial, std::min(reach, tolerance) * size, collapse);
      drop_duplicates(trial);
      const Defects now = find_defects(trial);
      if (now.non_manifold > before.non_manifold || trial.facets.empty()) break;
      t = std::move(trial);
      if (now.open == 0) {
        char text[64];
        std::snprintf(text, sizeof(text), "%.2g", std::min(reach, tolerance) * size);
        note(notes, "Cracks along " + counted(before.open, "open edge") +
                        " were closed by welding vertices nearer than " + text + " mm.");
        return;
      }
    }
  }
}

// ---------------------------------------------------------------------- shells and winding

struct Shells {
  std::vector<std::int32_t> of_facet;
  std::int32_t count = 0;
};

/// Floods over the edges: neighbors across an edge run through it in opposite directions.
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
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
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
        const char turn = agrees[f][s] ? turned[f] : !turned[f];
        if (shells.of_facet[g] < 0) {
          shells.of_facet[g] = shells.count;
          turned[g] = turn;
          shell.push_back(g);
        } else if (turned[g] != turn) {
          return bad("the surface is one-sided (like a Moebius strip) near " +
                         place(t.points[t.facets[g][0]]),
                     "Such a surface encloses no volume; repair it in the CAD program.");
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

/// Solid angle of a facet seen from x (van Oosterom and Strackee 1983).
double solid_angle(const Triangles& t, const Facet& f, const Vec<3>& x) {
  const Vec<3> a = t.points[f[0]] - x;
  const Vec<3> b = t.points[f[1]] - x;
  const Vec<3> c = t.points[f[2]] - x;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)),
                        la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

double six_volumes(const Triangles& t, const Facet& f, const Vec<3>& origin) {
  return (t.points[f[0]] - origin).dot((t.points[f[1]] - origin).cross(t.points[f[2]] - origin));
}

struct Shell {
  std::vector<std::int32_t> facets;
  Vec<3> low = Vec<3>::Constant(1e300);
  Vec<3> high = Vec<3>::Constant(-1e300);
  double volume = 0;
  std::vector<std::int32_t> around;  // shells that contain it
};

std::vector<Shell> collect(const Triangles& t, const Shells& shells) {
  std::vector<Shell> all(shells.count);
  for (std::size_t f = 0; f < t.facets.size(); ++f) {
    Shell& s = all[shells.of_facet[f]];
    s.facets.push_back(static_cast<std::int32_t>(f));
    for (const std::int32_t v : t.facets[f]) {
      s.low = s.low.cwiseMin(t.points[v]);
      s.high = s.high.cwiseMax(t.points[v]);
    }
  }
  for (Shell& s : all) {
    for (const std::int32_t f : s.facets) s.volume += six_volumes(t, t.facets[f], s.low) / 6;
  }
  return all;
}

/// Whether shell `in` lies inside `out`: by the winding number of a facet center of `in` that is
/// not on `out` itself.
bool contains(const Triangles& t, const Shell& out, const Shell& in) {
  if ((in.low.array() < out.low.array()).any() || (in.high.array() > out.high.array()).any()) {
    return false;
  }
  if (std::abs(in.volume) >= std::abs(out.volume)) return false;
  const std::size_t step = std::max<std::size_t>(1, in.facets.size() / 8);
  double winding = 0;
  for (std::size_t k = 0; k < in.facets.size(); k += step) {
    const Facet& f = t.facets[in.facets[k]];
    const Vec<3> x = (t.points[f[0]] + t.points[f[1]] + t.points[f[2]]) / 3;
    winding = 0;
    for (const std::int32_t g : out.facets) winding += solid_angle(t, t.facets[g], x);
    winding = std::abs(winding) / (4 * std::numbers::pi);
    if (std::abs(winding - 0.5) > 0.25) break;
  }
  return winding > 0.5;
}

/// Outer shells get a positive volume, the voids in them a negative one, bodies in voids a positive
/// one again.
Result<void> nest(Triangles& t, std::vector<Shell>& shells, Notes* notes,
                  const Progress& progress) {
  std::size_t flat = 0;
  for (const Shell& s : shells) {
    const double box = (s.high - s.low).prod();
    if (!(std::abs(s.volume) > 1e-12 * std::max(box, std::pow((s.high - s.low).norm(), 3) * 1e-6)))
      ++flat;
  }
  if (flat > 0) {
    return bad(counted(flat, "shell") + " without volume, the surface folds onto itself",
               "Give the part a thickness in the CAD program.");
  }
  std::size_t voids = 0;
  std::size_t turned_out = 0;
  std::size_t turned_in = 0;
  for (std::size_t i = 0; i < shells.size(); ++i) {
    if (progress.cancelled()) return cancelled_error();
    progress.report(static_cast<double>(i) / static_cast<double>(shells.size()));
    for (std::size_t j = 0; j < shells.size(); ++j) {
      if (i != j && contains(t, shells[j], shells[i])) {
        shells[i].around.push_back(static_cast<std::int32_t>(j));
      }
    }
  }
  for (Shell& s : shells) {
    const bool is_void = s.around.size() % 2 == 1;
    voids += is_void ? 1 : 0;
    if ((s.volume < 0) == is_void) continue;
    (is_void ? turned_in : turned_out) += 1;
    for (const std::int32_t f : s.facets) std::swap(t.facets[f][1], t.facets[f][2]);
    s.volume = -s.volume;
  }
  if (turned_out > 0) note(notes, counted(turned_out, "inside-out shell") + " turned outward.");
  if (turned_in > 0) {
    note(notes, counted(turned_in, "shell") + " inside another taken as a void and turned inward.");
  }
  if (voids > 0) note(notes, counted(voids, "inner void") + " kept.");
  return {};
}

ReferenceSurface<3> extract(const Triangles& t, const std::vector<const Shell*>& shells) {
  ReferenceSurface<3> surface;
  std::vector<std::int32_t> facets;
  for (const Shell* s : shells) facets.insert(facets.end(), s->facets.begin(), s->facets.end());
  std::sort(facets.begin(), facets.end());
  std::vector<std::int32_t> id(t.points.size(), -1);
  for (const std::int32_t f : facets) {
    Facet mine = t.facets[f];
    for (std::int32_t& v : mine) {
      if (id[v] < 0) {
        id[v] = static_cast<std::int32_t>(surface.points.size());
        surface.points.push_back(t.points[v]);
      }
      v = id[v];
    }
    surface.facets.push_back(mine);
  }
  return surface;
}

struct Prepared {
  Triangles triangles;
  std::vector<Shell> shells;
};

Result<Prepared> prepare(const std::vector<std::array<Vec<3>, 3>>& soup, const SoupParams& params,
                         Notes* notes, const Progress& progress) {
  if (soup.empty()) return bad("the surface has no facet", "Export the part again.");
  Vec<3> low = soup[0][0];
  Vec<3> high = low;
  for (const auto& facet : soup) {
    for (const Vec<3>& p : facet) {
      if (!p.allFinite()) {
        return bad("a coordinate is not a finite number", "The file is damaged; export it again.");
      }
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  const double size = (high - low).norm();
  if (size == 0) return bad("all vertices are the same point", "Export the part again.");

  Prepared out;
  Triangles& t = out.triangles;
  t = merge_exact(soup);
  progress.report(0.2);
  const std::size_t degenerate = drop_degenerate(t);
  if (degenerate > 0) note(notes, counted(degenerate, "degenerate facet") + " dropped.");
  const std::size_t duplicate = drop_duplicates(t);
  if (duplicate > 0) note(notes, counted(duplicate, "duplicate facet") + " dropped.");
  if (progress.cancelled()) return cancelled_error();
  close_cracks(t, size, params.weld_tolerance, notes);
  progress.report(0.5);
  if (progress.cancelled()) return cancelled_error();
  if (t.facets.empty()) return bad("the surface encloses no volume", "Export the part again.");

  const Defects defects = find_defects(t);
  if (defects.open > 0) {
    return bad("the surface is not closed: " + counted(defects.open, "open edge") +
                   ", the first at " + place(defects.open_at) +
                   (defects.non_manifold > 0
                        ? ", and " + counted(defects.non_manifold, "non-manifold edge")
                        : ""),
               "Close the hole in the CAD program, or repair the STL with a mesh repair program.");
  }
  if (defects.non_manifold > 0) {
    return bad("the surface is not manifold: more than two facets meet at " +
                   counted(defects.non_manifold, "edge") + ", the first at " +
                   place(defects.non_manifold_at),
               "Bodies that touch or overlap share these edges: unite them in the CAD program or "
               "export them one by one.");
  }
  Result<Shells> shells = orient(t, notes);
  if (!shells) return shells.error();
  progress.report(0.7);
  out.shells = collect(t, *shells);
  if (Result<void> nested = nest(t, out.shells, notes, progress.portion(0.7, 0.95)); !nested) {
    return nested.error();
  }
  return out;
}

}  // namespace

Result<ReferenceSurface<3>> surface_from_soup(const std::vector<std::array<Vec<3>, 3>>& soup,
                                              const SoupParams& params, Notes* notes,
                                              const Progress& progress) {
  Result<Prepared> prepared = prepare(soup, params, notes, progress);
  if (!prepared) return prepared.error();
  std::vector<const Shell*> all;
  for (const Shell& s : prepared->shells) all.push_back(&s);
  ReferenceSurface<3> surface = extract(prepared->triangles, all);
  find_features(surface, params.feature_angle);
  progress.report(1);
  return surface;
}

Result<std::vector<ReferenceSurface<3>>> surfaces_from_soup(
    const std::vector<std::array<Vec<3>, 3>>& soup, const SoupParams& params, Notes* notes,
    const Progress& progress) {
  Result<Prepared> prepared = prepare(soup, params, notes, progress);
  if (!prepared) return prepared.error();
  const std::vector<Shell>& shells = prepared->shells;
  std::vector<std::pair<double, std::vector<const Shell*>>> bodies;
  std::map<std::size_t, std::size_t> body_of;
  for (std::size_t s = 0; s < shells.size(); ++s) {
    if (shells[s].around.size() % 2 == 1) continue;
    body_of[s] = bodies.size();
    bodies.push_back({shells[s].volume, {&shells[s]}});
  }
  for (const Shell& s : shells) {
    if (s.around.size() % 2 == 0) continue;
    // The body of a void is the deepest of the shells around it.
    const std::int32_t owner =
        *std::max_element(s.around.begin(), s.around.end(), [&](std::int32_t x, std::int32_t y) {
          return shells[x].around.size() < shells[y].around.size();
        });
    const auto found = body_of.find(static_cast<std::size_t>(owner));
    if (found == body_of.end()) {
      return bad("the shells of the surface cross each other near " + place(s.low),
                 "Unite the bodies in the CAD program.");
    }
    bodies[found->second].second.push_back(&s);
  }
  std::stable_sort(bodies.begin(), bodies.end(),
                   [](const auto& x, const auto& y) { return x.first > y.first; });
  std::vector<ReferenceSurface<3>> surfaces;
  for (const auto& body : bodies) {
    surfaces.push_back(extract(prepared->triangles, body.second));
    find_features(surfaces.back(), params.feature_angle);
  }
  progress.report(1);
  return surfaces;
}

template <int D>
double enclosed_measure(const ReferenceSurface<D>& surface) {
  if (surface.points.empty()) return 0;
  const Vec<D> origin = surface.points[0];  // near the body: no cancellation far from the origin
  double sum = 0;
  for (const auto& facet : surface.facets) {
    Mat<D> a;
    for (int k = 0; k < D; ++k) a.col(k) = surface.points[facet[k]] - origin;
    // facet_normal points outward: det(p_1-p_0, .., v-p_0) < 0 for an apex v inside in 3D's order
    // (p_0, .., p_{D-1}), which is det(p_0-o, .., p_{D-1}-o) with the sign of (-1)^(D-1).
    sum += (D % 2 == 0 ? -1 : 1) * a.determinant();
  }
  return sum / factorial(D);
}

template <int D>
Result<void> check_closed(const ReferenceSurface<D>& surface) {
  const std::string hint = "Repair the surface so that it encloses a volume.";
  const auto n = static_cast<std::int32_t>(surface.points.size());
  for (const auto& facet : surface.facets) {
    for (const std::int32_t v : facet) {
      if (v < 0 || v >= n) return bad("a facet names a vertex that is not there", hint);
    }
  }
  std::size_t open = 0;
  std::size_t wrong = 0;
  std::string where;
  const auto count = [&](std::size_t uses, std::size_t forward, const Vec<D>& p) {
    if (2 * forward == uses) return;
    if (open + wrong == 0) {
      for (int k = 0; k < D; ++k) where += (k > 0 ? ", " : "(") + std::to_string(p[k]);
      where += ")";
    }
    (uses % 2 == 1 ? open : wrong) += 1;
  };
  if constexpr (D == 2) {
    std::vector<std::array<std::size_t, 2>> ends(surface.points.size());
    for (const auto& facet : surface.facets) {
      for (int k = 0; k < 2; ++k) ++ends[facet[k]][k];
    }
    for (std::size_t v = 0; v < ends.size(); ++v) {
      count(ends[v][0] + ends[v][1], ends[v][0], surface.points[v]);
    }
  } else {
    for_each_edge(edge_uses(surface.facets), [&](std::span<const EdgeUse> uses) {
      const auto forward =
          std::count_if(uses.begin(), uses.end(), [](const EdgeUse& u) { return u.forward; });
      count(uses.size(), static_cast<std::size_t>(forward),
            0.5 * (surface.points[uses[0].a] + surface.points[uses[0].b]));
    });
  }
  const std::string what = D == 2 ? "vertex" : "edge";
  const std::string plural = D == 2 ? "vertices" : "edges";
  const auto say = [&](std::size_t k) {
    return std::to_string(k) + " " + (k == 1 ? what : plural);
  };
  if (open > 0) return bad("the surface is open at " + say(open) + ", near " + where, hint);
  if (wrong > 0) return bad("the winding changes at " + say(wrong) + ", near " + where, hint);
  if (!(enclosed_measure(surface) > 0)) return bad("the surface encloses no volume", hint);
  return {};
}

template double enclosed_measure<2>(const ReferenceSurface<2>&);
template double enclosed_measure<3>(const ReferenceSurface<3>&);
template Result<void> check_closed<2>(const ReferenceSurface<2>&);
template Result<void> check_closed<3>(const ReferenceSurface<3>&);

void find_features(ReferenceSurface<3>& surface, double angle) {
  constexpr double kKink = 0.6;
  std::vector<Vec<3>> normals(surface.facets.size());
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    std::array<Vec<3>, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = surface.points[surface.facets[f][k]];
    normals[f] = facet_normal<3>(p).stableNormalized();
  }
  surface.feature_edges.clear();
  std::vector<std::pair<std::int32_t, std::int32_t>> smooth;
  for_each_edge(edge_uses(surface.facets), [&](std::span<const EdgeUse> uses) {
    const bool sharp =
        uses.size() != 2 || std::atan2(normals[uses[0].facet].cross(normals[uses[1].facet]).norm(),
                                       normals[uses[0].facet].dot(normals[uses[1].facet])) > angle;
    if (sharp) {
      surface.feature_edges.push_back({uses[0].a, uses[0].b});
    } else {
      smooth.emplace_back(uses[0].facet, uses[1].facet);
    }
  });

  // Patches: facets joined by smooth edges, numbered by their first facet.
  std::vector<std::int32_t> parent(surface.facets.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::int32_t f) {
    while (parent[f] != f) f = parent[f] = parent[parent[f]];
    return f;
  };
  for (const auto& [f, g] : smooth) {
    const std::int32_t i = root(f);
    const std::int32_t j = root(g);
    parent[std::max(i, j)] = std::min(i, j);
  }
  surface.facet_face.assign(surface.facets.size(), -1);
  surface.faces.clear();
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    const std::int32_t r = root(static_cast<std::int32_t>(f));
    if (surface.facet_face[r] < 0) {
      surface.facet_face[r] = static_cast<std::int32_t>(surface.faces.size());
      surface.faces.emplace_back();
    }
    surface.facet_face[f] = surface.facet_face[r];
  }

  std::vector<std::vector<std::int32_t>> along(surface.points.size());
  for (const auto& edge : surface.feature_edges) {
    along[edge[0]].push_back(edge[1]);
    along[edge[1]].push_back(edge[0]);
  }
  surface.corners.clear();
  for (std::size_t v = 0; v < along.size(); ++v) {
    if (along[v].empty()) continue;
    bool corner = along[v].size() != 2;
    if (!corner) {
      const Vec<3> in = surface.points[v] - surface.points[along[v][0]];
      const Vec<3> out = surface.points[along[v][1]] - surface.points[v];
      corner = std::atan2(in.cross(out).norm(), in.dot(out)) > kKink;
    }
    if (corner) surface.corners.push_back(static_cast<std::int32_t>(v));
  }
}

}  // namespace lamella
