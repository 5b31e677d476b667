#include "core/flow/correction.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/base/parallel.h"
#include "core/flow/indicators.h"
#include "core/geometry/bvh.h"
#include "core/mesh/quality.h"
#include "core/optimize/metric_conditioning.h"

namespace lamella {
namespace {

/// (6.27): two orders of magnitude.
constexpr double kDominance = 256;
/// The strongest tensor, but for what a corner's singularity makes of it.
constexpr double kQuantile = 0.99;

Result<void> positive(const std::optional<double>& value, const char* name) {
  if (value && !(*value > 0 && std::isfinite(*value)))
    return Error{Code::usage, std::string(name) + " is not a positive number.", ""};
  return {};
}

/// The share of the curvature in `combined_tensors`: with more the long walls get too little.
constexpr double kCurvature = 1.0 / 3;

/// Of numbers above zero; zero without any.
double strongest_of(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// `metric`, but no size below h_min that was not below it in `before`.
template <int D>
void keep_above(double h_min, const MetricField<D>& before, MetricField<D>& metric, int threads) {
  parallel_each(metric.size() - 1, threads, {}, [&](std::size_t i) {
    const double finest =
        std::max(eigenvalue_from_size(h_min), spectrum<D>(before[i + 1]).values[D - 1]);
    const Spectrum<D> found = spectrum<D>(metric[i + 1]);
    if (found.values[D - 1] <= finest) return;
    metric[i + 1] =
        found.vectors * found.values.cwiseMin(finest).asDiagonal() * found.vectors.transpose();
  });
}

template <int D>
Result<MetricField<D>> scaled_to(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                                 double elements, const std::optional<double>& h_min, int threads,
                                 const Progress& progress) {
  ConditionParams params;
  params.elements = elements;
  params.h_min = h_min;
  params.threads = threads;
  auto done = condition_metric<D>(mesh, metric, params, progress);
  if (!done) return done.error();
  return std::move(done->metric);
}

template <int D>
Result<void> check_input(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                         std::size_t field, std::size_t expected) {
  if (mesh.elements.empty()) return Error{Code::bad_input, "The mesh has no elements.", ""};
  if (field != expected)
    return Error{Code::bad_input,
                 "The field has " + std::to_string(field) + " values where the mesh has " +
                     std::to_string(expected) + ".",
                 "Use the mesh that the field was computed on."};
  return check_metric<D>(metric, mesh.node_count());
}

template <int D>
Result<void> check_uniformize(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                              const std::vector<double>& indicator,
                              const UniformizeParams& params) {
  for (const Result<void>& checked :
       {positive(params.order, "The order of convergence"), positive(params.beta, "beta"),
        positive(params.elements, "The number of elements"), positive(params.h_min, "h_min"),
        positive(params.most_change - 1, "The largest change of a size less one"),
        check_input<D>(mesh, metric, indicator.size(), mesh.elements.size())})
    if (!checked) return checked.error();
  for (const double a : indicator)
    if (!(a >= 0) || !std::isfinite(a))
      return Error{Code::bad_input, "The indicator has a value that is negative or no number.", ""};
  return {};
}

/// Of the sizes at the nodes, (5.12) and (5.14), where the mean error is to be beta times as large.
template <int D>
std::vector<double> evening_factors(const SimplexMesh<D>& mesh,
                                    const std::vector<double>& indicator, double beta,
                                    const UniformizeParams& params) {
  std::vector<double> alpha(indicator.size());
  double sum = 0;
  for (std::size_t e = 0; e < alpha.size(); ++e) {
    alpha[e] = std::pow(indicator[e], 2 / (2 * params.order + D));
    sum += std::pow(alpha[e], D);
  }
  const double global = std::pow(sum / static_cast<double>(alpha.size()), 1.0 / D);
  const double most = params.most_change;
  for (double& a : alpha)
    a = a * most > beta * global ? std::max(beta * global / a, 1 / most) : most;
  if (global == 0) std::fill(alpha.begin(), alpha.end(), beta);
  return nodal_means<D, double>(mesh, alpha, params.threads);
}

}  // namespace

template <int D>
double forecast_elements(const SimplexMesh<D>& mesh, const MetricField<D>& metric) {
  return allocation_factor<D>(mesh, metric) * static_cast<double>(mesh.elements.size());
}

template <int D>
std::vector<Mat<D>> gradient_tensors(const SimplexMesh<D>& mesh, const std::vector<double>& field,
                                     int threads) {
  const auto gradients =
      nodal_means<D, Vec<D>>(mesh, element_gradients<D>(mesh, field, threads), threads);
  std::vector<Mat<D>> out(gradients.size());
  for (std::size_t n = 0; n < out.size(); ++n) out[n] = gradients[n] * gradients[n].transpose();
  return out;
}

template <int D>
std::vector<Mat<D>> gradient_tensors(const SimplexMesh<D>& mesh, const std::vector<Vec<D>>& field,
                                     int threads) {
  auto out = nodal_means<D, Mat<D>>(mesh, element_gradients<D>(mesh, field, threads), threads);
  for (Mat<D>& g : out) g = (g.transpose() * g).eval();
  return out;
}

template <int D>
std::vector<Mat<D>> strain_tensors(const SimplexMesh<D>& mesh, const std::vector<Vec<D>>& field,
                                   int threads) {
  auto out = nodal_means<D, Mat<D>>(mesh, element_gradients<D>(mesh, field, threads), threads);
  parallel_each(out.size(), threads, {}, [&](std::size_t n) {
    const Spectrum<D> found = spectrum<D>(Mat<D>(0.5 * (out[n] + out[n].transpose())));
    out[n] = found.vectors * found.values.cwiseAbs().asDiagonal() * found.vectors.transpose();
  });
  return out;
}

template <int D>
std::vector<Mat<D>> curvature_tensors(const SimplexMesh<D>& mesh, const std::vector<Vec<D>>& field,
                                      int threads) {
  const auto gradient =
      nodal_means<D, Mat<D>>(mesh, element_gradients<D>(mesh, field, threads), threads);
  std::vector<Mat<D>> out(gradient.size(), Mat<D>::Zero());
  for (int i = 0; i < D; ++i) {
    std::vector<Vec<D>> row(gradient.size());
    for (std::size_t n = 0; n < row.size(); ++n) row[n] = gradient[n].row(i).transpose();
    const std::vector<Mat<D>> square = gradient_tensors<D>(mesh, row, threads);
    for (std::size_t n = 0; n < out.size(); ++n) out[n] += square[n];
  }
  parallel_each(out.size(), threads, {}, [&](std::size_t n) {
    const Spectrum<D> found = spectrum<D>(out[n]);
    out[n] = found.vectors * found.values.cwiseMax(0).cwiseSqrt().asDiagonal() *
             found.vectors.transpose();
  });
  return out;
}

template <int D>
std::vector<Mat<D>> combined_tensors(const SimplexMesh<D>& mesh, const std::vector<Vec<D>>& field,
                                     int threads) {
  std::vector<Mat<D>> out = gradient_tensors<D>(mesh, field, threads);
  const std::vector<Mat<D>> curvature = curvature_tensors<D>(mesh, field, threads);
  const auto strongest = [](const std::vector<Mat<D>>& tensors) {
    std::vector<double> largest(tensors.size() - 1);
    for (std::size_t n = 1; n < tensors.size(); ++n)
      largest[n - 1] = spectrum<D>(tensors[n]).values[D - 1];
    return strongest_of(std::move(largest));
  };
  const double steepest = strongest(out), most = strongest(curvature);
  Box<D> box;
  for (std::size_t n = 1; n < mesh.points.size(); ++n) box.add(mesh.points[n]);
  // Rounding alone is no curvature.
  const bool curved = most * (box.hi - box.lo).norm() > 1e-9 * std::sqrt(steepest);
  for (std::size_t n = 1; n < out.size() && steepest > 0; ++n) {
    out[n] /= steepest;
    if (curved) out[n] += kCurvature / most * curvature[n];
  }
  return out;
}

template <int D>
Result<Corrected<D>> add_tensors(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                                 const std::vector<Mat<D>>& tensors, const AddParams& params,
                                 const Progress& progress) {
  for (const Result<void>& checked :
       {positive(params.strength, "The strength"), positive(params.h_min, "h_min"),
        positive(params.elements, "The budget of elements"),
        check_input<D>(mesh, metric, tensors.size(), mesh.points.size())})
    if (!checked) return checked.error();

  std::vector<double> ratio(metric.size(), 0);
  if (!parallel_each(metric.size() - 1, params.threads, progress.portion(0, 0.2),
                     [&](std::size_t i) {
                       const double t = spectrum<D>(tensors[i + 1]).values[D - 1];
                       ratio[i + 1] = t / spectrum<D>(metric[i + 1]).values[D - 1];
                     }))
    return cancelled_error();
  for (const double r : ratio)
    if (!std::isfinite(r))
      return Error{Code::bad_input, "The field has a value that is no number.",
                   "Check the result that it comes from."};
  // Rounding alone is no variation of the field.
  const double strongest = *std::max_element(ratio.begin(), ratio.end());
  std::erase_if(ratio, [&](double r) { return r <= 1e-12 * strongest; });
  Corrected<D> out;
  out.elements_before = forecast_elements<D>(mesh, metric);
  const auto with = [&](double weight) {
    MetricField<D> sum = metric;
    for (std::size_t n = 1; n < sum.size(); ++n) sum[n] += weight * tensors[n];
    if (params.h_min) keep_above<D>(*params.h_min, metric, sum, params.threads);
    return sum;
  };
  if (ratio.empty()) {
    out.metric = metric;
  } else {
    out.weight = kDominance * params.strength * params.strength / strongest_of(ratio);
    out.metric = with(out.weight);
  }
  out.elements_after = forecast_elements<D>(mesh, out.metric);
  if (params.elements && out.elements_after > *params.elements) {
    if (out.elements_before >= *params.elements) {
      out.weight = 0;
      auto scaled = scaled_to<D>(mesh, metric, *params.elements, {}, params.threads,
                                 progress.portion(0.2, 1));
      if (!scaled) return scaled.error();
      out.metric = std::move(*scaled);
    } else {
      // The forecast rises with the weight.
      double low = 0, high = out.weight;
      constexpr int kHalvings = 40;
      for (int k = 0; k < kHalvings; ++k) {
        if (progress.cancelled()) return cancelled_error();
        const double middle = k < 20 ? 0.25 * high + 0.75 * low : 0.5 * (low + high);
        MetricField<D> tried = with(middle);
        const double elements = forecast_elements<D>(mesh, tried);
        (elements > *params.elements ? high : low) = middle;
        progress.report(0.2 + 0.8 * k / kHalvings);
        if (elements > *params.elements) continue;
        out.weight = middle;
        out.metric = std::move(tried);
        if (elements > 0.995 * *params.elements) break;
      }
      if (low == 0) {
        out.weight = 0;
        out.metric = metric;
      }
    }
    out.elements_after = forecast_elements<D>(mesh, out.metric);
  }
  progress.report(1);
  return out;
}

template <int D>
Result<Corrected<D>> uniformize(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                                const std::vector<double>& indicator,
                                const UniformizeParams& params, const Progress& progress) {
  if (Result<void> good = check_uniformize<D>(mesh, metric, indicator, params); !good)
    return good.error();
  const auto count = static_cast<double>(mesh.elements.size());
  const double beta = params.elements ? std::pow(count / *params.elements, 1.0 / D) : params.beta;
  const std::vector<double> factor = evening_factors<D>(mesh, indicator, beta, params);

  Corrected<D> out;
  out.elements_before = forecast_elements<D>(mesh, metric);
  out.metric = metric;
  for (std::size_t n = 1; n < metric.size(); ++n)
    if (factor[n] > 0) out.metric[n] *= eigenvalue_from_size(factor[n]);
  if (params.elements) {
    auto scaled =
        scaled_to<D>(mesh, out.metric, *params.elements, params.h_min, params.threads, progress);
    if (!scaled) return scaled.error();
    out.metric = std::move(*scaled);
  } else if (params.h_min) {
    keep_above<D>(*params.h_min, metric, out.metric, params.threads);
  }
  if (progress.cancelled()) return cancelled_error();
  out.elements_after = forecast_elements<D>(mesh, out.metric);
  progress.report(1);
  return out;
}

template <int D>
Result<Refined> refine_evenly(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                              const std::vector<double>& indicator, std::vector<double> factors,
                              const UniformizeParams& params, const Progress& progress) {
  if (Result<void> good = check_uniformize<D>(mesh, metric, indicator, params); !good)
    return good.error();
  if (factors.size() != mesh.points.size())
    return Error{Code::bad_input, "The factors are not those of the mesh's nodes.", ""};
  const std::vector<double> evening = evening_factors<D>(mesh, indicator, 1, params);
  for (std::size_t n = 1; n < factors.size(); ++n) factors[n] *= evening[n];

  Refined out;
  out.elements_before = forecast_elements<D>(mesh, metric);
  MetricField<D> tried;
  const auto with = [&](double beta) {
    out.factors.assign(factors.size(), 1);
    tried = metric;
    for (std::size_t n = 1; n < factors.size(); ++n) {
      if (factors[n] > 0) out.factors[n] = std::min(1.0, beta * factors[n]);
      tried[n] *= eigenvalue_from_size(out.factors[n]);
    }
    if (params.h_min) keep_above<D>(*params.h_min, metric, tried, params.threads);
    return out.elements_after = forecast_elements<D>(mesh, tried);
  };
  const double budget = params.elements.value_or(std::numeric_limits<double>::infinity());
  double low = std::log(params.beta), high = low;
  if (with(params.beta) > budget) {
    // Without any factor below 1 the forecast is that of the metric.
    for (const double f : factors)
      if (f > 0) high = std::max(high, -std::log(f));
    constexpr int kHalvings = 30;
    for (int k = 0; k < kHalvings; ++k) {
      if (progress.cancelled()) return cancelled_error();
      const double middle = 0.5 * (low + high);
      const double elements = with(std::exp(middle));
      (elements > budget ? low : high) = middle;
      progress.report(static_cast<double>(k) / kHalvings);
      if (elements <= budget && elements > 0.995 * budget) break;
    }
    with(std::exp(high));
  }
  progress.report(1);
  return out;
}

template <int D>
MetricField<D> own_metric(const SimplexMesh<D>& mesh, int threads) {
  std::vector<Mat<D>> logs(mesh.elements.size());
  parallel_each(logs.size(), threads, {}, [&](std::size_t e) {
    logs[e] = metric_log<D>(simplex_metric<D>(mesh.corners(mesh.elements[e])));
  });
  MetricField<D> out = nodal_means<D, Mat<D>>(mesh, logs, threads);
  parallel_each(out.size(), threads, {}, [&](std::size_t n) { out[n] = metric_exp<D>(out[n]); });
  return out;
}

template std::vector<Mat<2>> gradient_tensors(const SimplexMesh<2>&, const std::vector<double>&,
                                              int);
template std::vector<Mat<3>> gradient_tensors(const SimplexMesh<3>&, const std::vector<double>&,
                                              int);
template std::vector<Mat<2>> gradient_tensors(const SimplexMesh<2>&, const std::vector<Vec<2>>&,
                                              int);
template std::vector<Mat<3>> gradient_tensors(const SimplexMesh<3>&, const std::vector<Vec<3>>&,
                                              int);
template std::vector<Mat<2>> strain_tensors(const SimplexMesh<2>&, const std::vector<Vec<2>>&, int);
template std::vector<Mat<3>> strain_tensors(const SimplexMesh<3>&, const std::vector<Vec<3>>&, int);
template std::vector<Mat<2>> curvature_tensors(const SimplexMesh<2>&, const std::vector<Vec<2>>&,
                                               int);
template std::vector<Mat<3>> curvature_tensors(const SimplexMesh<3>&, const std::vector<Vec<3>>&,
                                               int);
template std::vector<Mat<2>> combined_tensors(const SimplexMesh<2>&, const std::vector<Vec<2>>&,
                                              int);
template std::vector<Mat<3>> combined_tensors(const SimplexMesh<3>&, const std::vector<Vec<3>>&,
                                              int);
template Result<Corrected<2>> add_tensors(const SimplexMesh<2>&, const MetricField<2>&,
                                          const std::vector<Mat<2>>&, const AddParams&,
                                          const Progress&);
template Result<Corrected<3>> add_tensors(const SimplexMesh<3>&, const MetricField<3>&,
                                          const std::vector<Mat<3>>&, const AddParams&,
                                          const Progress&);
template Result<Corrected<2>> uniformize(const SimplexMesh<2>&, const MetricField<2>&,
                                         const std::vector<double>&, const UniformizeParams&,
                                         const Progress&);
template Result<Corrected<3>> uniformize(const SimplexMesh<3>&, const MetricField<3>&,
                                         const std::vector<double>&, const UniformizeParams&,
                                         const Progress&);
template Result<Refined> refine_evenly(const SimplexMesh<2>&, const MetricField<2>&,
                                       const std::vector<double>&, std::vector<double>,
                                       const UniformizeParams&, const Progress&);
template Result<Refined> refine_evenly(const SimplexMesh<3>&, const MetricField<3>&,
                                       const std::vector<double>&, std::vector<double>,
                                       const UniformizeParams&, const Progress&);
template double forecast_elements(const SimplexMesh<2>&, const MetricField<2>&);
template double forecast_elements(const SimplexMesh<3>&, const MetricField<3>&);
template MetricField<2> own_metric(const SimplexMesh<2>&, int);
template MetricField<3> own_metric(const SimplexMesh<3>&, int);

}  // namespace lamella
