#include "core/multidomain/zone.h"

#include <algorithm>
#include <map>
#include <numbers>

#include "core/geometry/locator.h"
#include "core/geometry/winding.h"

namespace lamella {

namespace {

template <int D>
Box<D> everywhere() {
  Box<D> box;
  std::swap(box.lo, box.hi);
  return box;
}

using Facets = std::vector<std::array<std::int32_t, 3>>;

/// The facets by the first vertex at each position, for points may be unwelded, and each once.
Facets welded(const ReferenceSurface<3>& surface) {
  std::map<std::array<double, 3>, std::int32_t> first;
  std::vector<std::int32_t> id;
  for (const Vec<3>& p : surface.points)
    id.push_back(
        first.try_emplace({p[0], p[1], p[2]}, static_cast<std::int32_t>(id.size())).first->second);
  Facets facets;
  for (auto f : surface.facets) {
    for (std::int32_t& v : f) v = id[v];
    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
    facets.push_back(f);
  }
  std::sort(facets.begin(), facets.end());
  facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
  return facets;
}

/// Where a surface that should be closed ends: across such a hole its winding number w changes
/// smoothly, and the border of {w > 1/2} is no part of the surface.
class Rim {
 public:
  Rim(const std::vector<Vec<3>>& points, const Facets& facets) {
    std::map<std::array<std::int32_t, 2>, int> ends;
    for (const auto& f : facets)
      for (int k = 0; k < 3; ++k) {
        const std::int32_t from = f[k], to = f[(k + 1) % 3];
        if (from != to) ends[{std::min(from, to), std::max(from, to)}] += from < to ? 1 : -1;
      }
    for (const auto& [edge, times] : ends) {
      if (times == 0) continue;
      const Vec<3>&p = points[edge[0]], &q = points[edge[1]];
      pieces_.push_back({(p + q) / 2, (q - p).norm() / 2, std::abs(times)});
    }
  }
  bool empty() const { return pieces_.empty(); }
  /// A lower bound of the distance to where w = 1/2, at most that to the surface, `near`. The
  /// gradient of w is that of the rim's solid angle, |grad w| <= sum of length / (4 pi d^2) (law of
  /// Biot and Savart).
  double level_distance(const Vec<3>& x, double w, double near) const {
    double steepness = 0, nearest = std::numeric_limits<double>::infinity();
    for (const Piece& piece : pieces_) {
      const double d = std::max((x - piece.middle).norm() - piece.half, near);
      nearest = std::min(nearest, d);
      steepness += piece.times * piece.half / (2 * std::numbers::pi * d * d);
    }
    // The largest s with s * steepness / (1 - s / nearest)^2 <= |w - 1/2|, and s <= near.
    const double reach = std::abs(w - 0.5) / steepness;
    const double b = 1 + nearest / (2 * reach);
    return std::min(near, nearest / (b + std::sqrt(b * b - 1)));
  }

 private:
  struct Piece {
    Vec<3> middle;
    double half;
    int times;
  };
  std::vector<Piece> pieces_;
};

/// Signed distances at the centers of the cells of a tree that is fine near the boundary: as
/// distances change by no more than one goes, they bound those of all points around.
template <int D>
class DistanceTree {
 public:
  template <class Distance>
  DistanceTree(const Box<D>& box, int depth, const Distance& distance) {
    if (!((box.hi - box.lo).minCoeff() >= 0)) return;
    root_ = (box.lo + box.hi) / 2;
    half_ = 0.55 * (box.hi - box.lo).maxCoeff();
    cells_.resize(1);
    grow(0, root_, half_, depth, distance);
  }

  /// A distance of the right sign that is at least `reach` and no more than the exact one; 0 where
  /// nothing is known that far.
  double bound(const Vec<D>& x, double reach) const {
    if (cells_.empty() || (x - root_).cwiseAbs().maxCoeff() > half_) return 0;
    Vec<D> center = root_;
    double half = half_;
    const double rounding = 1e-6 * half_;
    for (std::int32_t c = 0;;) {
      const Cell& cell = cells_[c];
      const double left = std::abs(cell.distance) - (x - center).norm() - rounding;
      if (left > 0 && left >= reach) return std::copysign(left, cell.distance);
      if (cell.children < 0) return 0;
      c = cell.children;
      half /= 2;
      for (int k = 0; k < D; ++k) {
        const bool upper = x[k] > center[k];
        c += upper ? 1 << k : 0;
        center[k] += upper ? half : -half;
      }
    }
  }

 private:
  struct Cell {
    float distance = 0;
    std::int32_t children = -1;  ///< the first of 2^D; -1: none
  };
  template <class Distance>
  void grow(std::int32_t c, const Vec<D>& center, double half, int depth,
            const Distance& distance) {
    const double d = distance(center);
    cells_[c].distance = static_cast<float>(d);
    if (depth == 0 || std::abs(d) > 2 * half * std::sqrt(static_cast<double>(D))) return;
    const auto first = static_cast<std::int32_t>(cells_.size());
    cells_[c].children = first;
    cells_.resize(cells_.size() + (1 << D));
    for (int child = 0; child < (1 << D); ++child) {
      Vec<D> at = center;
      for (int k = 0; k < D; ++k) at[k] += (child >> k & 1) != 0 ? half / 2 : -half / 2;
      grow(first + child, at, half / 2, depth - 1, distance);
    }
  }

  Vec<D> root_ = Vec<D>::Zero();
  double half_ = 0;
  std::vector<Cell> cells_;
};

template <int D>
class SurfaceZone : public Zone<D> {
 public:
  SurfaceZone(const ReferenceSurface<D>& surface, Inside inside) : locator_(surface) {
    for (const Vec<D>& p : surface.points) box_.add(p);
    // About as many cells at the boundary as facets, as far as that pays.
    const double count = static_cast<double>(surface.facets.size()) + 1;
    const int depth = std::clamp(static_cast<int>(std::lround(std::log2(count) / (D - 1))), 2, 6);
    if constexpr (D == 3)
      if (inside == Inside::winding && !locator_.empty()) {
        const Facets facets = welded(surface);
        winding_ = std::make_unique<WindingNumber>(surface.points, facets);
        rim_ = std::make_unique<Rim>(surface.points, facets);
      }
    // Of surfaces with holes the distance is a bound only, which may jump.
    if (inside == Inside::normals && !locator_.empty())
      tree_ = std::make_unique<DistanceTree<D>>(
          box_, depth, [this](const Vec<D>& x) { return locator_.signed_distance(x); });
  }
  ZoneDistance<D> within(const Vec<D>& x, double reach) const override {
    if (tree_)
      if (const double d = tree_->bound(x, reach); d != 0) return {d, Vec<D>::Zero()};
    return at(x);
  }
  ZoneDistance<D> at(const Vec<D>& x) const override {
    if (locator_.empty()) return {};
    if constexpr (D == 3)
      if (winding_) return at_by_winding(x);
    const SignedNearest<D> near = locator_.signed_nearest(x);
    return {near.distance, away(x, near.foot.point, near.distance, near.pseudo_normal)};
  }
  Box<D> box() const override { return box_; }

 private:
  ZoneDistance<3> at_by_winding(const Vec<3>& x) const {
    const Nearest<3> near = *locator_.nearest(x);
    const double w = (*winding_)(x), d = std::sqrt(near.distance2);
    const bool open = !rim_->empty() && d > 0;
    // What bulges out of holes ends with the surface's box.
    const double side = open ? std::min((x - box_.lo).minCoeff(), (box_.hi - x).minCoeff()) : d;
    const double sign = w > 0.5 && side >= 0 ? -1 : 1;
    double level = open ? rim_->level_distance(x, w, d) : d;
    if (w > 0.5 && open) level = side >= 0 ? std::min(level, side) : std::min(d, -side);
    if (level == d) return {sign * d, away(x, near.point, sign * d, locator_.normal(near.facet))};
    Vec<3> falls;
    for (int k = 0; k < 3; ++k) {
      const Vec<3> step = 1e-2 * d * Vec<3>::Unit(k);
      falls[k] = (*winding_)(x - step) - (*winding_)(x + step);
    }
    return {sign * level, falls.normalized()};
  }
  static Vec<D> away(const Vec<D>& x, const Vec<D>& foot, double d, const Vec<D>& on_surface) {
    const Vec<D> to = x - foot;
    const double length = to.norm();
    return length > 1e-12 * foot.cwiseAbs().maxCoeff() ? Vec<D>(to / std::copysign(length, d))
                                                       : on_surface;
  }
  Locator<D> locator_;
  std::unique_ptr<WindingNumber> winding_;
  std::unique_ptr<Rim> rim_;
  std::unique_ptr<const DistanceTree<D>> tree_;
  Box<D> box_;
};

template <int D>
class BallZone : public Zone<D> {
 public:
  BallZone(const Vec<D>& center, double radius) : center_(center), radius_(radius) {}
  ZoneDistance<D> at(const Vec<D>& x) const override {
    const Vec<D> to = x - center_;
    const double r = to.norm();
    return {r - radius_, r > 0 ? Vec<D>(to / r) : Vec<D>::UnitX()};
  }
  Box<D> box() const override {
    Box<D> box;
    box.add(center_.array() - radius_);
    box.add(center_.array() + radius_);
    return box;
  }

 private:
  Vec<D> center_;
  double radius_;
};

/// What is beyond the point of a convex set nearest to x lies along x - point; inside, the side
/// with the largest (negative) distance is the nearest.
template <int D>
ZoneDistance<D> outside_of(const Vec<D>& beyond) {
  const double d = beyond.norm();
  return {d, beyond / d};
}

template <int D>
class BoxZone : public Zone<D> {
 public:
  BoxZone(const Vec<D>& low, const Vec<D>& high) {
    box_.add(low);
    box_.add(high);
  }
  ZoneDistance<D> at(const Vec<D>& x) const override {
    const Vec<D> beyond = x - x.cwiseMax(box_.lo).cwiseMin(box_.hi);
    if (beyond.squaredNorm() > 0) return outside_of<D>(beyond);
    ZoneDistance<D> best{-std::numeric_limits<double>::infinity()};
    for (int k = 0; k < D; ++k) {
      if (box_.lo[k] - x[k] > best.distance) best = {box_.lo[k] - x[k], -Vec<D>::Unit(k)};
      if (x[k] - box_.hi[k] > best.distance) best = {x[k] - box_.hi[k], Vec<D>::Unit(k)};
    }
    return best;
  }
  Box<D> box() const override { return box_; }

 private:
  Box<D> box_;
};

template <int D>
class HalfSpaceZone : public Zone<D> {
 public:
  HalfSpaceZone(const Vec<D>& normal, double offset)
      : normal_(normal.normalized()), offset_(offset / normal.norm()) {}
  ZoneDistance<D> at(const Vec<D>& x) const override { return {normal_.dot(x) - offset_, normal_}; }
  Box<D> box() const override { return everywhere<D>(); }

 private:
  Vec<D> normal_;
  double offset_;
};

class CylinderZone : public Zone<3> {
 public:
  CylinderZone(const Vec<3>& from, const Vec<3>& to, double radius)
      : middle_((from + to) / 2),
        axis_((to - from).normalized()),
        half_((to - from).norm() / 2),
        radius_(radius) {}
  ZoneDistance<3> at(const Vec<3>& x) const override {
    const double along = axis_.dot(x - middle_);
    const Vec<3> across = x - middle_ - along * axis_;
    const double r = across.norm();
    const Vec<3> out = r > 0 ? Vec<3>(across / r) : axis_.unitOrthogonal();
    const Vec<3> end = std::copysign(1.0, along) * axis_;
    const double side = r - radius_, cap = std::abs(along) - half_;
    if (side > 0 && cap > 0) return outside_of<3>(side * out + cap * end);
    return side > cap ? ZoneDistance<3>{side, out} : ZoneDistance<3>{cap, end};
  }
  Box<3> box() const override {
    const Vec<3> reach = half_ * axis_.cwiseAbs() +
                         radius_ * (Vec<3>::Ones() - axis_.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
    Box<3> box;
    box.add(middle_ - reach);
    box.add(middle_ + reach);
    return box;
  }

 private:
  Vec<3> middle_, axis_;
  double half_, radius_;
};

template <int D>
class VoronoiZone : public Zone<D> {
 public:
  VoronoiZone(const std::vector<Vec<D>>& seeds, std::size_t cell) : seed_(seeds[cell]) {
    for (std::size_t s = 0; s < seeds.size(); ++s)
      if (s != cell) {
        const double gap = (seeds[s] - seed_).norm();
        planes_.push_back({(seeds[s] - seed_) / gap, gap / 2});
      }
    std::stable_sort(planes_.begin(), planes_.end(),
                     [](const Plane& a, const Plane& b) { return a.offset < b.offset; });
  }
  ZoneDistance<D> at(const Vec<D>& x) const override {
    ZoneDistance<D> best{-std::numeric_limits<double>::infinity()};
    const Vec<D> from_seed = x - seed_;
    const double far = from_seed.norm();
    for (const Plane& plane : planes_) {
      if (far - plane.offset <= best.distance) break;  // neither this nor any other beyond it
      const double d = plane.normal.dot(from_seed) - plane.offset;
      if (d > best.distance) best = {d, plane.normal};
    }
    return best;
  }
  Box<D> box() const override { return everywhere<D>(); }

 private:
  struct Plane {
    Vec<D> normal;
    double offset;  // from the seed
  };
  Vec<D> seed_;
  std::vector<Plane> planes_;
};

/// The zone of which the distance, times `sign`, is the largest.
template <int D>
class ExtremeZone : public Zone<D> {
 public:
  ExtremeZone(std::vector<ZonePtr<D>> zones, int sign) : zones_(std::move(zones)), sign_(sign) {}
  ZoneDistance<D> at(const Vec<D>& x) const override {
    ZoneDistance<D> best = zones_.front()->at(x);
    for (std::size_t z = 1; z < zones_.size(); ++z) {
      const ZoneDistance<D> next = zones_[z]->at(x);
      if (sign_ * (next.distance - best.distance) > 0) best = next;
    }
    return best;
  }
  Box<D> box() const override {
    Box<D> box = sign_ > 0 ? everywhere<D>() : Box<D>{};
    for (const auto& zone : zones_) {
      const Box<D> b = zone->box();
      if (sign_ < 0) {
        box.add(b);
      } else {
        box.lo = box.lo.cwiseMax(b.lo);
        box.hi = box.hi.cwiseMin(b.hi);
      }
    }
    return box;
  }

 private:
  std::vector<ZonePtr<D>> zones_;
  int sign_;
};

template <int D>
class ComplementZone : public Zone<D> {
 public:
  explicit ComplementZone(ZonePtr<D> zone) : zone_(std::move(zone)) {}
  ZoneDistance<D> at(const Vec<D>& x) const override {
    const ZoneDistance<D> of = zone_->at(x);
    return {-of.distance, -of.normal};
  }
  Box<D> box() const override { return everywhere<D>(); }

 private:
  ZonePtr<D> zone_;
};

}  // namespace

template <int D>
ZonePtr<D> surface_zone(const ReferenceSurface<D>& surface, Inside inside) {
  return std::make_shared<SurfaceZone<D>>(surface, inside);
}
template <int D>
ZonePtr<D> ball_zone(const Vec<D>& center, double radius) {
  return std::make_shared<BallZone<D>>(center, radius);
}
template <int D>
ZonePtr<D> box_zone(const Vec<D>& low, const Vec<D>& high) {
  return std::make_shared<BoxZone<D>>(low, high);
}
template <int D>
ZonePtr<D> half_space_zone(const Vec<D>& normal, double offset) {
  return std::make_shared<HalfSpaceZone<D>>(normal, offset);
}
ZonePtr<3> cylinder_zone(const Vec<3>& from, const Vec<3>& to, double radius) {
  return std::make_shared<CylinderZone>(from, to, radius);
}
template <int D>
ZonePtr<D> voronoi_zone(const std::vector<Vec<D>>& seeds, std::size_t cell) {
  return std::make_shared<VoronoiZone<D>>(seeds, cell);
}
template <int D>
ZonePtr<D> intersection_zone(std::vector<ZonePtr<D>> zones) {
  return std::make_shared<ExtremeZone<D>>(std::move(zones), 1);
}
template <int D>
ZonePtr<D> union_zone(std::vector<ZonePtr<D>> zones) {
  return std::make_shared<ExtremeZone<D>>(std::move(zones), -1);
}
template <int D>
ZonePtr<D> complement_zone(ZonePtr<D> zone) {
  return std::make_shared<ComplementZone<D>>(std::move(zone));
}

#define LAMELLA_INSTANTIATE(D)                                                  \
  template ZonePtr<D> surface_zone<D>(const ReferenceSurface<D>&, Inside);      \
  template ZonePtr<D> ball_zone<D>(const Vec<D>&, double);                      \
  template ZonePtr<D> box_zone<D>(const Vec<D>&, const Vec<D>&);                \
  template ZonePtr<D> half_space_zone<D>(const Vec<D>&, double);                \
  template ZonePtr<D> voronoi_zone<D>(const std::vector<Vec<D>>&, std::size_t); \
  template ZonePtr<D> intersection_zone<D>(std::vector<ZonePtr<D>>);            \
  template ZonePtr<D> union_zone<D>(std::vector<ZonePtr<D>>);                   \
  template ZonePtr<D> complement_zone<D>(ZonePtr<D>);
LAMELLA_INSTANTIATE(2)
LAMELLA_INSTANTIATE(3)
#undef LAMELLA_INSTANTIATE

}  // namespace lamella
