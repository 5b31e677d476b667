#include <algorithm>
#include <array>
#include <limits>

#include "core/optimize/star_optimizer.h"

namespace lamella {
namespace {

/// Squared metric length of a move that is not worth making, and where nothing else is left.
constexpr double idle_move2 = 1e-4, idle_place2 = 1e-6;
/// Squared metric length of a move over which the node's own metric still holds.
constexpr double short_move2 = 0.01;
/// Moves that are tried where an element is poor, of the shortest edge around.
constexpr std::array poor_moves{0.5, 0.25, 0.1, 0.03};

/// Unit vectors along the axes and all diagonals.
template <int D>
const std::vector<Vec<D>>& directions() {
  static const std::vector<Vec<D>> all = [] {
    std::vector<Vec<D>> d{Vec<D>::Zero()};
    for (int k = 0; k < D; ++k)
      for (std::size_t i = 0, n = d.size(); i < n; ++i)
        for (const double side : {-1., 1.}) d.push_back(d[i] + side * Vec<D>::Unit(k));
    d.erase(d.begin());
    for (Vec<D>& v : d) v.normalize();
    return d;
  }();
  return all;
}

}  // namespace

/// One step of Newton's method on the energy of the star, along the boundary for a boundary node.
/// The metric of the node is held. Nothing where the node is at its best already.
template <int D>
std::optional<Vec<D>> StarOptimizer<D>::newton_step(NodeId s, const BoundarySite& site) {
  const Packed<D>& own = averaged()[s];
  const auto [gradient, hessian, convex, sound] = faces_.derivatives(kernel_, topo_.points[s], own);
  if (!sound) return std::nullopt;
  Mat<D> basis;
  const int free = free_directions(site, basis);
  if (free == 0) return std::nullopt;
  Vec<D> step;
  const auto solve = [&, &gradient = gradient](const Packed<D>& h) {
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
  const double length2 = metric_[s].quad(step);
  if (length2 < (sweep_.moves_only ? idle_place2 : idle_move2)) return std::nullopt;
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
    offer(near ? Apex{0, x, metric_[s], averaged()[s], false} : new_point(x, metric_in_star(s, x)),
          site);
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
  if (sweep_.attention < 1 && cavity_worst_ < poor_quality) {
    // What keeps the worst element poor may leave one way out, wherever the center is.
    double shortest2 = std::numeric_limits<double>::infinity();
    for (NodeId n : link_) shortest2 = std::min(shortest2, metric_[s].quad(topo_.points[n] - old));
    const Eigen::LLT<Mat<D>> llt(metric_[s].full());
    for (const double part : poor_moves)
      for (const Vec<D>& d : directions<D>())
        offer_at(old + part * std::sqrt(shortest2) * Vec<D>(llt.matrixU().solve(d)));
  }
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
  if (!sweep_.strict) return;
  // The energy, of the mean metric, does not know where the densest one wants the node.
  for (const double part : {0.3, 0.1}) {
    if (site.on_feature) {
      for (int k = 0; k < 2; ++k) offer_at(old + part * (topo_.points[site.ends[k]] - old));
    } else if (site.boundary) {
      for (const auto& r : ring_) offer_at(old + part * (topo_.points[r.node] - old));
    } else {
      for (NodeId n : link_) offer_at(old + part * (topo_.points[n] - old));
    }
  }
}

#define LAMELLA_INSTANTIATE(D)                                                               \
  template std::optional<Vec<D>> StarOptimizer<D>::newton_step(NodeId, const BoundarySite&); \
  template void StarOptimizer<D>::offer_moves(NodeId, const BoundarySite&);
LAMELLA_INSTANTIATE(2)
LAMELLA_INSTANTIATE(3)
LAMELLA_INSTANTIATE(4)
#undef LAMELLA_INSTANTIATE

}  // namespace lamella
