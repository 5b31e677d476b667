#include "core/natural/boundary_distance.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/geometry/foot.h"
#include "core/geometry/locator.h"

namespace lamella {

namespace {

using Triangle = std::array<Vec<3>, 3>;

Triangle corners_of(const ReferenceSurface<3>& s, std::int32_t facet) {
  const auto& f = s.facets[facet];
  return {s.points[f[0]], s.points[f[1]], s.points[f[2]]};
}

/// Point of a triangle and the nearest one of the other surface.
struct Sample {
  Vec<3> x;
  Nearest<3> near;
  double depth = 0;  // under what covers it
};

/// Branch and bound on one triangle: it is cut until no piece can hold a point that is farther than
/// the farthest sample. The distance to one flat facet is convex, so on a piece it is largest at a
/// corner; so pieces are cut along the sides of the facets below them.
class Search {
 public:
  Search(const ReferenceSurface<3>& to, const Locator<3>& locator, double known, double resolution,
         const Covered& covered)
      : to_(to), locator_(locator), known_(known), resolution_(resolution), covered_(covered) {}

  FarthestPoint operator()(const Triangle& t) {
    pieces_.push_back({sample(t[0]), sample(t[1]), sample(t[2])});
    while (!pieces_.empty()) {
      const Piece piece = pieces_.back();
      pieces_.pop_back();
      if (!settled(piece)) divide(piece);
    }
    return worst_;
  }

 private:
  using Piece = std::array<Sample, 3>;

  Sample sample(const Vec<3>& x) {
    const Sample s{x, *locator_.nearest(x), covered_ ? covered_(x) : 0};
    const double d = std::sqrt(s.near.distance2);
    if (d > worst_.distance && !(s.depth > 0)) worst_ = {d, x};
    return s;
  }

  bool settled(const Piece& p) const {
    const double enough = std::max(worst_.distance, known_) + resolution_;
    double longest2 = 0, most2 = 0;
    for (int k = 0; k < 3; ++k) {
      longest2 = std::max(longest2, (p[k].x - p[(k + 1) % 3].x).squaredNorm());
      most2 = std::max(most2, p[k].near.distance2);
    }
    // Every point of a triangle is within longest / sqrt(3) of a corner.
    if (std::sqrt(most2) + std::sqrt(longest2 / 3) <= enough) return true;
    for (const Sample& s : p)
      if (s.depth * s.depth > longest2) return true;
    if (longest2 <= resolution_ * resolution_) return true;
    for (int k = 0; k < 3; ++k) {
      const Triangle facet = corners_of(to_, p[k].near.facet);
      bool below = true;
      for (int i = 0; i < 3 && below; ++i)
        below = i == k ||
                (foot_on_facet(facet, p[i].x).point - p[i].x).squaredNorm() <= enough * enough;
      if (below) return true;
    }
    return false;
  }

  /// Cuts along the side of a facet below that best divides the corners; at the middle of the
  /// longest edge where none does.
  void divide(const Piece& p) {
    double best = 0.5 * resolution_;
    std::array<double, 3> height{};
    for (const Sample& s : p) {
      const Triangle f = corners_of(to_, s.near.facet);
      const Vec<3> normal = facet_normal<3>(f);
      for (int k = 0; k < 3; ++k) {
        const Vec<3> out = (f[(k + 1) % 3] - f[k]).cross(normal).stableNormalized();
        std::array<double, 3> h;
        for (int i = 0; i < 3; ++i) h[i] = out.dot(p[i].x - f[k]);
        const auto [low, high] = std::minmax({h[0], h[1], h[2]});
        const double balance = std::min(-low, high);
        if (!(balance > best)) continue;
        best = balance;
        height = h;
      }
    }
    if (best > 0.5 * resolution_) return cut(p, height);
    int k = 0;
    double longest2 = -1;
    for (int i = 0; i < 3; ++i) {
      const double l2 = (p[i].x - p[(i + 1) % 3].x).squaredNorm();
      if (l2 > longest2) k = i, longest2 = l2;
    }
    const Sample middle = sample(0.5 * (p[k].x + p[(k + 1) % 3].x));
    pieces_.push_back({p[k], middle, p[(k + 2) % 3]});
    pieces_.push_back({middle, p[(k + 1) % 3], p[(k + 2) % 3]});
  }

  void cut(const Piece& p, const std::array<double, 3>& height) {
    // k: the corner that is alone on its side.
    int k = 0;
    while ((height[k] > 0) == (height[(k + 1) % 3] > 0) ||
           (height[k] > 0) == (height[(k + 2) % 3] > 0))
      ++k;
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const auto crossing = [&](int other) {
      const double t = height[k] / (height[k] - height[other]);
      return sample(p[k].x + t * (p[other].x - p[k].x));
    };
    const Sample a = crossing(i), b = crossing(j);
    pieces_.push_back({p[k], a, b});
    pieces_.push_back({a, p[i], p[j]});
    pieces_.push_back({a, p[j], b});
  }

  const ReferenceSurface<3>& to_;
  const Locator<3>& locator_;
  double known_, resolution_;
  const Covered& covered_;
  std::vector<Piece> pieces_;
  FarthestPoint worst_;
};

ReferenceSurface<3> surface_of(const SimplexMesh<3>& mesh) {
  ReferenceSurface<3> s;
  s.points = mesh.points;
  s.facets.assign(mesh.facets.begin(), mesh.facets.end());
  return s;
}

}  // namespace

Result<FarthestPoint> farthest_point(const ReferenceSurface<3>& from, const ReferenceSurface<3>& to,
                                     double resolution, int threads, const Progress& progress,
                                     const Covered& covered) {
  const Locator<3> locator(to);
  if (locator.empty() || from.facets.empty())
    return Error{Code::bad_input, "There is no surface to measure the distance to.", ""};
  if (!(resolution > 0)) resolution = 1e-5 * locator.diagonal();
  const auto largest = [](const std::vector<FarthestPoint>& all) {
    FarthestPoint worst;
    for (const auto& d : all)
      if (d.distance > worst.distance) worst = d;
    return worst;
  };
  // First the corners and centers: what they find lets every search below end early.
  std::vector<FarthestPoint> of_facet(from.facets.size());
  bool complete =
      parallel_each(of_facet.size(), threads, progress.portion(0, 0.2), [&](std::size_t f) {
        const Triangle p = corners_of(from, static_cast<std::int32_t>(f));
        for (const Vec<3>& x : {p[0], p[1], p[2], Vec<3>((p[0] + p[1] + p[2]) / 3)}) {
          const double d = std::sqrt(locator.nearest(x)->distance2);
          if (d > of_facet[f].distance && !(covered && covered(x) > 0)) of_facet[f] = {d, x};
        }
      });
  const FarthestPoint first = largest(of_facet);
  complete = complete &&
             parallel_each(of_facet.size(), threads, progress.portion(0.2, 1), [&](std::size_t f) {
               Search search(to, locator, first.distance, resolution, covered);
               of_facet[f] = search(corners_of(from, static_cast<std::int32_t>(f)));
             });
  if (!complete) return cancelled_error();
  const FarthestPoint found = largest(of_facet);
  return found.distance > first.distance ? found : first;
}

Result<BoundaryDistance> boundary_distance(const SimplexMesh<3>& mesh,
                                           const ReferenceSurface<3>& surface, int threads,
                                           const Progress& progress) {
  const ReferenceSurface<3> own = surface_of(mesh);
  Result<FarthestPoint> to = farthest_point(own, surface, 0, threads, progress.portion(0, 0.5));
  if (!to) return to.error();
  Result<FarthestPoint> from = farthest_point(surface, own, 0, threads, progress.portion(0.5, 1));
  if (!from) return from.error();
  return BoundaryDistance{*to, *from};
}

}  // namespace lamella
