#include "core/geometry/winding.h"

#include <algorithm>
#include <numbers>
#include <numeric>

#include "core/geometry/triangles.h"

namespace lamella {

WindingNumber::WindingNumber(const std::vector<Vec<3>>& points,
                             const std::vector<std::array<std::int32_t, 3>>& facets)
    : items_(facets.size()) {
  std::iota(items_.begin(), items_.end(), 0);
  std::vector<Vec<3>> centers;
  centers.reserve(facets.size());
  for (const auto& f : facets) {
    facets_.push_back({points[f[0]], points[f[1]], points[f[2]]});
    centers.push_back((points[f[0]] + points[f[1]] + points[f[2]]) / 3);
  }
  if (facets.empty()) return;
  build(0, static_cast<std::int32_t>(facets.size()), centers);
  std::vector<std::array<Vec<3>, 3>> ordered;
  ordered.reserve(facets_.size());
  for (const std::int32_t i : items_) ordered.push_back(facets_[i]);
  facets_ = std::move(ordered);
}

void WindingNumber::build(std::int32_t begin, std::int32_t end,
                          const std::vector<Vec<3>>& centers) {
  constexpr std::int32_t kLeaf = 8;
  const std::size_t me = nodes_.size();
  nodes_.emplace_back();
  Node node;
  node.begin = begin;
  node.end = end;
  node.center = node.dipole = Vec<3>::Zero();
  double area = 0;
  Vec<3> low = Vec<3>::Constant(1e300), high = -low, middle = Vec<3>::Zero();
  for (std::int32_t i = begin; i < end; ++i) {
    const Vec<3> vector = 0.5 * facet_normal<3>(facets_[items_[i]]);
    const Vec<3>& c = centers[items_[i]];
    node.dipole += vector;
    node.center += vector.norm() * c;
    area += vector.norm();
    middle += c / (end - begin);
    low = low.cwiseMin(c);
    high = high.cwiseMax(c);
  }
  node.center = area > 0 ? Vec<3>(node.center / area) : middle;
  for (std::int32_t i = begin; i < end; ++i)
    for (const Vec<3>& p : facets_[items_[i]])
      node.radius = std::max(node.radius, (p - node.center).norm());
  if (end - begin > kLeaf) {
    int axis = 0;
    (high - low).maxCoeff(&axis);
    const std::int32_t half = begin + (end - begin) / 2;
    std::nth_element(items_.begin() + begin, items_.begin() + half, items_.begin() + end,
                     [&](std::int32_t i, std::int32_t j) {
                       const double x = centers[i][axis], y = centers[j][axis];
                       return x != y ? x < y : i < j;
                     });
    build(begin, half, centers);
    node.second = static_cast<std::int32_t>(nodes_.size());
    build(half, end, centers);
  }
  nodes_[me] = node;
}

double WindingNumber::operator()(const Vec<3>& x) const {
  constexpr double kFar = 2.5;  // radii from which a cluster counts as a dipole
  if (nodes_.empty()) return 0;
  double sum = 0;
  std::array<std::int32_t, 128> stack;
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::int32_t n = stack[--top];
    const Node& node = nodes_[n];
    const Vec<3> d = node.center - x;
    const double d2 = d.squaredNorm();
    if (d2 > kFar * kFar * node.radius * node.radius) {
      sum += node.dipole.dot(d) / (d2 * std::sqrt(d2));
    } else if (node.second > 0) {
      stack[top++] = node.second;
      stack[top++] = n + 1;
    } else {
      for (std::int32_t i = node.begin; i < node.end; ++i) sum += solid_angle(facets_[i], x);
    }
  }
  return sum / (4 * std::numbers::pi);
}

}  // namespace lamella
