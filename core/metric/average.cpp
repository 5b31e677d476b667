#include "core/metric/average.h"

#include <cassert>

namespace lamella {

template <int D>
Metric<D> average(std::span<const Metric<D>> metrics, double p, std::span<const double> weights) {
  assert(!metrics.empty() && (weights.empty() || weights.size() == metrics.size()));
  Mat<D> sum = Mat<D>::Zero();
  double total = 0;
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    const double w = weights.empty() ? 1 : weights[i];
    if (w == 0) continue;
    total += w;
    if (p == 1)
      sum += w * metrics[i];
    else
      sum += w * (p == 0 ? metric_log<D>(metrics[i]) : metric_power<D>(metrics[i], p));
  }
  sum /= total;
  if (p == 1) return sum;
  return p == 0 ? metric_exp<D>(sum) : metric_power<D>(sum, 1 / p);
}

template Metric<2> average<2>(std::span<const Metric<2>>, double, std::span<const double>);
template Metric<3> average<3>(std::span<const Metric<3>>, double, std::span<const double>);
template Metric<4> average<4>(std::span<const Metric<4>>, double, std::span<const double>);

}  // namespace lamella
