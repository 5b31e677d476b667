#include "core/metric/metric.h"

#include <algorithm>
#include <numbers>

namespace lamella {
namespace {

template <int D, class F>
Mat<D> map_spectrum(const Mat<D>& m, F f) {
  const Spectrum<D> s = spectrum<D>(m);
  Vec<D> mapped;
  for (int k = 0; k < D; ++k) mapped[k] = f(s.values[k]);
  const Mat<D> result = s.vectors * mapped.asDiagonal() * s.vectors.transpose();
  return 0.5 * (result + result.transpose());
}

/// Edge vectors from the origin of the unit equilateral simplex: U with U^T U = (I + 1 1^T) / 2.
template <int D>
Mat<D> equilateral_edges() {
  const Mat<D> gram = 0.5 * (Mat<D>::Identity() + Mat<D>::Ones());
  return gram.llt().matrixU();
}

}  // namespace

template <int D>
Spectrum<D> spectrum(const Mat<D>& symmetric) {
  // The closed formulas for 2x2 and 3x3 lose half of the digits where sizes differ by 1e4; the
  // iterative solver does not.
  const Eigen::SelfAdjointEigenSolver<Mat<D>> solver(symmetric);
  Spectrum<D> s{solver.eigenvalues(), solver.eigenvectors()};
  if (s.vectors.determinant() < 0) s.vectors.col(D - 1) *= -1;
  return s;
}

template <int D>
Vec<D> sizes(const Metric<D>& m) {
  return spectrum<D>(m).values.unaryExpr(&size_from_eigenvalue).reverse();
}

template <int D>
Metric<D> metric_from_sizes(const Mat<D>& axes, const Vec<D>& h) {
  const Vec<D> values = h.unaryExpr(&eigenvalue_from_size);
  const Mat<D> m = axes * values.asDiagonal() * axes.transpose();
  return 0.5 * (m + m.transpose());
}

template <int D>
Mat<D> metric_power(const Metric<D>& m, double p) {
  return map_spectrum<D>(m, [p](double l) { return std::pow(l, p); });
}

template <int D>
Mat<D> metric_log(const Metric<D>& m) {
  return map_spectrum<D>(m, [](double l) { return std::log(l); });
}

template <int D>
Metric<D> metric_exp(const Mat<D>& symmetric) {
  return map_spectrum<D>(symmetric, [](double l) { return std::exp(l); });
}

template <int D>
bool is_spd(const Mat<D>& m) {
  if (!m.allFinite()) return false;
  const double scale = m.cwiseAbs().maxCoeff();
  if ((m - m.transpose()).cwiseAbs().maxCoeff() > 1e-9 * scale) return false;
  return m.llt().info() == Eigen::Success;
}

template <int D>
Result<void> check_metric(const MetricField<D>& metric, std::size_t nodes) {
  if (metric.size() != nodes + 1)
    return Error{Code::bad_input,
                 "The metric has " + std::to_string(metric.empty() ? 0 : metric.size() - 1) +
                     " values for " + std::to_string(nodes) + " nodes.",
                 "Give one metric a node, in the order of the nodes."};
  for (std::size_t n = 1; n < metric.size(); ++n)
    if (!is_spd<D>(metric[n]))
      return Error{Code::bad_input,
                   "The metric of node " + std::to_string(n) + " is not positive definite.",
                   "Sizes must be positive and finite in every direction."};
  return {};
}

std::vector<Vec<2>> unit_ball(const Metric<2>& m, int count) {
  const Mat<2> root = metric_power<2>(m, -0.5);
  std::vector<Vec<2>> points(count);
  for (int i = 0; i < count; ++i) {
    const double theta = 2 * std::numbers::pi * i / count;
    points[i] = root * Vec<2>(std::cos(theta), std::sin(theta));
  }
  return points;
}

std::vector<Vec<3>> unit_ball(const Metric<3>& m, int count, int rings) {
  const Mat<3> root = metric_power<3>(m, -0.5);
  std::vector<Vec<3>> points;
  points.reserve(static_cast<std::size_t>(count) * rings);
  for (int j = 0; j < rings; ++j) {
    const double phi = std::numbers::pi * (static_cast<double>(j) / std::max(1, rings - 1) - 0.5);
    for (int i = 0; i < count; ++i) {
      const double theta = 2 * std::numbers::pi * i / count;
      points.push_back(root * Vec<3>(std::cos(theta) * std::cos(phi),
                                     std::sin(theta) * std::cos(phi), std::sin(phi)));
    }
  }
  return points;
}

template <int D>
Metric<D> simplex_metric(const std::array<Vec<D>, D + 1>& p) {
  const Mat<D> a = equilateral_edges<D>() * edge_matrix<D>(p).inverse();
  return a.transpose() * a;
}

template <int D>
Mat<D> simplex_metric_inverse(const std::array<Vec<D>, D + 1>& p) {
  // ((I + 1 1^T) / 2)^-1 = 2 (I - 1 1^T / (D + 1)): M_T^-1 is a covariance of the edge vectors.
  const Mat<D> e = edge_matrix<D>(p);
  const Vec<D> mean = e.rowwise().sum() / (D + 1);
  Mat<D> c = mean * mean.transpose();
  for (int k = 0; k < D; ++k) {
    const Vec<D> d = e.col(k) - mean;
    c += d * d.transpose();
  }
  return 2 * c;
}

#define LAMELLA_INSTANTIATE(D)                                               \
  template Spectrum<D> spectrum<D>(const Mat<D>&);                           \
  template Vec<D> sizes<D>(const Metric<D>&);                                \
  template Metric<D> metric_from_sizes<D>(const Mat<D>&, const Vec<D>&);     \
  template Mat<D> metric_power<D>(const Metric<D>&, double);                 \
  template Mat<D> metric_log<D>(const Metric<D>&);                           \
  template Metric<D> metric_exp<D>(const Mat<D>&);                           \
  template bool is_spd<D>(const Mat<D>&);                                    \
  template Result<void> check_metric<D>(const MetricField<D>&, std::size_t); \
  template Metric<D> simplex_metric<D>(const std::array<Vec<D>, D + 1>&);    \
  template Mat<D> simplex_metric_inverse<D>(const std::array<Vec<D>, D + 1>&);
LAMELLA_INSTANTIATE(2)
LAMELLA_INSTANTIATE(3)
LAMELLA_INSTANTIATE(4)
#undef LAMELLA_INSTANTIATE

}  // namespace lamella
