#pragma once

#include <Eigen/Eigenvalues>

#include "core/optimize/adapt.h"
#include "core/optimize/packed.h"

namespace lamella {

/// The quantity that is averaged instead of the metric (section 3.2.2): M, M^(1/2), M^(-1/2) or
/// log M, packed.
template <int D>
class MetricCarrier {
 public:
  explicit MetricCarrier(MetricMean mean) : mean_(mean) {}

  Packed<D> carry(const Packed<D>& metric) const {
    switch (mean_) {
      case MetricMean::m:
        return metric;
      case MetricMean::root:
        return map(metric, [](double l) { return std::sqrt(l); });
      case MetricMean::size:
        return map(metric, [](double l) { return 1 / std::sqrt(l); });
      case MetricMean::log:
        return map(metric, [](double l) { return std::log(l); });
      case MetricMean::h: {
        const Eigen::SelfAdjointEigenSolver<Mat<D>> solver(metric.full(), Eigen::EigenvaluesOnly);
        return Packed<D>::from(Mat<D>::Identity() / std::sqrt(solver.eigenvalues()[D - 1]));
      }
    }
    return metric;
  }
  Packed<D> metric(const Packed<D>& carried) const {
    switch (mean_) {
      case MetricMean::m:
        return carried;
      case MetricMean::root: {
        const Mat<D> r = carried.full();
        return Packed<D>::from(r * r);
      }
      case MetricMean::size:
      case MetricMean::h: {
        const Mat<D> r = carried.full().inverse();
        return Packed<D>::from(r * r);
      }
      case MetricMean::log:
        return map(carried, [](double l) { return std::exp(l); });
    }
    return carried;
  }

 private:
  template <class F>
  static Packed<D> map(const Packed<D>& m, F f) {
    const Eigen::SelfAdjointEigenSolver<Mat<D>> solver(m.full());
    Vec<D> l = solver.eigenvalues();
    for (int k = 0; k < D; ++k) l[k] = f(l[k]);
    return Packed<D>::from(solver.eigenvectors() * l.asDiagonal() *
                           solver.eigenvectors().transpose());
  }
  MetricMean mean_;
};

}  // namespace lamella
