#include "core/multidomain/chord_metric.h"

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "core/metric/intersect.h"
#include "core/multidomain/feature_chains.h"

namespace lamella {
namespace {

/// Of the tolerance: what the middle of an edge takes; the middle of a facet takes more.
constexpr double edge_share = 0.5;
/// Of a step along the border: how far it may rise for the border to be a parabola.
constexpr double parabola = 0.08;
/// Cosine between normals a step apart below which there is an edge between.
constexpr double sharp_turn = 0.85;
/// Of the whole: details are smaller. Of the tolerance: straight pieces of their edges.
constexpr double detail_share = 0.05;
constexpr double detail_chord = 0.2;
/// Of the whole: what is flatter than this counts as flat.
constexpr double flat_share = 0.3;

using Curved = ChordField::Curved;

/// How long chords of a border may be around a point of it; nothing where it has an edge.
std::optional<Curved> chords_of(const Zone<3>& zone, const Vec<3>& foot, const Vec<3>& normal,
                                double largest, double tolerance) {
  Mat<3> axes;
  axes.col(2) = normal;
  axes.col(0) = normal.unitOrthogonal();
  axes.col(1) = normal.cross(axes.col(0));
  // The second fundamental form from how the border falls off on both sides in four directions.
  constexpr int directions = 4;
  double h = largest;
  std::array<double, directions> fall{};  // kappa h^2 / 8
  bool smooth = false;
  for (int i = 0; i < 12 && !smooth; ++i) {
    if (i > 0) h *= 0.6;
    smooth = true;
    double most = 0;
    for (int k = 0; k < directions; ++k) {
      const double angle = std::numbers::pi * k / directions;
      const Vec<3> t = std::cos(angle) * axes.col(0) + std::sin(angle) * axes.col(1);
      fall[k] = 0;
      for (double side : {-0.5, 0.5}) {
        const ZoneDistance<3> d = zone.at(foot + side * h * t);
        fall[k] += 0.5 * d.distance;
        most = std::max(most, std::abs(d.distance));
        smooth = smooth && d.normal.dot(normal) >= sharp_turn;
      }
    }
    smooth = smooth && most <= parabola * h;
  }
  if (!smooth) return std::nullopt;  // on an edge
  // Least squares of a cos^2 + 2 b cos sin + c sin^2 over the directions.
  const double mean = (fall[0] + fall[1] + fall[2] + fall[3]) / 4;
  const double half = (fall[0] - fall[2]) / 2, cross = (fall[1] - fall[3]) / 2;
  Mat<2> form;
  form << mean + half, cross, cross, mean - half;
  const Spectrum<2> principal = spectrum<2>(form);
  Curved out;
  out.normal = normal;
  for (int k = 0; k < 2; ++k) {
    const double most = std::abs(principal.values[k]);
    out.direction[k] = axes.leftCols<2>() * principal.vectors.col(k);
    out.size[k] = most > 0 ? h * std::sqrt(edge_share * tolerance / most)
                           : std::numeric_limits<double>::infinity();
  }
  if (out.size[1] < out.size[0]) {
    std::swap(out.size[0], out.size[1]);
    std::swap(out.direction[0], out.direction[1]);
  }
  return out;
}

/// Whether more than half of what is around the middle of an edge is inside of the zone.
bool reentrant(const Zone<3>& zone, const Vec<3>& p, const Vec<3>& q, double tolerance) {
  constexpr int around = 16;
  const Vec<3> u = (q - p).unitOrthogonal(), v = (q - p).normalized().cross(u);
  int inside = 0;
  for (int k = 0; k < around; ++k) {
    const double angle = 2 * std::numbers::pi * (k + 0.5) / around;
    const Vec<3> x = 0.5 * (p + q) + tolerance * (std::cos(angle) * u + std::sin(angle) * v);
    inside += zone.distance(x) < 0;
  }
  return inside > around / 2 + 1;
}

}  // namespace

Metric<3> Curved::at(const Metric<3>& metric, double distance, double growth) const {
  const double none = 1e3 / std::sqrt(spectrum<3>(metric).values[0]);
  // Across the border no farther than where the size along it is 2.5 times as large.
  const double across = std::min(none, 1.5 * size[0] / growth + distance);
  Metric<3> chords = eigenvalue_from_size(across) * normal * normal.transpose();
  bool asks = false;
  for (int k = 0; k < 2; ++k) {
    const double along = std::min(none, size[k] + growth * distance);
    asks = asks || metric_length<3>(direction[k], metric) * along < 1;
    chords += eigenvalue_from_size(along) * direction[k] * direction[k].transpose();
  }
  return asks ? intersect<3>(metric, chords) : metric;
}

void ChordField::Level::add(const std::array<Vec<3>, 3>& facet, const Curved& asked) {
  const auto first = static_cast<std::int32_t>(surface.points.size());
  surface.points.insert(surface.points.end(), facet.begin(), facet.end());
  surface.facets.push_back({first, first + 1, first + 2});
  surface.facet_face.push_back(0);
  curved.push_back(asked);
}

void ChordField::add_details(const ReferenceSurface<3>& surface, const Partition<3>& partition,
                             const Zone<3>& zone, const ChordParams& params, double largest,
                             const Progress& progress, Levels& levels) {
  const double tolerance = params.tolerance;
  // Pieces of the chains, as slim facets that a locator can hold.
  struct Piece {
    std::array<Vec<3>, 3> facet;
    std::size_t chain;
  };
  const auto chains = feature_chains(surface, detail_chord * tolerance);
  std::vector<Piece> pieces;
  std::vector<double> length(chains.size());
  std::vector<std::array<Vec<3>, 2>> ends(chains.size());
  ReferenceSurface<3> slim;
  slim.faces.resize(1);
  for (std::size_t c = 0; c < chains.size(); ++c) {
    ends[c] = {chains[c].front(), chains[c].back()};
    for (std::size_t k = 0; k + 1 < chains[c].size(); ++k) {
      const Vec<3>&a = chains[c][k], &b = chains[c][k + 1];
      length[c] += (b - a).norm();
      const int cuts = std::clamp(static_cast<int>((b - a).norm() / largest), 1, 64);
      for (int i = 0; i < cuts; ++i) {
        const Vec<3> p = a + (b - a) * i / cuts, q = a + (b - a) * (i + 1) / cuts;
        const Vec<3> aside = 1e-3 * (q - p).norm() * (q - p).unitOrthogonal();
        pieces.push_back({{p, q, 0.5 * (p + q) + aside}, c});
        const auto first = static_cast<std::int32_t>(slim.points.size());
        slim.points.insert(slim.points.end(), {p, q, 0.5 * (p + q) + aside});
        slim.facets.push_back({first, first + 1, first + 2});
        slim.facet_face.push_back(0);
      }
    }
    // Around, three edges are the least.
    if ((ends[c][0] - ends[c][1]).norm() <= 1e-9 * length[c]) length[c] /= 3;
  }
  if (pieces.empty()) return;
  const Locator<3> locator(slim);
  const auto meet = [&](std::size_t c, std::size_t d) {
    if (c == d) return true;
    for (const Vec<3>& p : ends[c])
      for (const Vec<3>& q : ends[d])
        if ((p - q).norm() <= tolerance) return true;
    return false;
  };
  std::vector<char> hollow(pieces.size(), 0);
  if (params.between_reentrant < 1 &&
      !parallel_each(pieces.size(), params.threads, progress.portion(0, 0.4), [&](std::size_t i) {
        hollow[i] = reentrant(zone, pieces[i].facet[0], pieces[i].facet[1], tolerance);
      }))
    return;
  std::vector<std::optional<Curved>> found(pieces.size());
  parallel_each(pieces.size(), params.threads, progress.portion(0.4, 1), [&](std::size_t i) {
    const auto& [facet, chain] = pieces[i];
    const Vec<3> middle = 0.5 * (facet[0] + facet[1]);
    if (partition.border(middle).distance > 0.1 * tolerance) return;  // hidden
    std::vector<Nearest<3>> near;
    locator.all_within(middle, largest, near);
    Curved asked;
    asked.direction[0] = (facet[1] - facet[0]).normalized();
    asked.direction[1] = asked.direction[0].unitOrthogonal();
    asked.size = {length[chain], std::numeric_limits<double>::infinity()};
    for (const Nearest<3>& n : near) {
      if (meet(chain, pieces[static_cast<std::size_t>(n.facet)].chain)) continue;
      Vec<3> across = n.point - middle;
      across -= across.dot(asked.direction[0]) * asked.direction[0];
      double width = across.norm();
      if (!(width > tolerance)) continue;
      if (hollow[i] && hollow[static_cast<std::size_t>(n.facet)]) width *= params.between_reentrant;
      if (width >= asked.size[1]) continue;
      asked.size[1] = width;
      asked.direction[1] = across.normalized();
    }
    asked.normal = asked.direction[0].cross(asked.direction[1]);
    if (asked.size[1] < asked.size[0]) {
      std::swap(asked.size[0], asked.size[1]);
      std::swap(asked.direction[0], asked.direction[1]);
    }
    asked.size[0] = std::max(asked.size[0], tolerance);
    if (asked.size[0] < largest) found[i] = asked;
  });
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (found[i]) levels[std::ilogb(found[i]->size[0])].add(pieces[i].facet, *found[i]);
}

ChordField::ChordField(const Partition<3>& partition,
                       const std::vector<ReferenceSurface<3>>& surfaces, const ChordParams& params,
                       const Progress& progress)
    : growth_(params.growth) {
  const double tolerance = params.tolerance;
  Box<3> all;
  for (const auto& s : surfaces)
    for (const Vec<3>& p : s.points) all.add(p);
  const double largest = (all.hi - all.lo).norm();
  Levels levels;
  for (std::size_t z = 0; z < surfaces.size(); ++z) {
    const ReferenceSurface<3>& s = surfaces[z];
    std::vector<std::optional<Curved>> found(s.facets.size());
    const auto count = static_cast<double>(surfaces.size()), at = static_cast<double>(z);
    const Progress own = progress.portion(at / count, (at + 1) / count);
    parallel_each(found.size(), params.threads, own.portion(0, 0.5), [&](std::size_t f) {
      const Vec<3>&a = s.points[s.facets[f][0]], &b = s.points[s.facets[f][1]],
            &c = s.points[s.facets[f][2]];
      const Vec<3> center = (a + b + c) / 3, normal = (b - a).cross(c - a);
      const Zone<3>& zone = partition.zone(static_cast<int>(z));
      // Facets of a zone by formula are chords of it.
      if (!(normal.squaredNorm() > 0) ||
          partition.border(center).distance > 0.1 * tolerance + std::abs(zone.distance(center)))
        return;  // hidden
      found[f] = chords_of(zone, center, normal.normalized(), flat_share * largest, tolerance);
    });
    for (std::size_t f = 0; f < found.size(); ++f) {
      if (!found[f] || !(found[f]->size[0] < flat_share * largest)) continue;
      levels[std::ilogb(found[f]->size[0])].add(
          {s.points[s.facets[f][0]], s.points[s.facets[f][1]], s.points[s.facets[f][2]]},
          *found[f]);
    }
    add_details(s, partition, partition.zone(static_cast<int>(z)), params, detail_share * largest,
                own.portion(0.5, 1), levels);
  }
  for (auto& [power, level] : levels) {
    for (Curved& asked : level.curved)
      for (double& size : asked.size) size = std::max(size, params.smallest);
    level.least = std::max(std::ldexp(1, power), params.smallest);
    level.surface.faces.resize(1);
    level.locator = std::make_unique<const Locator<3>>(level.surface);
    level.surface = {};
    levels_.push_back(std::move(level));
  }
}

ChordField ChordField::of_body(const ReferenceSurface<3>& surface, const ChordParams& params,
                               const Progress& progress) {
  return ChordField(Partition<3>({{"", surface_zone(surface)}}), {surface}, params, progress);
}

Metric<3> ChordField::at(const Metric<3>& metric, const Vec<3>& x) const {
  Metric<3> out = metric;
  const double largest = 1 / std::sqrt(spectrum<3>(metric).values[0]);
  for (const Level& level : levels_) {
    // Farther away sizes have grown to what there is.
    const double reach = (largest - level.least) / growth_;
    if (!(reach > 0)) break;
    if (const auto on = level.locator->nearest(x, reach))
      out = level.curved[on->facet].at(out, std::sqrt(on->distance2), growth_);
  }
  return out;
}

}  // namespace lamella
