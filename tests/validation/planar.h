#pragma once

#include <limits>
#include <map>

#include "core/base/parallel.h"
#include "core/geometry/locator.h"
#include "core/natural/layer_stats.h"
#include "core/natural/medial_ball.h"
#include "core/natural/natural_metric.h"
#include "core/optimize/generate.h"

/// The natural metric and the ruler of layers in the plane. The geometric detector is made for
/// bodies: a plane figure is taken as the middle of a prism so long that its ends are out of sight,
/// and the metric of the plane is what the prism's measures within it.
namespace lamella {

/// Numbers the sides between corners, where neighbors turn by more than half a radian.
inline void find_corners(ReferenceSurface<2>& outline) {
  std::vector<std::array<std::int32_t, 2>> around(outline.points.size(), {-1, -1});
  for (std::size_t f = 0; f < outline.facets.size(); ++f) {
    around[outline.facets[f][0]][1] = static_cast<std::int32_t>(f);
    around[outline.facets[f][1]][0] = static_cast<std::int32_t>(f);
  }
  const auto direction = [&](std::int32_t f) -> Vec<2> {
    return (outline.points[outline.facets[f][1]] - outline.points[outline.facets[f][0]])
        .normalized();
  };
  for (std::size_t v = 0; v < around.size(); ++v)
    if (direction(around[v][0]).dot(direction(around[v][1])) < std::cos(0.5))
      outline.corners.push_back(static_cast<std::int32_t>(v));
  outline.facet_face.assign(outline.facets.size(), 0);
  std::int32_t face = 0;
  for (const std::int32_t corner : outline.corners) {
    std::int32_t f = around[corner][1];
    do {
      outline.facet_face[f] = face;
      f = around[outline.facets[f][1]][1];
    } while (
        !std::binary_search(outline.corners.begin(), outline.corners.end(), outline.facets[f][0]));
    ++face;
  }
  outline.faces.resize(static_cast<std::size_t>(face));
}

/// The closed polygon through points listed counterclockwise.
inline ReferenceSurface<2> polygon(const std::vector<Vec<2>>& points) {
  ReferenceSurface<2> outline;
  outline.points = points;
  const auto n = static_cast<std::int32_t>(points.size());
  // The outward normal of a segment lies on its left.
  for (std::int32_t i = n; i-- > 0;) outline.facets.push_back({(i + 1) % n, i});
  find_corners(outline);
  return outline;
}

/// Part of the segment from `a` to `b` in an element, as shares of its length; empty when the first
/// is not below the second.
template <int D>
std::pair<double, double> share_inside(const SimplexMesh<D>& mesh,
                                       const typename SimplexMesh<D>::Element& e, const Vec<D>& a,
                                       const Vec<D>& b) {
  double from = 0, to = 1;
  for (int k = 0; k <= D && from < to; ++k) {
    const auto f = mesh.corners(opposite_facet<D>(e, k));
    const Vec<D> n = facet_normal<D>(f);
    const double at = n.dot(a - f[0]), rate = n.dot(b - a);
    if (rate > 0)
      to = std::min(to, -at / rate);
    else if (rate < 0)
      from = std::max(from, -at / rate);
    else if (at > 0)
      to = from;
  }
  return {from, to};
}

/// Layers on the segment: its length in the elements' own metric, as `measure_layers` counts them.
/// NaN where the mesh does not cover it, or where it runs along faces and is covered twice.
template <int D>
double layers_between(const SimplexMesh<D>& mesh, const Vec<D>& a, const Vec<D>& b) {
  double layers = 0, covered = 0;
  const Vec<D> low = a.cwiseMin(b), high = a.cwiseMax(b);
  for (const auto& e : mesh.elements) {
    const auto p = mesh.corners(e);
    Vec<D> least = p[0], most = p[0];
    for (const Vec<D>& x : p) {
      least = least.cwiseMin(x);
      most = most.cwiseMax(x);
    }
    if ((least.array() > high.array()).any() || (most.array() < low.array()).any()) continue;
    const auto [from, to] = share_inside<D>(mesh, e, a, b);
    if (!(from < to)) continue;
    covered += to - from;
    layers += (to - from) * metric_length<D>(b - a, simplex_metric<D>(p));
  }
  return std::abs(covered - 1) < 0.02 ? layers : std::numeric_limits<double>::quiet_NaN();
}

/// The metric of the elements whose center `in` tells, as one: the inverse of the mean of M_T^-1
/// over their volume. Zero when there are none.
template <int D, class In>
Metric<D> own_metric(const SimplexMesh<D>& mesh, In&& in) {
  Mat<D> mean = Mat<D>::Zero();
  double volume = 0;
  for (const auto& e : mesh.elements) {
    const auto p = mesh.corners(e);
    Vec<D> center = Vec<D>::Zero();
    for (const Vec<D>& x : p) center += x / (D + 1);
    if (!in(center)) continue;
    mean += signed_measure<D>(p) * simplex_metric_inverse<D>(p);
    volume += signed_measure<D>(p);
  }
  return volume > 0 ? Metric<D>((mean / volume).inverse()) : Metric<D>(Metric<D>::Zero());
}

/// The natural metric of a plane figure.
class PlanarNatural {
 public:
  /// `half` is the half length of the prism: 20 times the largest radius at least. Errors: those of
  /// `generate`.
  static Result<PlanarNatural> make(const ReferenceSurface<2>& outline, double half) {
    Result<SimplexMesh<2>> mesh = generate<2>(outline);
    if (!mesh) return mesh.error();
    return PlanarNatural(outline, std::move(*mesh), half);
  }

  const ReferenceSurface<2>& outline() const { return outline_; }
  const SimplexMesh<2>& first_mesh() const { return mesh_; }

  MetricFunction<2> function(const NaturalParams& params) const {
    return [this, params](const Vec<2>& x) -> Metric<2> {
      return detector_.at(Vec<3>(x[0], x[1], 0), params).metric.topLeftCorner<2, 2>();
    };
  }
  MetricField<2> field(const SimplexMesh<2>& mesh, const NaturalParams& params) const {
    MetricField<2> metric(mesh.points.size(), Metric<2>::Identity());
    const auto at = function(params);
    parallel_each(mesh.node_count(), params.threads, {},
                  [&](std::size_t i) { metric[i + 1] = at(mesh.points[i + 1]); });
    return metric;
  }
  double thickness(const Vec<2>& x) const {
    return 2 * climb_to_medial_ball(space_, Vec<3>(x[0], x[1], 0)).radius;
  }
  /// Unit direction across the wall.
  Vec<2> across(const Vec<2>& x) const {
    return detector_.at(Vec<3>(x[0], x[1], 0), {}).direction.head<2>().normalized();
  }

  /// Layers measured back from the middle of each boundary edge, as `measure_layers` does in space.
  LayerStats measure(const SimplexMesh<2>& mesh, int asked) const {
    struct Place {
      double layers, length;
    };
    std::vector<Place> places(mesh.facets.size());
    parallel_each(places.size(), 0, {}, [&](std::size_t f) {
      const auto p = mesh.corners(mesh.facets[f]);
      const Vec<2> u = -facet_normal<2>(p).normalized(), center = (p[0] + p[1]) / 2;
      places[f] = {std::numeric_limits<double>::quiet_NaN(), (p[1] - p[0]).norm()};
      const auto hit = plane_.exit(center, u, 1e-6);
      if (!hit || plane_.normal(hit->facet).dot(u) < 0.82) return;
      if (hit->t > 1.15 * thickness(center)) return;
      const Vec<2> aside = 0.017 * (p[1] - p[0]);
      places[f].layers = layers_between<2>(mesh, center + aside, center + aside + hit->t * u);
    });
    std::erase_if(places, [](const Place& p) { return std::isnan(p.layers); });
    std::sort(places.begin(), places.end(),
              [](const Place& a, const Place& b) { return a.layers < b.layers; });
    LayerStats stats;
    stats.places = places.size();
    double total = 0, below = 0;
    for (const Place& p : places) total += p.length;
    for (const Place& p : places) {
      stats.mean += p.layers * p.length / total;
      if (p.layers >= asked - 1e-6) stats.share_reached += p.length / total;
      const double before = below / total;
      below += p.length;
      for (const auto& [q, value] :
           {std::pair{0.05, &stats.p5}, {0.5, &stats.p50}, {0.95, &stats.p95}})
        if (before < q && below / total >= q) *value = p.layers;
    }
    return stats;
  }

 private:
  PlanarNatural(const ReferenceSurface<2>& outline, SimplexMesh<2> mesh, double half)
      : outline_(outline),
        mesh_(std::move(mesh)),
        plane_(outline),
        space_(prism(outline, mesh_, half)),
        detector_(prism(outline, mesh_, half)) {}

  static ReferenceSurface<3> prism(const ReferenceSurface<2>& outline, const SimplexMesh<2>& mesh,
                                   double half) {
    ReferenceSurface<3> s;
    const auto n = static_cast<std::int32_t>(mesh.node_count());
    for (const double z : {-half, half})
      for (std::int32_t i = 1; i <= n; ++i)
        s.points.push_back({mesh.points[i][0], mesh.points[i][1], z});
    for (const auto& e : mesh.elements) {
      s.facets.push_back({e[0] - 1, e[2] - 1, e[1] - 1});
      s.facets.push_back({n + e[0] - 1, n + e[1] - 1, n + e[2] - 1});
    }
    for (const auto& f : outline.facets) {
      s.facets.push_back({f[0], n + f[0], n + f[1]});
      s.facets.push_back({f[0], n + f[1], f[1]});
    }
    s.facet_face.assign(s.facets.size(), 0);
    s.faces.resize(1);
    return s;
  }

  ReferenceSurface<2> outline_;
  SimplexMesh<2> mesh_;
  Locator<2> plane_;
  Locator<3> space_;
  NaturalDetector detector_;
};

}  // namespace lamella
