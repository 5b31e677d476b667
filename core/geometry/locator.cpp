#include "core/geometry/locator.h"

#include <limits>
#include <numeric>
#include <span>
#include <tuple>

#include "core/geometry/bvh.h"
#include "core/geometry/foot.h"

namespace lamella {
namespace {

/// A ray against a block of facets. The edge functions of two facets that share vertices are
/// computed from the same numbers and differ only in sign, so no ray passes between them.
template <int D>
struct RayTest;

template <>
struct RayTest<3> {
  int kx, ky, kz;
  double ox, oy, oz, sx, sy, sz;

  RayTest(const Vec<3>& o, const Vec<3>& u) {
    u.cwiseAbs().maxCoeff(&kz);
    kx = (kz + 1) % 3;
    ky = (kx + 1) % 3;
    if (u[kz] < 0) std::swap(kx, ky);  // keeps the winding
    sx = u[kx] / u[kz];
    sy = u[ky] / u[kz];
    sz = 1 / u[kz];
    ox = o[kx];
    oy = o[ky];
    oz = o[kz];
  }

  template <class Block>
  void operator()(const Block& block, double t_min, double& t_max, std::int32_t& facet) const {
    double x[3][4], y[3][4], z[3][4];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 4; ++k) {
        z[i][k] = block.v[i][kz][k] - oz;
        x[i][k] = (block.v[i][kx][k] - ox) - sx * z[i][k];
        y[i][k] = (block.v[i][ky][k] - oy) - sy * z[i][k];
      }
    double u[4], v[4], w[4];
    for (int k = 0; k < 4; ++k) {
      u[k] = x[2][k] * y[1][k] - y[2][k] * x[1][k];
      v[k] = x[0][k] * y[2][k] - y[0][k] * x[2][k];
      w[k] = x[1][k] * y[0][k] - y[1][k] * x[0][k];
    }
    double outside[4];
    for (int k = 0; k < 4; ++k) outside[k] = std::max(std::max(u[k], v[k]), w[k]);
    if (std::min(std::min(outside[0], outside[1]), std::min(outside[2], outside[3])) > 0) return;
    for (int k = 0; k < 4; ++k) {
      if (outside[k] > 0) continue;  // beside the facet, or entering the body
      const double det = u[k] + v[k] + w[k];
      if (!(det < 0)) continue;
      const double t = sz * (u[k] * z[0][k] + v[k] * z[1][k] + w[k] * z[2][k]) / det;
      if (t > t_min && t < t_max) {
        t_max = t;
        facet = block.facet[k];
      }
    }
  }
};

template <>
struct RayTest<2> {
  Vec<2> o, u;

  RayTest(const Vec<2>& origin, const Vec<2>& direction) : o(origin), u(direction) {}

  template <class Block>
  void operator()(const Block& block, double t_min, double& t_max, std::int32_t& facet) const {
    for (int k = 0; k < 4; ++k) {
      const Vec<2> a{block.v[0][0][k] - o[0], block.v[0][1][k] - o[1]};
      const Vec<2> b{block.v[1][0][k] - o[0], block.v[1][1][k] - o[1]};
      const double side_a = u[0] * a[1] - u[1] * a[0];
      const double side_b = u[0] * b[1] - u[1] * b[0];
      if (!(side_a >= 0 && side_b <= 0 && side_a > side_b)) continue;
      const double s = side_a / (side_a - side_b);
      const double t = (1 - s) * u.dot(a) + s * u.dot(b);
      if (t > t_min && t < t_max) {
        t_max = t;
        facet = block.facet[k];
      }
    }
  }
};

}  // namespace

template <int D>
struct Locator<D>::Impl {
  static constexpr int kEdges = D == 3 ? 3 : 0;  // pseudo-normals that are not of a vertex

  struct Block {
    double v[D][D][4];     // [vertex][axis][facet]
    float n[D][4];         // [axis][facet] unit normal, to tell most entered facets at once
    float bound[2][D][4];  // lower and upper, from the center; empty where a facet is repeated
    std::int32_t facet[4];
  };

  std::vector<Vec<D>> points;
  std::vector<std::array<std::int32_t, D>> facets;
  std::vector<Vec<D>> normals;                        // [facet] unit
  std::vector<std::array<Vec<D>, kEdges>> edge_sums;  // [facet][edge opposite to vertex k]
  std::vector<Vec<D>> vertex_sums;                    // [vertex]
  std::vector<Block> blocks;
  Bvh<D> bvh;
  Vec<D> center = Vec<D>::Zero();
  typename Bvh<D>::Ref root = Bvh<D>::kNothing;
  std::vector<typename Bvh<D>::Ref> face_roots;
  double diagonal = 0;

  explicit Impl(const ReferenceSurface<D>& surface)
      : points(surface.points), facets(surface.facets) {
    Box<D> all;
    std::vector<Box<D>> boxes(facets.size());
    for (std::size_t f = 0; f < facets.size(); ++f) {
      for (const auto v : facets[f]) boxes[f].add(points[v]);
      all.add(boxes[f]);
    }
    if (facets.empty()) return;
    diagonal = (all.hi - all.lo).norm();
    center = 0.5 * (all.lo + all.hi);
    bvh = Bvh<D>(center);

    std::vector<std::int32_t> items(facets.size());
    std::iota(items.begin(), items.end(), 0);
    root = bvh.build(boxes, items);
    if (surface.facet_face.size() == facets.size()) {
      std::iota(items.begin(), items.end(), 0);
      std::stable_sort(items.begin(), items.end(), [&](std::int32_t a, std::int32_t b) {
        return surface.facet_face[a] < surface.facet_face[b];
      });
      for (std::size_t first = 0; first < items.size();) {
        const auto face = surface.facet_face[items[first]];
        std::size_t last = first;
        while (last < items.size() && surface.facet_face[items[last]] == face) ++last;
        if (face >= 0) {
          face_roots.resize(static_cast<std::size_t>(face) + 1, Bvh<D>::kNothing);
          face_roots[face] = bvh.build(boxes, std::span(items).subspan(first, last - first));
        }
        first = last;
      }
    }
    sum_normals();
    fill_blocks();
  }

  std::array<Vec<D>, D> corners(std::int32_t f) const {
    std::array<Vec<D>, D> p;
    for (int k = 0; k < D; ++k) p[k] = points[facets[f][k]];
    return p;
  }

  /// True when a ray along u cannot leave the body through any facet of the block.
  static bool all_entered(const Block& b, const std::array<float, D>& u) {
    float cosine[4];
    for (int k = 0; k < 4; ++k) {
      cosine[k] = 0;
      for (int a = 0; a < D; ++a) cosine[k] += b.n[a][k] * u[a];
    }
    constexpr float kRounding = 1e-5f;
    return std::max(std::max(cosine[0], cosine[1]), std::max(cosine[2], cosine[3])) < -kRounding;
  }

  void fill_blocks() {
    const auto& order = bvh.order();
    blocks.resize(order.size() / 4);
    for (std::size_t i = 0; i < order.size(); ++i) {
      Block& b = blocks[i / 4];
      b.facet[i % 4] = order[i];
      const auto p = corners(order[i]);
      for (int k = 0; k < D; ++k)
        for (int a = 0; a < D; ++a) b.v[k][a][i % 4] = p[k][a];
      for (int a = 0; a < D; ++a) b.n[a][i % 4] = static_cast<float>(normals[order[i]][a]);
      Box<D> box;
      for (const Vec<D>& q : p) box.add(q);
      const bool repeated = i % 4 > 0 && order[i] == order[i - 1];
      constexpr float inf = std::numeric_limits<float>::infinity();
      for (int a = 0; a < D; ++a) {
        const auto lo = static_cast<float>(box.lo[a] - center[a]);
        const auto hi = static_cast<float>(box.hi[a] - center[a]);
        b.bound[0][a][i % 4] = repeated ? inf : std::nextafter(lo, -inf);
        b.bound[1][a][i % 4] = repeated ? -inf : std::nextafter(hi, inf);
      }
    }
  }

  void sum_normals() {
    normals.resize(facets.size());
    vertex_sums.assign(points.size(), Vec<D>::Zero());
    for (std::size_t f = 0; f < facets.size(); ++f) {
      const auto p = corners(static_cast<std::int32_t>(f));
      normals[f] = facet_normal<D>(p).stableNormalized();
      for (int k = 0; k < D; ++k) {
        double weight = 1;
        if constexpr (D == 3) {
          const Vec<3> a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
          weight = std::atan2(a.cross(b).norm(), a.dot(b));
        }
        vertex_sums[facets[f][k]] += weight * normals[f];
      }
    }
    if constexpr (D == 3) {
      struct Side {
        std::int32_t low, high, facet, opposite;
      };
      std::vector<Side> sides;
      for (std::size_t f = 0; f < facets.size(); ++f)
        for (int k = 0; k < 3; ++k) {
          const auto a = facets[f][(k + 1) % 3], b = facets[f][(k + 2) % 3];
          sides.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(f), k});
        }
      std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.facet) < std::tie(b.low, b.high, b.facet);
      });
      edge_sums.resize(facets.size());
      for (std::size_t i = 0; i < sides.size();) {
        std::size_t last = i;
        Vec<3> sum = Vec<3>::Zero();
        for (; last < sides.size() && sides[last].low == sides[i].low &&
               sides[last].high == sides[i].high;
             ++last)
          sum += normals[sides[last].facet];
        for (; i < last; ++i) edge_sums[sides[i].facet][sides[i].opposite] = sum;
      }
    }
  }

  /// Calls `visit(facet, foot, squared distance)` for facets that may be nearer than `bound2`,
  /// which it may lower.
  template <class Visit>
  void near(typename Bvh<D>::Ref from, const Vec<D>& x, double& bound2, Visit&& visit) const {
    const bvh_detail::BoxDistance<D> boxes(x - center);
    bvh.near(from, x, bound2, [&](std::int32_t b) {
      const Block& block = blocks[b];
      const bvh_detail::Float4 least = boxes.to(block.bound);
      for (int k = 0; k < 4; ++k) {
        if (!(least[k] < static_cast<float>(std::min(bound2, 1e38)) * 1.000002f)) continue;
        std::array<Vec<D>, D> p;
        for (int i = 0; i < D; ++i)
          for (int a = 0; a < D; ++a) p[i][a] = block.v[i][a][k];
        const Foot<D> f = foot_on_facet(p, x);
        visit(block.facet[k], f, (f.point - x).squaredNorm());
      }
    });
  }

  std::optional<Nearest<D>> nearest(typename Bvh<D>::Ref from, const Vec<D>& x,
                                    double within) const {
    double bound2 = within * within;
    Nearest<D> best;
    near(from, x, bound2, [&](std::int32_t facet, const Foot<D>& f, double d2) {
      if (!(d2 < bound2 || (best.facet < 0 && d2 <= bound2))) return;
      bound2 = d2;
      best = {f.point, facet, d2};
    });
    if (best.facet < 0) return std::nullopt;
    return best;
  }

  Vec<D> pseudo_normal(std::int32_t facet, unsigned carriers) const {
    if (carriers == (1u << D) - 1) return normals[facet];
    for (int k = 0; k < D; ++k)
      if (carriers == 1u << k) return vertex_sums[facets[facet][k]];
    if constexpr (D == 3)
      for (int k = 0; k < 3; ++k)
        if (carriers == (7u & ~(1u << k))) return edge_sums[facet][k];
    return normals[facet];
  }
};

template <int D>
Locator<D>::Locator(const ReferenceSurface<D>& surface) : impl_(std::make_unique<Impl>(surface)) {}
template <int D>
Locator<D>::~Locator() = default;
template <int D>
Locator<D>::Locator(Locator&&) noexcept = default;

template <int D>
std::optional<Nearest<D>> Locator<D>::nearest(const Vec<D>& x, double within) const {
  return impl_->nearest(impl_->root, x, within);
}

template <int D>
std::optional<Nearest<D>> Locator<D>::nearest_on_face(const Vec<D>& x, std::int32_t face) const {
  if (face < 0 || static_cast<std::size_t>(face) >= impl_->face_roots.size()) return std::nullopt;
  return impl_->nearest(impl_->face_roots[face], x, 1e300);
}

template <int D>
Nearest<D> Locator<D>::nearest_on_facet(const Vec<D>& x, std::int32_t facet) const {
  const Vec<D> p = foot_on_facet(impl_->corners(facet), x).point;
  return {p, facet, (p - x).squaredNorm()};
}

template <int D>
void Locator<D>::all_within(const Vec<D>& x, double radius, std::vector<Nearest<D>>& found) const {
  found.clear();
  double bound2 = radius * radius;
  impl_->near(impl_->root, x, bound2, [&](std::int32_t facet, const Foot<D>& f, double d2) {
    if (d2 <= bound2) found.push_back({f.point, facet, d2});
  });
  std::sort(found.begin(), found.end(), [](const Nearest<D>& a, const Nearest<D>& b) {
    return std::tie(a.distance2, a.facet) < std::tie(b.distance2, b.facet);
  });
}

template <int D>
std::optional<RayHit> Locator<D>::exit(const Vec<D>& x, const Vec<D>& u, double t_min,
                                       double t_max) const {
  RayHit hit;
  hit.t = t_max;
  const RayTest<D> test(x, u);
  std::array<float, D> uf;
  for (int a = 0; a < D; ++a) uf[a] = static_cast<float>(u[a]);
  impl_->bvh.along(impl_->root, x, u, hit.t, [&](std::int32_t b) {
    const auto& block = impl_->blocks[b];
    if (!Impl::all_entered(block, uf)) test(block, t_min, hit.t, hit.facet);
  });
  if (hit.facet < 0) return std::nullopt;
  return hit;
}

template <int D>
SignedNearest<D> Locator<D>::signed_nearest(const Vec<D>& x) const {
  SignedNearest<D> s;
  s.foot = *nearest(x);
  const Foot<D> f = foot_on_facet(impl_->corners(s.foot.facet), x);
  s.pseudo_normal = impl_->pseudo_normal(s.foot.facet, f.carriers).normalized();
  const double d = std::sqrt(s.foot.distance2);
  s.distance = s.pseudo_normal.dot(x - s.foot.point) < 0 ? -d : d;
  return s;
}

template <int D>
double Locator<D>::signed_distance(const Vec<D>& x) const {
  return empty() ? std::numeric_limits<double>::infinity() : signed_nearest(x).distance;
}

template <int D>
Vec<D> Locator<D>::normal(std::int32_t facet) const {
  return impl_->normals[facet];
}

template <int D>
double Locator<D>::diagonal() const {
  return impl_->diagonal;
}

template <int D>
bool Locator<D>::empty() const {
  return impl_->facets.empty();
}

template class Locator<2>;
template class Locator<3>;

}  // namespace lamella
