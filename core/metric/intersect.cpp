#include "core/metric/intersect.h"

namespace lamella {
namespace {

/// V max(D, V^T other V) V^T over the eigenvectors V of m, (A.10).
template <int D>
Mat<D> raised(const Metric<D>& m, const Metric<D>& other) {
  Spectrum<D> s = spectrum<D>(m);
  for (int k = 0; k < D; ++k) {
    const Vec<D> v = s.vectors.col(k);
    s.values[k] = std::max(s.values[k], v.dot(other * v));
  }
  return s.vectors * s.values.asDiagonal() * s.vectors.transpose();
}

}  // namespace

template <int D>
Metric<D> intersect(const Metric<D>& a, const Metric<D>& b) {
  // a = L L^T; b seen from there is symmetric, and its eigenvectors reduce both.
  const Mat<D> l = a.llt().matrixL();
  const Mat<D> half = l.template triangularView<Eigen::Lower>().solve(b);
  const Mat<D> seen = l.template triangularView<Eigen::Lower>().solve(half.transpose());
  const Spectrum<D> s = spectrum<D>(Mat<D>(0.5 * (seen + seen.transpose())));
  const Mat<D> axes = l * s.vectors;
  const Vec<D> values = s.values.cwiseMax(1);
  return axes * values.asDiagonal() * axes.transpose();
}

template <int D>
Metric<D> intersect_approximately(const Metric<D>& a, const Metric<D>& b) {
  return 0.5 * (raised<D>(a, b) + raised<D>(b, a));
}

template Metric<2> intersect<2>(const Metric<2>&, const Metric<2>&);
template Metric<3> intersect<3>(const Metric<3>&, const Metric<3>&);
template Metric<4> intersect<4>(const Metric<4>&, const Metric<4>&);
template Metric<2> intersect_approximately<2>(const Metric<2>&, const Metric<2>&);
template Metric<3> intersect_approximately<3>(const Metric<3>&, const Metric<3>&);
template Metric<4> intersect_approximately<4>(const Metric<4>&, const Metric<4>&);

}  // namespace lamella
