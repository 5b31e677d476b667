#pragma once

#include <random>

#include "core/metric/metric.h"

namespace lamella::test {

/// Uniform in [low, high], the same on every platform.
inline double uniform(std::mt19937& rng, double low, double high) {
  return low + (high - low) * (static_cast<double>(rng()) / 4294967295.0);
}

template <int D>
Vec<D> random_vector(std::mt19937& rng) {
  Vec<D> v;
  for (int k = 0; k < D; ++k) v[k] = uniform(rng, -1, 1);
  return v;
}

/// A rotation: orthonormal, determinant 1.
template <int D>
Mat<D> random_rotation(std::mt19937& rng) {
  Mat<D> a;
  for (int k = 0; k < D; ++k) a.col(k) = random_vector<D>(rng);
  Mat<D> q = Eigen::HouseholderQR<Mat<D>>(a).householderQ();
  if (q.determinant() < 0) q.col(0) *= -1;
  return q;
}

/// Random axes, sizes log-uniform in [1/ratio, 1].
template <int D>
Metric<D> random_metric(std::mt19937& rng, double ratio) {
  Vec<D> h;
  for (int k = 0; k < D; ++k) h[k] = std::pow(ratio, -uniform(rng, 0, 1));
  return metric_from_sizes<D>(random_rotation<D>(rng), h);
}

}  // namespace lamella::test
