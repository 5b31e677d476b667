#include "core/multidomain/pierced.h"

#include <algorithm>
#include <cmath>

namespace lamella {
namespace {

Vec<3> lattice_point(const Corners<3>& p, int i, int j, int k, int l) {
  return (i * p[0] + j * p[1] + k * p[2] + l * p[3]) / (i + j + k + l);
}

}  // namespace

std::optional<Pierced> pierced_at(const Zone<3>& zone, const Corners<3>& p,
                                  const std::array<double, 4>& phi, double limit) {
  constexpr int order = 6;
  std::array<double, 2> most{};  // outside, inside
  std::array<Vec<3>, 2> there{p[0], p[0]};
  for (int i = 0; i <= order; ++i)
    for (int j = 0; i + j <= order; ++j)
      for (int k = 0; i + j + k <= order; ++k) {
        const std::array<int, 4> n{i, j, k, order - i - j - k};
        const Vec<3> x = lattice_point(p, n[0], n[1], n[2], n[3]);
        const auto corner = std::find(n.begin(), n.end(), order);
        const double f = corner == n.end() ? zone.distance(x)
                                           : phi[static_cast<std::size_t>(corner - n.begin())];
        const int side = f < 0 ? 1 : 0;
        if (std::abs(f) <= most[side]) continue;
        most[side] = std::abs(f);
        there[side] = x;
      }
  const int side = most[0] < most[1] ? 0 : 1;
  if (most[side] <= limit) return std::nullopt;
  const Vec<3> from = there[side], to = there[1 - side];
  const ZoneDistance<3> d = zone.at(from);
  const Vec<3> foot = from - d.distance * d.normal;
  const Vec<3> w = edge_matrix<3>(p).inverse() * (foot - p[0]);
  if (d.normal.squaredNorm() > 0 && std::min(w.minCoeff(), 1 - w.sum()) > 0.05)
    return Pierced{most[side], foot};
  // Towards the other side, as far as the element reaches.
  double t0 = 0, t1 = 1;
  for (int i = 0; i < 50 && (t1 - t0) * (to - from).norm() > 1e-4 * limit; ++i) {
    const double t = 0.5 * (t0 + t1);
    ((zone.distance(from + t * (to - from)) < 0) == (side == 1) ? t0 : t1) = t;
  }
  return Pierced{most[side], from + 0.5 * (t0 + t1) * (to - from)};
}

DepthIn depth_in(const Zone<3>& zone, const Corners<3>& p) {
  constexpr int order = 5;
  DepthIn in;
  int count = 0;
  for (int i = 1; i < order; ++i)
    for (int j = 1; i + j < order; ++j)
      for (int k = 1; i + j + k < order; ++k, ++count) {
        const double f = zone.distance(lattice_point(p, i, j, k, order - i - j - k));
        in.most = std::max(in.most, std::abs(f));
        in.mean += f;
      }
  in.mean /= count;
  return in;
}

}  // namespace lamella
