#pragma once

#include <span>

#include "core/metric/metric.h"

namespace lamella {

/// Weighted average of metrics, ((sum w_i M_i^p) / sum w_i)^(1/p), (A.8); p = 0 is its limit, the
/// log-Euclidean average exp(sum w_i log M_i / sum w_i).
///
/// p = 1 costs no diagonalization and loses the stretching; p = -1/2 averages mesh sizes and keeps
/// it; p = 1/2 and p = -1 lie on either side. Weights must be >= 0 with a positive sum; an empty
/// list of weights means equal ones. `metrics` must not be empty.
template <int D>
Metric<D> average(std::span<const Metric<D>> metrics, double p,
                  std::span<const double> weights = {});

/// Names for the exponents worth using.
namespace mean_exponent {
inline constexpr double arithmetic = 1;
inline constexpr double root = 0.5;
inline constexpr double log_euclidean = 0;
inline constexpr double size = -0.5;
inline constexpr double harmonic = -1;
}  // namespace mean_exponent

}  // namespace lamella
