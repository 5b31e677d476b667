#include "core/mesh/element_locator.h"

#include <numeric>

#include "core/geometry/bvh.h"
#include "core/mesh/boundary.h"

namespace lamella {
namespace {

/// Below this the least weight of a point means outside, not rounding.
constexpr double kRounding = 1e-6;

/// Weights of x in the simplex p: x = sum w_k p_k. Not finite when it is flat.
template <int D>
std::array<double, D + 1> barycentric(const std::array<Vec<D>, D + 1>& p, const Vec<D>& x) {
  const Vec<D> tail = edge_matrix<D>(p).inverse() * (x - p[0]);
  std::array<double, D + 1> w;
  w[0] = 1 - tail.sum();
  for (int k = 0; k < D; ++k) w[k + 1] = tail[k];
  return w;
}

/// Nearest point of the simplex of N vertices in R^D.
template <int N>
struct Foot {
  std::array<double, N> weights{};
  double distance2 = std::numeric_limits<double>::infinity();
};

template <int D, int N>
Foot<N> nearest_on(const std::array<Vec<D>, N>& p, const Vec<D>& x) {
  Foot<N> foot;
  if constexpr (N == 1) {
    foot.weights[0] = 1;
    foot.distance2 = (x - p[0]).squaredNorm();
  } else {
    Eigen::Matrix<double, D, N - 1> a;
    for (int k = 0; k + 1 < N; ++k) a.col(k) = p[k + 1] - p[0];
    const Eigen::Matrix<double, N - 1, N - 1> gram = a.transpose() * a;
    const Eigen::Matrix<double, N - 1, 1> tail = gram.inverse() * (a.transpose() * (x - p[0]));
    const bool flat = !tail.allFinite();
    foot.weights[0] = 1 - tail.sum();
    for (int k = 0; k + 1 < N; ++k) foot.weights[k + 1] = tail[k];
    if (!flat && *std::min_element(foot.weights.begin(), foot.weights.end()) >= 0) {
      foot.distance2 = (x - p[0] - a * tail).squaredNorm();
      return foot;
    }
    // The foot lies on a side opposite to one of the vertices that the plane's foot is beyond.
    const auto plane = foot.weights;
    for (int out = 0; out < N; ++out) {
      if (!flat && plane[out] >= 0) continue;
      std::array<Vec<D>, N - 1> side;
      for (int k = 0, j = 0; k < N; ++k)
        if (k != out) side[j++] = p[k];
      const Foot<N - 1> lower = nearest_on<D, N - 1>(side, x);
      if (!(lower.distance2 < foot.distance2)) continue;
      foot.distance2 = lower.distance2;
      for (int k = 0, j = 0; k < N; ++k) foot.weights[k] = k == out ? 0 : lower.weights[j++];
    }
  }
  return foot;
}

}  // namespace

template <int D>
struct ElementLocator<D>::Impl {
  std::vector<Vec<D>> points;
  std::vector<typename SimplexMesh<D>::Element> elements;
  std::vector<BoundaryFace<D>> boundary;
  Bvh<D> element_tree, boundary_tree;
  typename Bvh<D>::Ref element_root, boundary_root;
  double reach2 = 0;  ///< mm^2 around a box that still counts as in it

  Impl(const SimplexMesh<D>& mesh, const Progress& progress)
      : points(mesh.points),
        elements(mesh.elements),
        boundary(boundary_faces<D>(mesh.elements, mesh.points.size())) {
    Box<D> all;
    for (std::size_t n = 1; n < points.size(); ++n) all.add(points[n]);
    reach2 = 1e-18 * (all.hi - all.lo).squaredNorm();
    const Vec<D> center = 0.5 * (all.lo + all.hi);
    element_tree = Bvh<D>(center);
    boundary_tree = Bvh<D>(center);
    element_root = plant(
        element_tree, elements.size(), [&](std::size_t i) { return elements[i]; }, progress);
    progress.report(0.9);
    boundary_root = plant(
        boundary_tree, boundary.size(), [&](std::size_t i) { return boundary[i].facet; }, progress);
    progress.report(1);
  }

  template <class Nodes>
  typename Bvh<D>::Ref plant(Bvh<D>& tree, std::size_t count, Nodes nodes,
                             const Progress& progress) const {
    std::vector<Box<D>> boxes(count);
    for (std::size_t i = 0; i < count; ++i)
      for (const NodeId n : nodes(i)) boxes[i].add(points[n]);
    std::vector<std::int32_t> items(count);
    std::iota(items.begin(), items.end(), 0);
    return tree.build(boxes, items, progress);
  }

  template <std::size_t N>
  std::array<Vec<D>, N> corners(const std::array<NodeId, N>& nodes) const {
    std::array<Vec<D>, N> p;
    for (std::size_t k = 0; k < N; ++k) p[k] = points[nodes[k]];
    return p;
  }

  /// The element with the largest least weight of those around x; the first that contains x.
  Located<D> within(const Vec<D>& x) const {
    Located<D> best;
    double best_least = -std::numeric_limits<double>::infinity();
    double bound2 = reach2;
    element_tree.near(element_root, x, bound2, [&](std::int32_t block) {
      const auto* item = &element_tree.order()[static_cast<std::size_t>(block) * Bvh<D>::kWide];
      for (int k = 0; k < Bvh<D>::kWide; ++k) {
        if (k > 0 && item[k] == item[k - 1]) break;
        const auto w = barycentric<D>(corners(elements[item[k]]), x);
        const double least = *std::min_element(w.begin(), w.end());
        if (!(least > best_least)) continue;
        best_least = least;
        best.element = item[k];
        best.weights = w;
        if (least < 0) continue;
        bound2 = 0;
        break;
      }
    });
    best.inside = best_least >= -kRounding;
    return best;
  }

  Located<D> nearest(const Vec<D>& x) const {
    Located<D> best;
    best.distance2 = std::numeric_limits<double>::infinity();
    double bound2 = best.distance2;
    boundary_tree.near(boundary_root, x, bound2, [&](std::int32_t block) {
      const auto* item = &boundary_tree.order()[static_cast<std::size_t>(block) * Bvh<D>::kWide];
      for (int k = 0; k < Bvh<D>::kWide; ++k) {
        if (k > 0 && item[k] == item[k - 1]) break;
        const BoundaryFace<D>& face = boundary[item[k]];
        const Foot<D> foot = nearest_on<D, D>(corners(face.facet), x);
        if (!(foot.distance2 < best.distance2)) continue;
        bound2 = best.distance2 = foot.distance2;
        best.element = face.element;
        const auto& e = elements[face.element];
        best.weights.fill(0);
        for (int i = 0; i < D; ++i)
          best.weights[std::find(e.begin(), e.end(), face.facet[i]) - e.begin()] = foot.weights[i];
      }
    });
    return best;
  }
};

template <int D>
ElementLocator<D>::ElementLocator(const SimplexMesh<D>& mesh, const Progress& progress)
    : impl_(std::make_unique<Impl>(mesh, progress)) {}
template <int D>
ElementLocator<D>::~ElementLocator() = default;
template <int D>
ElementLocator<D>::ElementLocator(ElementLocator&&) noexcept = default;

template <int D>
Located<D> ElementLocator<D>::locate(const Vec<D>& x) const {
  Located<D> found = impl_->within(x);
  if (!found.inside) return impl_->nearest(x);
  double sum = 0;
  for (double& w : found.weights) sum += w = std::max(0.0, w);
  for (double& w : found.weights) w /= sum;
  return found;
}

template class ElementLocator<2>;
template class ElementLocator<3>;
template class ElementLocator<4>;

}  // namespace lamella
