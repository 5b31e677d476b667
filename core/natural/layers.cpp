#include "core/natural/layers.h"

#include <limits>
#include <numeric>

#include "core/base/disjoint_sets.h"
#include "core/base/parallel.h"
#include "core/geometry/locator.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/element_locator.h"
#include "core/metric/metric.h"
#include "core/natural/medial_ball.h"

namespace lamella {
namespace {

constexpr double kParallel = 0.82;  // cosine of 35 degrees: walls less inclined are opposite
// Of the thickness: longer segments do not cross the wall. Walls inclined by 35 degrees come
// to 1.11.
constexpr double kThin = 1.15;
constexpr double kSampleSpacing = 0.02;  // of the diagonal, between places within a mesh

using Mesh = SimplexMesh<3>;

/// What lies behind each face of each element: element >= 0, or -1 - (index into `facets`), or
/// kOpen where no facet is listed.
struct Neighbors {
  static constexpr std::int32_t kOpen = std::numeric_limits<std::int32_t>::min();
  std::vector<std::array<std::int32_t, 4>> across;  ///< [element][opposite vertex]
  struct Owner {
    std::int32_t element = -1;
    int local = 0;
  };
  std::vector<Owner> owner;  ///< [facet] the element it bounds

  explicit Neighbors(const Mesh& mesh) {
    across.assign(mesh.elements.size(), {kOpen, kOpen, kOpen, kOpen});
    owner.resize(mesh.facets.size());
    std::vector<std::int32_t> sorted(mesh.facets.size());
    std::iota(sorted.begin(), sorted.end(), 0);
    const auto key = [&](std::int32_t f) {
      auto nodes = mesh.facets[f];
      std::sort(nodes.begin(), nodes.end());
      return nodes;
    };
    std::sort(sorted.begin(), sorted.end(),
              [&](std::int32_t a, std::int32_t b) { return key(a) < key(b); });
    const auto uses = face_uses<3>(mesh.elements, mesh.points.size());
    for_each_face<3>(uses, [&](std::size_t first, std::size_t last) {
      const auto& a = uses[first];
      if (last - first == 2) {
        const auto& b = uses[first + 1];
        across[a.element][a.local] = b.element;
        across[b.element][b.local] = a.element;
        return;
      }
      if (last - first != 1) return;
      const auto at = std::lower_bound(
          sorted.begin(), sorted.end(), a.nodes,
          [&](std::int32_t f, const std::array<NodeId, 3>& nodes) { return key(f) < nodes; });
      if (at == sorted.end() || key(*at) != a.nodes) return;
      across[a.element][a.local] = -1 - *at;
      owner[*at] = {a.element, static_cast<int>(a.local)};
    });
  }
};

/// A straight walk through the mesh.
struct Walk {
  std::vector<std::int32_t> crossed;
  double length = 0;        ///< mm
  double layers = 0;        ///< length in the metrics of the elements crossed
  std::int32_t facet = -1;  ///< of the boundary reached; -1: the walk failed or ended before
  bool whole = false;       ///< it came to the boundary of its body or to its end
};

/// From `origin` in the element, into which it came through the face opposite to vertex `entered`
/// (-1: it began inside), along the unit vector u. To the boundary of the body, or without regard
/// to bodies for `until` mm.
Walk walk(const Mesh& mesh, const Neighbors& neighbors, std::int32_t element, int entered,
          const Vec<3>& origin, const Vec<3>& u,
          double until = std::numeric_limits<double>::infinity()) {
  Walk w;
  const bool one_body = !std::isfinite(until) && !mesh.element_body.empty();
  const auto body = one_body ? mesh.element_body[element] : 0;
  double t = 0;
  // A line meets an element once; more steps than that means it runs along faces, in a circle.
  const std::size_t limit = 1000 + mesh.elements.size() / 8;
  while (w.crossed.size() < limit) {
    const auto& e = mesh.elements[element];
    double leave = std::numeric_limits<double>::infinity();
    int through = -1;
    for (int k = 0; k < 4; ++k) {
      if (k == entered) continue;
      const auto f = mesh.corners(opposite_facet<3>(e, k));
      const Vec<3> n = facet_normal<3>(f);
      const double rate = n.dot(u);
      if (!(rate > 0)) continue;
      const double s = n.dot(f[0] - origin) / rate;
      if (s < leave) {
        leave = s;
        through = k;
      }
    }
    if (through < 0) return w;
    leave = std::max(std::min(leave, until), t);
    if (leave > t) {
      // Flat elements have no metric; a line spends no length in them.
      const Vec<3> d = (leave - t) * u;
      const auto p = mesh.corners(e);
      if (signed_measure<3>(p) > 0) w.layers += metric_length<3>(d, simplex_metric<3>(p));
      t = leave;
    }
    w.crossed.push_back(element);
    if (t >= until) {
      w.length = t;
      w.whole = true;
      return w;
    }
    const auto next = neighbors.across[element][through];
    if (next == Neighbors::kOpen) return w;
    if (next < 0) {
      w.facet = -1 - next;
      w.length = t;
      w.whole = !std::isfinite(until);
      return w;
    }
    if (one_body && mesh.element_body[next] != body) return w;
    for (int k = 0; k < 4; ++k)
      if (neighbors.across[next][k] == element) entered = k;
    element = next;
  }
  return w;
}

struct Place {
  Vec<3> at = Vec<3>::Zero();
  bool opposite = false;  ///< the far wall faces this one
  bool thin = false;      ///< and the segment is the local thickness
  double layers = 0;
  double area = 0;
  std::array<std::int32_t, 3> corners{};  ///< of its facet: places that share one are neighbors
  std::vector<std::int32_t> crossed;
};

bool below(const Place& place, int asked) { return place.layers < asked - 1e-6; }

Place on_facet(const Mesh& mesh, std::size_t facet) {
  const auto corners = mesh.corners(mesh.facets[facet]);
  Place place;
  place.at = (corners[0] + corners[1] + corners[2]) / 3;
  place.corners = mesh.facets[facet];
  place.area = 0.5 * facet_normal<3>(corners).norm();
  return place;
}

Place measure(const Mesh& mesh, const Neighbors& neighbors, const Locator<3>& surface,
              std::int32_t facet) {
  Place place = on_facet(mesh, static_cast<std::size_t>(facet));
  if (neighbors.owner[facet].element < 0 || !(place.area > 0)) return place;
  const auto corners = mesh.corners(mesh.facets[facet]);
  const Vec<3>& center = place.at;
  const Vec<3> u = -facet_normal<3>(corners).normalized();

  // Structured meshes have edges exactly below a center: step aside when the line is caught there.
  const auto [element, entered] = neighbors.owner[facet];
  Walk w;
  for (int attempt = 0; attempt < 3 && w.facet < 0; ++attempt)
    w = walk(mesh, neighbors, element, entered,
             center + 0.01 * attempt * (corners[attempt % 3] - center) +
                 0.003 * attempt * (corners[(attempt + 1) % 3] - center),
             u);
  if (w.facet < 0) return place;
  const Vec<3> far = facet_normal<3>(mesh.corners(mesh.facets[w.facet])).normalized();
  place.opposite = far.dot(u) > kParallel;
  if (!place.opposite) return place;
  place.layers = w.layers;
  place.crossed = std::move(w.crossed);
  place.thin = w.length < kThin * 2 * climb_to_medial_ball(surface, center).radius;
  return place;
}

/// Inwards from a point on a facet of the surface of a body that the mesh fills and more.
Place measure_within(const Mesh& mesh, const Neighbors& neighbors,
                     const ElementLocator<3>& elements, const Locator<3>& surface,
                     std::int32_t facet, const Vec<3>& at) {
  Place place;
  place.at = at;
  const Vec<3> u = -surface.normal(facet);
  const double least = 1e-7 * surface.diagonal();
  const std::optional<RayHit> hit = surface.exit(at, u, least);
  if (!hit) return place;
  if (!(surface.normal(hit->facet).dot(u) > kParallel)) return place;
  const Located<3> start = elements.locate(at + least * u);
  if (!start.inside) return place;
  const Walk w = walk(mesh, neighbors, start.element, -1, at + least * u, u, hit->t - least);
  place.opposite = w.whole;
  if (!w.whole) return place;
  // The walk keeps off both walls by a little.
  place.layers = w.layers * hit->t / w.length;
  place.crossed = w.crossed;
  place.thin = hit->t < kThin * 2 * climb_to_medial_ball(surface, at).radius;
  return place;
}

/// Places below n that share a corner are one.
std::vector<PlaceBelow> places_below(const std::vector<Place>& places,
                                     const std::vector<std::int32_t>& counted, int asked,
                                     std::size_t corners) {
  DisjointSets together(corners);
  for (const auto p : counted)
    if (below(places[p], asked))
      for (const auto n : places[p].corners) together.join(places[p].corners[0], n);
  std::vector<std::int32_t> index(corners, -1);
  std::vector<PlaceBelow> found;
  for (const auto p : counted) {
    if (!below(places[p], asked)) continue;
    std::int32_t& i = index[together.root(places[p].corners[0])];
    if (i < 0) {
      i = static_cast<std::int32_t>(found.size());
      found.push_back({Vec<3>::Zero(), std::numeric_limits<double>::infinity(), 0});
    }
    found[i].area += places[p].area;
    if (places[p].layers >= found[i].layers) continue;
    found[i].layers = places[p].layers;
    found[i].at = places[p].at;
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const PlaceBelow& a, const PlaceBelow& b) { return a.area > b.area; });
  return found;
}

LayerStats statistics(const std::vector<Place>& places, const std::vector<std::int32_t>& counted,
                      int asked) {
  LayerStats stats;
  stats.places = counted.size();
  if (counted.empty()) return stats;
  auto order = counted;
  std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return places[a].layers < places[b].layers;
  });
  double total = 0, sum = 0, reached = 0;
  for (const auto i : order) {
    total += places[i].area;
    sum += places[i].area * places[i].layers;
    if (!below(places[i], asked)) reached += places[i].area;
  }
  const auto quantile = [&](double q) {
    double below = 0;
    for (const auto i : order)
      if ((below += places[i].area) >= q * total) return places[i].layers;
    return places[order.back()].layers;
  };
  stats.mean = sum / total;
  stats.p5 = quantile(0.05);
  stats.p50 = quantile(0.5);
  stats.p95 = quantile(0.95);
  stats.share_reached = reached / total;
  return stats;
}

/// What the places say, on the nodes of the elements they cross.
Layers layers_of(const Mesh& mesh, const std::vector<Place>& places, int asked, std::size_t corners,
                 bool corners_are_nodes, std::vector<std::int32_t>& counted) {
  // A body without any wall is measured right through.
  const bool any_thin =
      std::any_of(places.begin(), places.end(), [](const Place& p) { return p.thin; });
  for (std::size_t p = 0; p < places.size(); ++p)
    if (any_thin ? places[p].thin : places[p].opposite)
      counted.push_back(static_cast<std::int32_t>(p));
  Layers layers;
  layers.stats = statistics(places, counted, asked);
  layers.below = places_below(places, counted, asked, corners);
  std::vector<double> weight(mesh.points.size(), 0.0);
  layers.at_node.assign(mesh.points.size(), 0.0);
  const auto give = [&](NodeId node, double value) {
    layers.at_node[node] += value;
    weight[node] += 1;
  };
  for (const auto p : counted) {
    if (corners_are_nodes)
      for (const auto node : places[p].corners) give(node, places[p].layers);
    for (const auto e : places[p].crossed)
      for (const auto node : mesh.elements[e]) give(node, places[p].layers);
  }
  for (std::size_t i = 0; i < weight.size(); ++i)
    layers.at_node[i] =
        weight[i] > 0 ? layers.at_node[i] / weight[i] : std::numeric_limits<double>::quiet_NaN();
  return layers;
}

/// A point on a facet of a surface that stands for a part of its area.
struct Sample {
  std::int32_t facet = 0;
  Vec<3> at = Vec<3>::Zero();
  double area = 0;
};

/// The middles of the pieces of facets cut evenly until none is longer than `spacing`, one for each
/// `enough` of area: of small and of thin pieces one stands for those before it in the list.
std::vector<Sample> samples_of(const ReferenceSurface<3>& surface, double spacing) {
  std::vector<Sample> samples;
  const double enough = 0.4 * spacing * spacing;
  double waiting = 0;
  Sample last;
  const auto add = [&](std::size_t f, const Vec<3>& at, double area) {
    last = {static_cast<std::int32_t>(f), at, 0};
    waiting += area;
    if (waiting < enough) return;
    last.area = waiting;
    samples.push_back(last);
    waiting = 0;
  };
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    const auto& v = surface.facets[f];
    const std::array<Vec<3>, 3> p{surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]};
    const double area = 0.5 * facet_normal<3>(p).norm();
    if (!(area > 0)) continue;
    const double longest =
        std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
    const int cuts = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
    // Rows of upright pieces, and of those upside down between them.
    const Vec<3> a = (p[1] - p[0]) / cuts, b = (p[2] - p[0]) / cuts;
    for (int i = 0; i < cuts; ++i)
      for (int j = 0; i + j < cuts; ++j)
        for (const double third : {1.0, 2.0}) {
          if (third > 1 && i + j + 1 >= cuts) continue;
          add(f, p[0] + (i + third / 3) * a + (j + third / 3) * b, area / (cuts * cuts));
        }
  }
  if (waiting > 0) {
    last.area = waiting;
    samples.push_back(last);
  }
  return samples;
}

}  // namespace

Result<Layers> measure_layers(const SimplexMesh<3>& mesh, const ReferenceSurface<3>& surface,
                              int asked, int threads, const Progress& progress) {
  if (asked < 1) return Error{Code::usage, "The number of layers asked must be at least 1.", ""};
  const Locator<3> locator(surface);
  if (locator.empty())
    return Error{Code::bad_input, "The body has no surface to measure its walls on.", ""};
  const Neighbors neighbors(mesh);
  if (progress.cancelled()) return cancelled_error();

  std::vector<Place> places(mesh.facets.size());
  if (!parallel_each(places.size(), threads, progress, [&](std::size_t f) {
        places[f] = measure(mesh, neighbors, locator, static_cast<std::int32_t>(f));
      }))
    return cancelled_error();

  std::vector<std::int32_t> counted;
  Layers layers = layers_of(mesh, places, asked, mesh.points.size(), true, counted);
  layers.at_facet.assign(mesh.facets.size(), std::numeric_limits<double>::quiet_NaN());
  for (const auto f : counted) layers.at_facet[f] = places[f].layers;
  return layers;
}

Result<Layers> measure_boundary_layer(const SimplexMesh<3>& mesh,
                                      const std::vector<std::int32_t>& faces, double thickness,
                                      int asked, int threads, const Progress& progress) {
  if (asked < 1 || !(thickness > 0))
    return Error{Code::usage, "A boundary layer needs a thickness and one element at least.", ""};
  const Neighbors neighbors(mesh);
  std::vector<Place> places(mesh.facets.size());
  const auto measure_at = [&](std::size_t f) {
    if (!faces.empty() && std::count(faces.begin(), faces.end(), mesh.facet_face[f]) == 0) return;
    Place& place = places[f];
    place = on_facet(mesh, f);
    const auto [element, entered] = neighbors.owner[f];
    if (element < 0 || !(place.area > 0)) return;
    const Vec<3> u = -facet_normal<3>(mesh.corners(mesh.facets[f])).normalized();
    Walk w = walk(mesh, neighbors, element, entered, place.at, u, thickness);
    place.opposite = w.whole;
    place.layers = w.layers;
    place.crossed = std::move(w.crossed);
  };
  if (!parallel_each(places.size(), threads, progress, measure_at)) return cancelled_error();
  std::vector<std::int32_t> counted;
  return layers_of(mesh, places, asked, mesh.points.size(), true, counted);
}

Result<Layers> measure_layers_within(const SimplexMesh<3>& mesh, const ReferenceSurface<3>& surface,
                                     int asked, int threads, const Progress& progress,
                                     const std::function<bool(const Vec<3>&)>& inside) {
  if (asked < 1) return Error{Code::usage, "The number of layers asked must be at least 1.", ""};
  const Locator<3> locator(surface);
  if (locator.empty())
    return Error{Code::bad_input, "The body has no surface to measure its walls on.", ""};
  const Neighbors neighbors(mesh);
  const ElementLocator<3> elements(mesh, progress.portion(0, 0.2));
  if (progress.cancelled()) return cancelled_error();
  const std::vector<Sample> samples = samples_of(surface, kSampleSpacing * locator.diagonal());
  const double skin = 1e-6 * locator.diagonal();
  std::vector<Place> places(samples.size());
  if (!parallel_each(places.size(), threads, progress.portion(0.2, 1), [&](std::size_t s) {
        const Sample& sample = samples[s];
        if (inside && !inside(sample.at - skin * locator.normal(sample.facet))) return;
        places[s] = measure_within(mesh, neighbors, elements, locator, sample.facet, sample.at);
        places[s].area = sample.area;
        places[s].corners = surface.facets[sample.facet];
      }))
    return cancelled_error();
  std::vector<std::int32_t> counted;
  return layers_of(mesh, places, asked, surface.points.size(), false, counted);
}

}  // namespace lamella
