#include "core/geometry/soup.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>

#include "core/base/disjoint_sets.h"

namespace lamella {
namespace {

constexpr double kTouchGap = 1e-5;  // of the box diagonal, between sides of a body that touch

using Facet = std::array<std::int32_t, 3>;

void note(Notes* notes, std::string text) {
  if (notes) notes->push_back(std::move(text));
}

Error bad(std::string finding, std::string hint) {
  return {Code::bad_input, std::move(finding), std::move(hint)};
}

// ---------------------------------------------------------------------- shells and winding

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

bool contains(const Triangles& t, const Shell& out, const Shell& in) {
  return (in.low.array() >= out.low.array()).all() && (in.high.array() <= out.high.array()).all() &&
         std::abs(in.volume) < std::abs(out.volume) && lies_inside(t, in.facets, out.facets);
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
  std::vector<std::int32_t> facets;
  for (const Shell* s : shells) facets.insert(facets.end(), s->facets.begin(), s->facets.end());
  std::sort(facets.begin(), facets.end());
  return plain_surface(subset(t, facets));
}

Result<void> repair(Triangles& t, double size, const SoupParams& params, Notes* notes,
                    const Progress& progress) {
  const std::size_t duplicate = drop_duplicates(t);
  if (duplicate > 0) note(notes, counted(duplicate, "duplicate facet") + " dropped.");
  const double tolerance = params.weld_tolerance * size;
  if (progress.cancelled()) return cancelled_error();
  weld_cracks(t, tolerance, notes);
  if (find_edge_defects(t).open > 0 && split_at_t_vertices(t, tolerance, notes) > 0) {
    drop_duplicates(t);
    weld_cracks(t, tolerance, notes);
  }
  if (progress.cancelled()) return cancelled_error();
  const EdgeDefects before = find_edge_defects(t);
  if (before.open + before.non_manifold == 0) return {};
  if (Result<Shells> oriented = orient(t, notes); !oriented) return oriented.error();
  if (before.non_manifold > 0) split_fans(t, kTouchGap * size, notes);
  if (before.open == 0) return {};
  if (Result<void> filled = fill_holes(t, params.hole_limit * size, notes); !filled)
    return filled.error();
  drop_duplicates(t);
  return {};
}

struct Prepared {
  Triangles triangles;
  std::vector<Shell> shells;
};

Result<Prepared> prepare(Triangles triangles, const SoupParams& params, Notes* notes,
                         const Progress& progress) {
  if (triangles.facets.empty()) return bad("the surface has no facet", "Export the part again.");
  for (const Vec<3>& p : triangles.points) {
    if (!p.allFinite()) {
      return bad("a coordinate is not a finite number", "The file is damaged; export it again.");
    }
  }
  const double size = diagonal_of(triangles.points);
  if (size == 0) return bad("all vertices are the same point", "Export the part again.");

  Prepared out;
  Triangles& t = out.triangles;
  t = std::move(triangles);
  progress.report(0.2);
  const std::size_t degenerate = drop_degenerate(t);
  if (degenerate > 0) note(notes, counted(degenerate, "degenerate facet") + " dropped.");
  if (params.repair) {
    if (Result<void> repaired = repair(t, size, params, notes, progress); !repaired)
      return repaired.error();
  }
  progress.report(0.5);
  if (progress.cancelled()) return cancelled_error();
  if (t.facets.empty()) return bad("the surface encloses no volume", "Export the part again.");

  const EdgeDefects defects = find_edge_defects(t);
  if (defects.open > 0) {
    return bad("the surface is not closed: " + counted(defects.open, "open edge") +
                   ", the first at " + place_text(defects.open_at) +
                   (defects.non_manifold > 0
                        ? ", and " + counted(defects.non_manifold, "non-manifold edge")
                        : ""),
               "Close the hole in the CAD program, or let the surface be repaired.");
  }
  if (defects.non_manifold > 0) {
    return bad("the surface is not manifold: more than two facets meet at " +
                   counted(defects.non_manifold, "edge") + ", the first at " +
                   place_text(defects.non_manifold_at),
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

Result<ReferenceSurface<3>> surface_from_soup(const TriangleSoup& soup, const SoupParams& params,
                                              Notes* notes, const Progress& progress) {
  Result<Prepared> prepared = prepare(merge_exact(soup), params, notes, progress);
  if (!prepared) return prepared.error();
  std::vector<const Shell*> all;
  for (const Shell& s : prepared->shells) all.push_back(&s);
  ReferenceSurface<3> surface = extract(prepared->triangles, all);
  find_features(surface, params.feature_angle);
  progress.report(1);
  return surface;
}

Result<std::vector<ReferenceSurface<3>>> surfaces_from_soup(const TriangleSoup& soup,
                                                            const SoupParams& params, Notes* notes,
                                                            const Progress& progress) {
  return surfaces_from_triangles(merge_exact(soup), params, notes, progress);
}

Result<std::vector<ReferenceSurface<3>>> surfaces_from_triangles(Triangles triangles,
                                                                 const SoupParams& params,
                                                                 Notes* notes,
                                                                 const Progress& progress) {
  Result<Prepared> prepared = prepare(std::move(triangles), params, notes, progress);
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
      return bad("the shells of the surface cross each other near " + place_text(s.low),
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

double facet_area(const ReferenceSurface<3>& surface, std::size_t facet) {
  const auto& f = surface.facets[facet];
  return 0.5 *
         facet_normal<3>({surface.points[f[0]], surface.points[f[1]], surface.points[f[2]]}).norm();
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
  DisjointSets patches(surface.facets.size());
  for (const auto& [f, g] : smooth) patches.join(f, g);
  surface.facet_face.assign(surface.facets.size(), -1);
  surface.faces.clear();
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    const std::int32_t r = patches.root(static_cast<std::int32_t>(f));
    if (surface.facet_face[r] < 0) {
      surface.facet_face[r] = static_cast<std::int32_t>(surface.faces.size());
      surface.faces.emplace_back();
    }
    surface.facet_face[f] = surface.facet_face[r];
  }

  surface.corners = kinks_of_features(surface);
}

std::vector<std::int32_t> kinks_of_features(const ReferenceSurface<3>& surface) {
  constexpr double kKink = 0.6;
  std::vector<std::vector<std::int32_t>> along(surface.points.size());
  for (const auto& edge : surface.feature_edges) {
    along[edge[0]].push_back(edge[1]);
    along[edge[1]].push_back(edge[0]);
  }
  std::vector<std::int32_t> kinks;
  for (std::size_t v = 0; v < along.size(); ++v) {
    if (along[v].empty()) continue;
    bool kink = along[v].size() != 2;
    if (!kink) {
      const Vec<3> in = surface.points[v] - surface.points[along[v][0]];
      const Vec<3> out = surface.points[along[v][1]] - surface.points[v];
      kink = std::atan2(in.cross(out).norm(), in.dot(out)) > kKink;
    }
    if (kink) kinks.push_back(static_cast<std::int32_t>(v));
  }
  return kinks;
}

}  // namespace lamella
