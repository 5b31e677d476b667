#include <algorithm>

#include "core/optimize/star_optimizer.h"

namespace lamella {
namespace {

/// Squared metric length of a move that is not worth making.
constexpr double idle_move2 = 1e-4;
/// Squared metric length of a move over which the node's own metric still holds.
constexpr double short_move2 = 0.01;

}  // namespace

/// One step of Newton's method on the energy of the star, along the boundary for a boundary node.
/// The metric of the node is held. Nothing where the node is at its best already.
template <int D>
std::optional<Vec<D>> StarOptimizer<D>::newton_step(NodeId s, const BoundarySite& site) const {
  constexpr double p = 0.5 * D;
  constexpr double size_factor = 2.0 / (D * (D + 1));
  const Vec<D>& x = topo_.points[s];
  const Packed<D>& own = averaged()[s];
  const double w = kernel_.size_weight;
  Vec<D> gradient = Vec<D>::Zero();
  Packed<D> hessian = Packed<D>::zero(), convex = Packed<D>::zero();
  for (const auto& f : faces_) {
    const Packed<D> m = kernel_.element_metric(f, own);
    const Vec<D> r = x - f.center;
    PackedDual<D> edges = f.edges;
    edges.add_outer(D, r);
    const double size = trace_product(m, edges) * size_factor;
    const double scale = std::sqrt(m.det() * ((1 << D) * RatingKernel<D>::mean));
    const double v = f.normal.dot(r) * scale;
    if (!(v > 0)) return std::nullopt;
    const double a = power_of_size<D>(size);
    const double inv_s = 1 / size, inv_v = 1 / v, inv_a = 1 / a;
    const double by_size = p * inv_s * (a * inv_v + w * (a - inv_a));
    const double by_volume = -a * inv_v * inv_v;
    const double ss = inv_s * inv_s * (p * (p - 1) * a * (inv_v + w) + w * p * (p + 1) * inv_a);
    const double vv = 2 * a * inv_v * inv_v * inv_v;
    const double sv = -p * a * inv_s * inv_v * inv_v;
    const double c = 2 * size_factor * D;
    const Vec<D> u = c * m.times(r);
    const Vec<D> k = scale * f.normal;
    gradient += by_size * u + by_volume * k;
    // sum of by_size c m + ss u u^T + sv (u k^T + k u^T) + vv k k^T
    const double curve = c * std::max(by_size, 0.1 * p * inv_s * a * inv_v);
    for (int i = 0, j = 0; i < D; ++i)
      for (int l = i; l < D; ++l, ++j) {
        const double stiff = curve * m.c[j] + vv * k[i] * k[l];
        convex.c[j] += stiff;
        hessian.c[j] += stiff + ss * u[i] * u[l] + sv * (u[i] * k[l] + k[i] * u[l]);
      }
  }
  Mat<D> basis;
  const int free = free_directions(site, basis);
  if (free == 0) return std::nullopt;
  Vec<D> step;
  const auto solve = [&](const Packed<D>& h) {
    if (free == D) {
      const Eigen::LLT<Mat<D>> llt(h.full());
      if (llt.info() != Eigen::Success) return false;
      step = -llt.solve(gradient);
    } else {
      // The other directions are held by unit rows.
      Mat<D> held = basis.transpose() * h.full() * basis;
      Vec<D> g = basis.transpose() * gradient;
      const double unit = held.trace();
      for (int i = free; i < D; ++i) {
        held.row(i).setZero();
        held.col(i).setZero();
        held(i, i) = unit;
        g[i] = 0;
      }
      const Eigen::LLT<Mat<D>> llt(held);
      if (llt.info() != Eigen::Success) return false;
      step = -basis * Vec<D>(llt.solve(g));
    }
    return step.allFinite() && step.dot(gradient) < 0;
  };
  if (!solve(hessian) && !solve(convex)) return std::nullopt;
  const double length2 = own.quad(step);
  if (metric_[s].quad(step) < idle_move2) return std::nullopt;
  if (length2 > 1) step /= std::sqrt(length2);
  return step;
}

/// Moves of the node: Newton's step, halved until it helps; in the order criterion also the plain
/// center of the star (thesis).
template <int D>
void StarOptimizer<D>::offer_moves(NodeId s, const BoundarySite& site) {
  const Vec<D> old = topo_.points[s];
  const auto offer_at = [&](Vec<D> x) {
    if (site.boundary) {
      const auto on =
          point_on_boundary(x, site.on_feature, (x - old).norm() + 2 * model_.tolerance());
      if (!on) return;
      x = *on;
    }
    const bool near = metric_[s].quad(x - old) < short_move2;
    offer(near ? Apex{0, x, metric_[s], averaged()[s]} : new_point(x, metric_in_star(s, x)), site);
  };
  if (const auto step = newton_step(s, site)) {
    const double before = best_cost_;
    const bool joins = found_;
    double part = 1;
    for (int i = 0; i < 3; ++i, part *= 0.4) {
      offer_at(old + part * *step);
      if (found_ != joins || best_cost_ != before) break;
    }
  }
  if (sweep_.criterion != Criterion::order) return;
  Vec<D> center = Vec<D>::Zero();
  int weight = 0;
  const auto add = [&](NodeId n) {
    center += topo_.points[n];
    ++weight;
  };
  if (site.on_feature) {
    add(site.ends[0]);
    add(site.ends[1]);
  } else if (site.boundary) {
    for (const auto& r : ring_) add(r.node);
  } else {
    for (NodeId n : link_) add(n);
  }
  if (weight > 0) offer_at(center / weight);
}

#define LAMELLA_INSTANTIATE(D)                                                          \
  template std::optional<Vec<D>> StarOptimizer<D>::newton_step(NodeId,                  \
                                                               const BoundarySite&) const; \
  template void StarOptimizer<D>::offer_moves(NodeId, const BoundarySite&);
LAMELLA_INSTANTIATE(2)
LAMELLA_INSTANTIATE(3)
LAMELLA_INSTANTIATE(4)
#undef LAMELLA_INSTANTIATE

}  // namespace lamella
