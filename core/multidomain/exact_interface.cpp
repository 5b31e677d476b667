#include "core/multidomain/exact_interface.h"

#include <algorithm>
#include <map>
#include <optional>

#include "core/base/parallel.h"
#include "core/geometry/locator.h"
#include "core/geometry/soup.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/boundary.h"
#include "core/mesh/element_locator.h"
#include "core/mesh/quality.h"
#include "core/multidomain/chord_metric.h"
#include "core/multidomain/hold.h"
#include "core/multidomain/interface_cut.h"

namespace lamella {
namespace {

/// Of the chord tolerance: what the straight pieces of a curve may take.
constexpr double curve_share = 0.1;
/// A facet must not look away from the CAD face it is put on.
constexpr double face_turn = 0.4;
/// Adaptions before the cut, and growth of the node count that calls for another.
constexpr int refinements = 2;
constexpr double grown = 1.2;
/// Growth of the metric's determinant that calls for a finer mesh before it is cut.
constexpr double finer_share = 1.5;
/// Of the tolerance: what chords are asked for. Of the distance from what is curved: how sizes
/// along it grow.
constexpr double chord_share = 0.6;
constexpr double chord_growth = 0.7;
/// Quality below which the background is refined and cut again, to this share of the sizes, how
/// often at most and in a row without a gain, and the share of poor elements that is too many for
/// it.
constexpr double poor_quality = 0.2;
constexpr double recut_size = 0.6;
constexpr int recuts = 8, idle_recuts = 4;
constexpr double many_poor = 0.03;

std::int32_t face_count(const std::vector<std::int32_t>& facet_face) {
  std::int32_t faces = 0;
  for (std::int32_t f : facet_face) faces = std::max(faces, f + 1);
  return faces;
}

/// Adds a surface behind the others, its faces numbered from `face` on.
void append(ReferenceSurface<3>& all, const ReferenceSurface<3>& s, std::int32_t face) {
  const auto shift = static_cast<std::int32_t>(all.points.size());
  all.points.insert(all.points.end(), s.points.begin(), s.points.end());
  for (auto f : s.facets) {
    for (auto& v : f) v += shift;
    all.facets.push_back(f);
  }
  for (auto f : s.facet_face) all.facet_face.push_back(f + face);
  for (const auto& e : s.feature_edges) all.feature_edges.push_back({e[0] + shift, e[1] + shift});
  for (auto c : s.corners) all.corners.push_back(c + shift);
  all.faces.resize(static_cast<std::size_t>(face_count(all.facet_face)));
  for (std::size_t f = 0; f < s.faces.size() && face + f < all.faces.size(); ++f)
    all.faces[face + f] = s.faces[f];
}

using Edge = std::array<std::int32_t, 2>;

/// The facets around each edge.
std::map<Edge, std::vector<std::size_t>> edges_of(
    const std::vector<std::array<NodeId, 3>>& facets) {
  std::map<Edge, std::vector<std::size_t>> edges;
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(facets[f][k], facets[f][(k + 1) % 3]);
      edges[{a, b}].push_back(f);
    }
  return edges;
}

/// The boundary of the mesh with its edges: between faces, groups, and where facets meet at an
/// angle.
ReferenceSurface<3> wall_of(const SimplexMesh<3>& mesh, double feature_angle) {
  ReferenceSurface<3> s = surface_of_facets(mesh);
  const auto normal = [&](std::size_t f) {
    return facet_normal<3>(mesh.corners(mesh.facets[f])).normalized().eval();
  };
  for (const auto& [e, around] : edges_of(s.facets)) {
    const std::size_t a = around.front(), b = around.back();
    if (around.size() != 2 || mesh.facet_face[a] != mesh.facet_face[b] ||
        mesh.facet_group[a] != mesh.facet_group[b] ||
        normal(a).dot(normal(b)) < std::cos(feature_angle))
      s.feature_edges.push_back(e);
  }
  s.corners = kinks_of_features(s);
  return s;
}

class Finish {
 public:
  Finish(const SimplexMesh<3>& original, const Partition<3>& partition,
         const std::vector<ReferenceSurface<3>>& surfaces, CutMesh& cut, double tolerance,
         double feature_angle)
      : original_(original),
        partition_(partition),
        surfaces_(surfaces),
        cut_(cut),
        tolerance_(tolerance),
        feature_angle_(feature_angle) {}

  /// `wall`: the boundary of the domain, null where the mesh knows it best. `first_face` gets the
  /// number of the first face of each region.
  ReferenceSurface<3> run(const ReferenceSurface<3>* wall, std::vector<std::int32_t>& first_face) {
    find_sides();
    ReferenceSurface<3> all = wall ? *wall : wall_of(original_, feature_angle_);
    std::int32_t base = std::max(face_count(original_.facet_face), face_count(all.facet_face));
    for (int z = 0; z < partition_.background(); ++z) {
      first_face.push_back(base);
      const ReferenceSurface<3>* s = &surfaces_[z];
      ReferenceSurface<3> own;
      if (s->facets.empty()) {
        std::vector<std::size_t> cut_out;
        for (std::size_t i = 0; i < sides_.size(); ++i)
          if (sides_[i][0] == z) cut_out.push_back(cut_.outer + i);
        own = surface_of_facets(cut_.mesh, cut_out);
        s = &own;
      }
      if (s->facets.empty()) continue;
      put_on_faces(z, *s, base);
      append(all, *s, base);
      base += face_count(s->facet_face);
    }
    add_curves(all);
    return all;
  }

 private:
  /// Regions on both sides of the interfaces; each pair is a group.
  void find_sides() {
    SimplexMesh<3>& mesh = cut_.mesh;
    std::map<std::array<NodeId, 3>, std::size_t> index;
    for (std::size_t f = cut_.outer; f < mesh.facets.size(); ++f) {
      auto nodes = mesh.facets[f];
      std::sort(nodes.begin(), nodes.end());
      index[nodes] = f - cut_.outer;
    }
    sides_.resize(index.size());
    const auto uses = face_uses<3>(mesh.elements, mesh.points.size());
    for_each_face<3>(uses, [&](std::size_t first, std::size_t last) {
      if (last - first != 2) return;
      const auto it = index.find(uses[first].nodes);
      if (it == index.end()) return;
      const auto [low, high] = std::minmax(mesh.element_body[uses[first].element],
                                           mesh.element_body[uses[first + 1].element]);
      sides_[it->second] = {low, high};
    });
    std::map<Edge, std::int32_t> groups;
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      const auto [it, added] =
          groups.try_emplace(sides_[i], static_cast<std::int32_t>(mesh.groups.size()));
      if (added) mesh.groups.push_back(mesh.bodies[sides_[i][0]] + "|" + mesh.bodies[sides_[i][1]]);
      mesh.facet_group[cut_.outer + i] = it->second;
    }
  }

  /// The CAD faces of the interfaces that a zone has cut.
  void put_on_faces(int zone, const ReferenceSurface<3>& s, std::int32_t base) {
    SimplexMesh<3>& mesh = cut_.mesh;
    const Locator<3> locator(s);
    parallel_each(sides_.size(), 0, {}, [&](std::size_t i) {
      if (sides_[i][0] != zone) return;
      const std::size_t f = cut_.outer + i;
      const auto p = mesh.corners(mesh.facets[f]);
      const Vec<3> center = (p[0] + p[1] + p[2]) / 3;
      const Vec<3> normal = facet_normal<3>(p).normalized();
      const auto at = locator.nearest(center);
      std::int32_t on = at->facet;
      if (locator.normal(on).dot(normal) < face_turn) {
        std::vector<Nearest<3>> near;
        locator.all_within(center, 2 * std::sqrt(at->distance2) + tolerance_, near);
        for (const Nearest<3>& n : near)
          if (locator.normal(n.facet).dot(normal) >= face_turn) {
            on = n.facet;
            break;
          }
      }
      mesh.facet_face[f] = base + s.facet_face[on];
    });
  }

  /// The edges where interfaces meet each other or the boundary, as lines on all of them.
  void add_curves(ReferenceSurface<3>& all) const {
    const SimplexMesh<3>& mesh = cut_.mesh;
    std::vector<Edge> known(cut_.features.begin(), cut_.features.end());
    std::sort(known.begin(), known.end());
    std::vector<std::int32_t> where(mesh.points.size(), -1);
    const auto vertex = [&](NodeId n) {
      if (where[n] < 0) {
        where[n] = static_cast<std::int32_t>(all.points.size());
        all.points.push_back(mesh.points[n]);
      }
      return where[n];
    };
    for (const auto& edge : edges_of(mesh.facets)) {
      const auto& e = edge.first;
      const auto& around = edge.second;
      const bool differ = std::any_of(around.begin(), around.end(), [&](std::size_t f) {
        return mesh.facet_group[f] != mesh.facet_group[around[0]];
      });
      const bool inner =
          std::any_of(around.begin(), around.end(), [&](std::size_t f) { return f >= cut_.outer; });
      if (!differ || !inner || std::binary_search(known.begin(), known.end(), e)) continue;
      Hold hold;
      hold.origin = mesh.points[e[0]];
      for (std::size_t f : around) {
        if (f < cut_.outer) {
          hold.add_plane(facet_normal<3>(mesh.corners(mesh.facets[f])));
        } else {
          hold.add_zone(sides_[f - cut_.outer][0]);
        }
      }
      draw(hold, vertex(e[0]), vertex(e[1]), 6, all);
    }
  }

  /// The curve between two of its points.
  void draw(const Hold& hold, std::int32_t a, std::int32_t b, int depth,
            ReferenceSurface<3>& all) const {
    const Vec<3> middle = 0.5 * (all.points[a] + all.points[b]);
    const double length = (all.points[b] - all.points[a]).norm();
    const auto on =
        depth > 0 ? hold.settle(partition_, middle, 0.01 * tolerance_) : std::optional<Vec<3>>{};
    const double off = on ? (*on - middle).norm() : 0;
    if (off <= curve_share * tolerance_ || off > 0.4 * length) {
      all.feature_edges.push_back({a, b});
      return;
    }
    const auto m = static_cast<std::int32_t>(all.points.size());
    all.points.push_back(*on);
    draw(hold, a, m, depth - 1, all);
    draw(hold, m, b, depth - 1, all);
  }

  const SimplexMesh<3>& original_;
  const Partition<3>& partition_;
  const std::vector<ReferenceSurface<3>>& surfaces_;
  CutMesh& cut_;
  double tolerance_, feature_angle_;
  std::vector<Edge> sides_;  ///< [facet behind the outer ones] regions, the lower first
};

struct Ball {
  Vec<3> center;
  double radius;
};

/// Elements below the quality wanted.
struct Poor {
  std::vector<Ball> places;
  double shortage = 0;  ///< by what they fall short of it, all together
};

Poor poor_elements(const Exact& made) {
  Poor poor;
  const std::vector<double> quality = element_qualities<3>(made.mesh, made.metric);
  for (std::size_t e = 0; e < quality.size(); ++e) {
    if (quality[e] >= poor_quality) continue;
    const Corners<3> p = made.mesh.corners(made.mesh.elements[e]);
    const Vec<3> center = (p[0] + p[1] + p[2] + p[3]) / 4;
    double radius = 0;
    for (const Vec<3>& x : p) radius = std::max(radius, (x - center).norm());
    poor.places.push_back({center, radius});
    poor.shortage += poor_quality - quality[e];
  }
  return poor;
}

/// What one mesh of the domain is cut with, as often as it takes.
struct Cutting {
  const Partition<3>& partition;
  const std::vector<ReferenceSurface<3>>& surfaces;
  const CutParams& cut_params;
  const AdaptParams& adapt_params;
  const ReferenceSurface<3>* wall;
  const MetricFunction<3>& metric_at;  ///< may be empty

  /// The mesh cut along the borders, and adapted with them held, in the metric of its nodes: what
  /// the cut has spoiled shows, and no place is asked.
  Result<Exact> cut(const Adapted<3>& background, const Progress& progress) const {
    Result<CutMesh> cut = cut_interfaces(background.mesh, background.metric, partition, surfaces,
                                         cut_params, progress.portion(0, 0.3), {});
    if (!cut) return cut.error();
    Exact out;
    out.snapped = cut->snapped;
    out.added = cut->added;
    out.lost = cut->lost;
    out.surface = Finish(background.mesh, partition, surfaces, *cut, cut_params.tolerance,
                         adapt_params.feature_angle)
                      .run(wall, out.first_face);
    return held(std::move(out), cut->mesh, cut->metric, {}, progress.portion(0.3, 1));
  }

  /// Adapts a mesh that was cut, its interfaces held on `out.surface`.
  Result<Exact> held(Exact out, const SimplexMesh<3>& mesh, const MetricField<3>& metric,
                     const MetricFunction<3>& asked_at, const Progress& progress) const {
    Result<Adapted<3>> adapted =
        adapt<3>(mesh, metric, &out.surface, adapt_params, progress, asked_at);
    if (!adapted) return adapted.error();
    out.mesh = std::move(adapted->mesh);
    out.metric = std::move(adapted->metric);
    out.adapt = adapted->report;
    return out;
  }

  /// Adapts the background anew at these places, to smaller sizes, and leaves the rest as it is.
  Result<void> refine(Adapted<3>& background, const std::vector<Ball>& places,
                      const Progress& progress) const {
    const auto finer = [&](const Vec<3>& x) {
      double most = 1;
      for (const Ball& b : places) {
        const double out = (x - b.center).norm() / b.radius - 1;  // radii out of the ball
        most = std::max(most, 1 + (1 / recut_size - 1) * std::clamp(1 - out, 0.0, 1.0));
      }
      return most * most;
    };
    SimplexMesh<3> mesh = background.mesh;
    MetricField<3> metric = background.metric;
    std::vector<char> near(mesh.points.size(), 0);
    if (!parallel_each(mesh.node_count(), adapt_params.threads, progress.portion(0, 0.1),
                       [&](std::size_t i) {
                         const double share = finer(mesh.points[i + 1]);
                         near[i + 1] = share > 1;
                         metric[i + 1] *= share;
                       }))
      return cancelled_error();
    // Where elements are larger than what is poor none of their nodes may be near.
    const ElementLocator<3> locator(mesh, progress.portion(0.1, 0.2));
    if (progress.cancelled()) return cancelled_error();
    for (const Ball& b : places)
      for (NodeId n : mesh.elements[locator.locate(b.center).element]) near[n] = 1;
    AdaptParams local = adapt_params;
    mesh.bodies = {"near", "held"};
    local.frozen_bodies = {1};
    for (std::size_t e = 0; e < mesh.elements.size(); ++e)
      mesh.element_body[e] = std::none_of(mesh.elements[e].begin(), mesh.elements[e].end(),
                                          [&](NodeId n) { return near[n] != 0; });
    MetricFunction<3> finer_at;
    if (metric_at) finer_at = [&](const Vec<3>& x) -> Metric<3> { return metric_at(x) * finer(x); };
    Result<Adapted<3>> made =
        adapt<3>(mesh, metric, wall, local, progress.portion(0.2, 1), finer_at);
    if (!made) return made.error();
    if (made->report.cancelled) return cancelled_error();
    made->mesh.bodies = background.mesh.bodies;
    std::fill(made->mesh.element_body.begin(), made->mesh.element_body.end(), 0);
    background = std::move(*made);
    return {};
  }
};

}  // namespace

Result<Exact> exact_interfaces(const SimplexMesh<3>& mesh, const MetricField<3>& metric,
                               const Partition<3>& partition,
                               const std::vector<ReferenceSurface<3>>& surfaces,
                               const ExactParams& params, const Progress& progress,
                               const MetricFunction<3>& metric_at) {
  if (mesh.elements.empty() || mesh.facets.empty())
    return Error{Code::bad_input, "The mesh to cut has no elements or no boundary facets.",
                 "Adapt a mesh of the whole domain to the interfaces first."};
  if (surfaces.size() != static_cast<std::size_t>(partition.background()))
    return Error{Code::bad_input,
                 "There are " + std::to_string(surfaces.size()) + " surfaces for " +
                     std::to_string(partition.background()) + " regions.",
                 "Give one surface for each region, without facets where there is none."};
  if (!metric_at)
    if (Result<void> good = check_metric<3>(metric, mesh.node_count()); !good) return good.error();
  AdaptParams adapt_params = params.adapt;
  if (!adapt_params.chord_tolerance) {
    Box<3> box;
    for (std::size_t n = 1; n < mesh.points.size(); ++n) box.add(mesh.points[n]);
    adapt_params.chord_tolerance = 1e-3 * (box.hi - box.lo).norm();
  }
  CutParams cut_params;
  cut_params.tolerance = *adapt_params.chord_tolerance;
  cut_params.snap = params.snap;
  cut_params.chord_error = params.chord_error;
  cut_params.threads = adapt_params.threads;
  const double tolerance = cut_params.tolerance;
  const auto field = std::make_shared<const ChordField>(
      partition, surfaces,
      ChordParams{chord_share * tolerance, chord_growth, 0, adapt_params.threads},
      progress.portion(0, 0.02));
  if (progress.cancelled()) return cancelled_error();
  MetricFunction<3> chords_at;
  if (metric_at) chords_at = [&](const Vec<3>& x) { return field->at(metric_at(x), x); };
  MetricField<3> chords(mesh.points.size(), Metric<3>::Identity());
  std::vector<char> finer(mesh.points.size(), 0);
  if (!parallel_each(mesh.node_count(), adapt_params.threads, progress.portion(0.02, 0.05),
                     [&](std::size_t i) {
                       const Vec<3>& x = mesh.points[i + 1];
                       const Metric<3> m = metric_at ? metric_at(x) : metric[i + 1];
                       chords[i + 1] = field->at(m, x);
                       finer[i + 1] = chords[i + 1].determinant() > finer_share * m.determinant();
                     }))
    return cancelled_error();
  // Bodies that elements are counted to so far have borders in steps, which must not be held.
  SimplexMesh<3> whole = mesh;
  whole.bodies = {partition.names().back()};
  std::fill(whole.element_body.begin(), whole.element_body.end(), 0);
  const bool stepped = whole.element_body != mesh.element_body;
  // Chords that are too long are made short before there is an interface to be held; a mesh that
  // is much too coarse is refined again.
  std::optional<Adapted<3>> refined;
  const bool any = stepped || std::count(finer.begin(), finer.end(), 1) > 0;
  for (int i = 0; any && i < refinements; ++i) {
    const SimplexMesh<3>& from = refined ? refined->mesh : whole;
    const auto before = static_cast<double>(from.node_count());
    Result<Adapted<3>> r =
        adapt<3>(from, refined ? refined->metric : chords, params.wall, adapt_params,
                 progress.portion(0.05 + 0.2 * i, 0.25 + 0.2 * i), chords_at);
    if (!r) return r.error();
    if (r->report.cancelled) return cancelled_error();
    refined = std::move(*r);
    if (static_cast<double>(refined->mesh.node_count()) < grown * before) break;
  }
  Adapted<3> background;
  if (refined) {
    background = std::move(*refined);
  } else {
    background.mesh = std::move(whole);
    background.metric = std::move(chords);
  }
  const Cutting cutting{partition, surfaces, cut_params, adapt_params, params.wall, chords_at};
  Result<Exact> best = cutting.cut(background, progress.portion(0.4, 0.5));
  if (!best) return best.error();
  Poor poor = poor_elements(*best);
  for (int i = 0, idle = 0; !best->adapt.cancelled && i < recuts && idle < idle_recuts; ++i) {
    const Progress again = progress.portion(0.5 + 0.25 * i / recuts, 0.5 + 0.25 * (i + 1) / recuts);
    if (poor.places.empty() || static_cast<double>(poor.places.size()) >
                                   many_poor * static_cast<double>(best->mesh.elements.size()))
      break;
    const Result<void> ready = cutting.refine(background, poor.places, again.portion(0, 0.2));
    Result<Exact> next = ready ? cutting.cut(background, again.portion(0.2, 1)) : ready.error();
    best->adapt.cancelled = next ? next->adapt.cancelled : next.error().code == Code::cancelled;
    // What fails here, for want of memory, leaves a mesh that is complete.
    if (!next || best->adapt.cancelled) break;
    Poor left = poor_elements(*next);
    ++idle;
    if (left.shortage >= poor.shortage) continue;
    idle = 0;
    poor = std::move(left);
    best = std::move(next);
  }
  if (!best->adapt.cancelled && chords_at) {
    const SimplexMesh<3> cut = std::move(best->mesh);
    best = cutting.held(std::move(*best), cut, {}, chords_at, progress.portion(0.75, 1));
    if (!best) return best.error();
  }
  best->chords = field;
  progress.report(1);
  return best;
}

}  // namespace lamella
