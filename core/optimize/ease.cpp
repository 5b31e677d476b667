#include "core/optimize/ease.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "core/mesh/interfaces.h"
#include "core/mesh/quality.h"

namespace lamella {
namespace {

/// At most; they end when nothing moves.
constexpr int passes = 20;
/// Gain of c(T) that is worth a move.
constexpr double least_gain = 1e-3;
/// Moves that are tried, of the shortest edge around.
constexpr std::array parts{1., 0.5, 0.25, 0.1, 0.03};
/// Of the largest eigenvalue of the normals around a node: what is a direction along them all.
constexpr double flat_share = 0.01;
/// Of a direction: what must lie along the border, or it is none.
constexpr double along_share = 0.3;
/// Of the shortest edge: rounding.
constexpr double rounding = 1e-9;
/// Cosine between normals of facets on one plane.
constexpr double same_plane = 0.9999;

using Element = std::array<NodeId, 4>;

class Ease {
 public:
  Ease(SimplexMesh<3>& mesh, MetricField<3>& metric, const EaseParams& params)
      : mesh_(mesh), metric_(metric), params_(params), start_(mesh.points) {
    quality_ = element_qualities<3>(mesh, metric);
    first_.assign(mesh.points.size() + 1, 0);
    for (const Element& e : mesh.elements)
      for (const NodeId n : e) ++first_[static_cast<std::size_t>(n) + 1];
    for (std::size_t n = 1; n < first_.size(); ++n) first_[n] += first_[n - 1];
    around_.resize(first_.back());
    std::vector<std::size_t> next = first_;
    for (std::size_t e = 0; e < mesh.elements.size(); ++e)
      for (const NodeId n : mesh.elements[e]) around_[next[static_cast<std::size_t>(n)]++] = e;
    find_normals();
  }

  std::size_t run(const Progress& progress) {
    std::size_t moves = 0;
    for (int pass = 0; pass < passes; ++pass) {
      std::size_t here = 0;
      for (std::size_t e = 0; e < quality_.size(); ++e) {
        if (quality_[e] >= params_.quality) continue;
        if (progress.cancelled()) return moves;
        for (const NodeId n : mesh_.elements[e]) here += move(static_cast<std::size_t>(n));
      }
      moves += here;
      progress.report(static_cast<double>(pass + 1) / passes);
      if (here == 0) break;
    }
    return moves;
  }

 private:
  std::span<const std::size_t> star(std::size_t n) const {
    return {around_.data() + first_[n], first_[n + 1] - first_[n]};
  }
  double rated(std::size_t e) const {
    const auto corners = mesh_.corners(mesh_.elements[e]);
    if (!(signed_measure<3>(corners) > 0)) return -1;
    return quality<3>(corners, mean_metric<3>(metric_, mesh_.elements[e]));
  }
  /// The worst quality around a node, or anything that is no better than `least`.
  double worst(std::size_t n, double least) const {
    double low = 1;
    for (const std::size_t e : star(n)) {
      low = std::min(low, rated(e));
      if (low <= least) break;
    }
    return low;
  }

  /// Normals of the facets at nodes of the boundary and of interfaces, and what holds nodes of a
  /// plane where groups meet.
  void find_normals() {
    const WithInterfaces<3> listed = list_interfaces(mesh_);
    const SimplexMesh<3>& all = listed.mesh;
    normals_.resize(mesh_.points.size());
    inside_.assign(mesh_.points.size(), 1);
    std::map<std::array<NodeId, 2>, std::size_t> seen;
    for (std::size_t f = 0; f < all.facets.size(); ++f) {
      const auto& facet = all.facets[f];
      const Vec<3> normal = facet_normal<3>(all.corners(facet)).stableNormalized();
      for (int k = 0; k < 3; ++k) {
        normals_[static_cast<std::size_t>(facet[k])].push_back(normal);
        if (f < listed.outer) inside_[static_cast<std::size_t>(facet[k])] = 0;
        const auto [a, b] = std::minmax(facet[k], facet[(k + 1) % 3]);
        const auto [other, added] = seen.try_emplace({a, b}, f);
        if (added || all.facet_group[other->second] == all.facet_group[f]) continue;
        const Vec<3> before =
            facet_normal<3>(all.corners(all.facets[other->second])).stableNormalized();
        if (std::abs(before.dot(normal)) < same_plane) continue;
        const Vec<3> across = normal
                                  .cross(Vec<3>(all.points[static_cast<std::size_t>(b)] -
                                                all.points[static_cast<std::size_t>(a)]))
                                  .stableNormalized();
        for (const NodeId n : {a, b}) normals_[static_cast<std::size_t>(n)].push_back(across);
      }
    }
  }

  /// What lies along all the borders at a node.
  Mat<3> along(std::size_t n) const {
    Mat<3> free = Mat<3>::Identity();
    if (normals_[n].empty()) return free;
    Mat<3> sum = Mat<3>::Zero();
    for (const Vec<3>& v : normals_[n]) sum += v * v.transpose();
    const Eigen::SelfAdjointEigenSolver<Mat<3>> solver(sum);
    for (int k = 0; k < 3; ++k)
      if (!(solver.eigenvalues()[k] < flat_share * solver.eigenvalues()[2]))
        free -= solver.eigenvectors().col(k) * solver.eigenvectors().col(k).transpose();
    return free;
  }
  bool on_borders(std::size_t n, const Vec<3>& x, double rounded) const {
    const double most = std::max({params_.off, params_.across, rounded});
    return std::all_of(normals_[n].begin(), normals_[n].end(),
                       [&](const Vec<3>& v) { return std::abs(v.dot(x - start_[n])) <= most; });
  }

  /// The metric at x by the elements around a node as they were before it moved.
  Metric<3> averaged(std::size_t n, const Vec<3>& old, const Vec<3>& x) const {
    double best = -std::numeric_limits<double>::infinity();
    const Element* in = nullptr;
    Vec<3> weights = Vec<3>::Zero();
    for (const std::size_t e : star(n)) {
      std::array<Vec<3>, 4> p = mesh_.corners(mesh_.elements[e]);
      for (int k = 0; k < 4; ++k)
        if (static_cast<std::size_t>(mesh_.elements[e][k]) == n) p[k] = old;
      Mat<3> a;
      for (int k = 0; k < 3; ++k) a.col(k) = p[k + 1] - p[0];
      const Vec<3> w = a.inverse() * (x - p[0]);
      const double least = std::min(w.minCoeff(), 1 - w.sum());
      if (!(least > best)) continue;
      best = least;
      in = &mesh_.elements[e];
      weights = w;
    }
    if (!in) return metric_[n];
    const Vec<3> w = weights.cwiseMax(0.0);
    const double w0 = std::max(0.0, 1 - w.sum());
    Mat<3> size = Mat<3>::Zero();
    for (int k = 0; k < 4; ++k) {
      const Eigen::SelfAdjointEigenSolver<Mat<3>> solver(
          metric_[static_cast<std::size_t>((*in)[k])]);
      size += (k == 0 ? w0 : w[k - 1]) / (w0 + w.sum()) * solver.operatorInverseSqrt();
    }
    const Mat<3> root = size.inverse();
    return root * root;
  }

  bool move(std::size_t n) {
    const Vec<3> old = mesh_.points[n];
    const Metric<3> own = metric_[n];
    double before = 1, shortest = std::numeric_limits<double>::infinity();
    for (const std::size_t e : star(n)) {
      before = std::min(before, quality_[e]);
      for (const NodeId v : mesh_.elements[e])
        if (static_cast<std::size_t>(v) != n)
          shortest = std::min(shortest, (mesh_.points[static_cast<std::size_t>(v)] - old).norm());
    }
    const Mat<3> free = along(n);
    double most = before + least_gain;
    Vec<3> best = old;
    Metric<3> best_metric = own;
    const auto offer = [&](const Vec<3>& to) {
      if (!on_borders(n, to, rounding * shortest)) return;
      mesh_.points[n] = to;
      metric_[n] = own;
      if (!(worst(n, most) > most)) return;
      metric_[n] = averaged(n, old, to);
      const double now = worst(n, most);
      if (!(now > most)) return;
      most = now;
      best = to;
      best_metric = metric_[n];
    };
    for (int d = 0; d < 27; ++d) {
      const Vec<3> towards = Vec<3>(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1).stableNormalized();
      const Vec<3> way = free * towards;
      if (way.norm() > along_share)
        for (const double part : parts) offer(old + part * shortest * way.normalized());
      if (params_.across > 0 && inside_[n] && !normals_[n].empty())
        for (const double part : {1., 0.3}) offer(old + part * params_.across * towards);
    }
    mesh_.points[n] = best;
    metric_[n] = best_metric;
    if (best == old) return false;
    for (const std::size_t e : star(n)) quality_[e] = rated(e);
    return true;
  }

  SimplexMesh<3>& mesh_;
  MetricField<3>& metric_;
  const EaseParams& params_;
  const std::vector<Vec<3>> start_;           ///< [node]
  std::vector<double> quality_;               ///< [element]
  std::vector<std::size_t> first_, around_;   ///< [node] elements
  std::vector<std::vector<Vec<3>>> normals_;  ///< [node] what holds it
  std::vector<char> inside_;                  ///< [node] not on the boundary
};

}  // namespace

std::size_t ease_poor(SimplexMesh<3>& mesh, MetricField<3>& metric, const EaseParams& params,
                      const Progress& progress) {
  return Ease(mesh, metric, params).run(progress);
}

}  // namespace lamella
