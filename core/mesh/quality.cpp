#include "core/mesh/quality.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <numbers>

namespace lamella {

template <int D>
ElementQuality element_quality(const Corners<D>& p, const Metric<D>& m) {
  const double measure = signed_measure<D>(p);
  double squares = 0;
  for (int i = 0; i <= D; ++i)
    for (int j = i + 1; j <= D; ++j) {
      const Vec<D> e = p[j] - p[i];
      squares += e.dot(m * e);
    }
  const double mean_square = squares * 2 / (D * (D + 1));
  const double size_d = std::pow(mean_square, 0.5 * D);  // h^D of (3.4)
  const double unit_measures =
      std::abs(measure) * std::sqrt(std::max(0.0, m.determinant())) / unit_simplex_measure(D);
  const double sign = measure < 0 ? -1 : 1;

  ElementQuality q;
  if (!(mean_square > 0)) return q;
  q.shape = sign * unit_measures / size_d;
  q.size = std::min(size_d, 1 / size_d);
  q.quality = std::min(q.shape, q.size);
  q.mean_ratio = sign * std::pow(unit_measures, 2.0 / D) / mean_square;
  return q;
}

template <int D>
Metric<D> mean_metric(const MetricField<D>& metric, const std::array<NodeId, D + 1>& e) {
  Metric<D> sum = Metric<D>::Zero();
  for (const NodeId v : e) sum += metric[v];
  return sum / (D + 1);
}

template <int D>
Metric<D> densest_metric(const MetricField<D>& metric, const std::array<NodeId, D + 1>& e) {
  NodeId best = e[0];
  double largest = -1;
  for (const NodeId v : e) {
    const double det = metric[v].determinant();
    if (det > largest) {
      largest = det;
      best = v;
    }
  }
  return metric[best];
}

double edge_length(double la, double lb) {
  // Where both nearly agree the quotient is 0/0; the mean differs from it by a relative
  // (1 - la/lb)^2 / 12.
  const double larger = std::max(la, lb);
  if (std::abs(la - lb) <= 1e-3 * larger) return 0.5 * (la + lb);
  return (la - lb) / std::log(la / lb);
}

bool is_unit_length(double length) {
  return length >= std::numbers::sqrt2 / 2 && length <= std::numbers::sqrt2;
}

template <int D>
Conformity conformity(const Corners<D>& p, const Metric<D>& m) {
  const Mat<D> own_inverse = simplex_metric_inverse<D>(p), own = simplex_metric<D>(p);
  const Mat<D> r = own_inverse * m + m.inverse() * own - 2 * Mat<D>::Identity();
  // R is similar to C + C^-1 - 2 I with C = G^T M G and M_T^-1 = G G^T, symmetric, which is
  // S C^-1 S with S = C - I: no difference of nearly equal numbers but that of the metrics.
  const Mat<D> g = own_inverse.llt().matrixL();
  const Mat<D> c = g.transpose() * m * g, s = g.transpose() * (m - own) * g;
  return {r.norm(), (s * c.inverse() * s).norm()};
}

template <int D>
double allocation_factor(const SimplexMesh<D>& mesh, const MetricField<D>& metric) {
  // The product of sqrt(lambda(M') / lambda(M_T)) is |T| sqrt(det M') / |T_eq|.
  double sum = 0;
  for (const auto& e : mesh.elements)
    sum += std::abs(signed_measure<D>(mesh.corners(e))) *
           std::sqrt(std::max(0.0, mean_metric<D>(metric, e).determinant()));
  if (mesh.elements.empty()) return 0;
  return sum / unit_simplex_measure(D) / static_cast<double>(mesh.elements.size());
}

template <int D>
double aspect_ratio(const Corners<D>& p) {
  double longest2 = 0;
  for (int i = 0; i <= D; ++i)
    for (int j = i + 1; j <= D; ++j) longest2 = std::max(longest2, (p[j] - p[i]).squaredNorm());
  double largest_face = 0;  // (D-1)! times the measure of the face opposite to the least height
  for (int k = 0; k <= D; ++k) {
    std::array<Vec<D>, D> f;
    for (int i = 0, j = 0; i <= D; ++i)
      if (i != k) f[j++] = p[i];
    largest_face = std::max(largest_face, facet_normal<D>(f).norm());
  }
  const double det = std::abs(signed_measure<D>(p)) * factorial(D);
  if (!(det > 0)) return std::numeric_limits<double>::infinity();
  return std::sqrt(2.0 * D / (D + 1) * longest2) * largest_face / det;
}

template <int D>
std::vector<double> element_qualities(const SimplexMesh<D>& mesh, const MetricField<D>& metric) {
  std::vector<double> q(mesh.elements.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, q.size(), 1024), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      q[i] = quality<D>(mesh.corners(mesh.elements[i]), mean_metric<D>(metric, mesh.elements[i]));
  });
  return q;
}

#define LAMELLA_INSTANTIATE(D)                                                                   \
  template ElementQuality element_quality<D>(const Corners<D>&, const Metric<D>&);               \
  template Metric<D> mean_metric<D>(const MetricField<D>&, const std::array<NodeId, D + 1>&);    \
  template Metric<D> densest_metric<D>(const MetricField<D>&, const std::array<NodeId, D + 1>&); \
  template Conformity conformity<D>(const Corners<D>&, const Metric<D>&);                        \
  template double allocation_factor<D>(const SimplexMesh<D>&, const MetricField<D>&);            \
  template double aspect_ratio<D>(const Corners<D>&);                                            \
  template std::vector<double> element_qualities<D>(const SimplexMesh<D>&, const MetricField<D>&);
LAMELLA_INSTANTIATE(2)
LAMELLA_INSTANTIATE(3)
LAMELLA_INSTANTIATE(4)
#undef LAMELLA_INSTANTIATE

}  // namespace lamella
