#pragma once

#include <optional>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/simplex_mesh.h"
#include "core/metric/metric.h"

namespace lamella {

/// Corrections of a metric by a field at the nodes of its mesh (chapter 5): the flow's, or what any
/// solver has found there.

/// Tensors at the nodes, >= 0, that ask for small sizes where a field varies. By the mean gradient
/// at each node: of a scalar u, grad u (x) grad u (5.6).
template <int D>
std::vector<Mat<D>> gradient_tensors(const SimplexMesh<D>& mesh, const std::vector<double>& field,
                                     int threads = 0);
/// Of a vector, (grad u)^T grad u (5.7).
template <int D>
std::vector<Mat<D>> gradient_tensors(const SimplexMesh<D>& mesh, const std::vector<Vec<D>>& field,
                                     int threads = 0);
/// eps(u) (5.8), its eigenvalues by their absolute values: stretching counts like compression.
template <int D>
std::vector<Mat<D>> strain_tensors(const SimplexMesh<D>& mesh, const std::vector<Vec<D>>& field,
                                   int threads = 0);

/// |H|, the root of the sum of the squared matrices of second derivatives of the components: what
/// the gradient of a P1 field misses.
template <int D>
std::vector<Mat<D>> curvature_tensors(const SimplexMesh<D>& mesh, const std::vector<Vec<D>>& field,
                                      int threads = 0);
/// Of a velocity, (5.7) and a third of |H|, each over its strongest (the quantile .99 of its
/// largest eigenvalue): layers in long walls and small elements at corners at once.
template <int D>
std::vector<Mat<D>> combined_tensors(const SimplexMesh<D>& mesh, const std::vector<Vec<D>>& field,
                                     int threads = 0);

template <int D>
struct Corrected {
  MetricField<D> metric;                           ///< [node]
  double weight = 0;                               ///< mu^2 of the tensors added
  double elements_before = 0, elements_after = 0;  ///< forecast (1.34)
};

struct AddParams {
  double strength = 1;               ///< of mu, > 0
  std::optional<double> h_min{};     ///< mm; nothing gets finer by the correction
  std::optional<double> elements{};  ///< budget: mu falls until the forecast is within it; if the
                                     ///< metric alone exceeds it, all sizes grow
  int threads = 0;
};

/// M + mu^2 T (5.6). mu is one number for the whole field, after the rule of (6.27): where T is
/// strongest against M, which is taken as the quantile .99 over the nodes with T, its largest
/// eigenvalue times mu^2 is 256 strength^2 times that of M.
/// Errors: usage (strength, h_min or budget not positive), bad_input (fields of another length, a
/// matrix that is no metric), cancelled.
template <int D>
Result<Corrected<D>> add_tensors(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                                 const std::vector<Mat<D>>& tensors, const AddParams& params = {},
                                 const Progress& progress = {});

/// The strategies of section 5.2.1.2: beta = 1 smooths the error at the elements there are, beta
/// < 1 also lowers it by that factor, `elements` does so as far as they go, beta > 1 raises it.
struct UniformizeParams {
  double order = 1;                  ///< p, of convergence of the error with the size, > 0
  double beta = 1;                   ///< > 0
  std::optional<double> elements{};  ///< card(T) imposed, in place of beta
  double most_change = 4;            ///< of a size, either way, > 1
  std::optional<double> h_min{};     ///< mm
  int threads = 0;
};

/// Scales the sizes of a metric such that an error indicator of the elements, >= 0, becomes the
/// same everywhere, (5.9)-(5.20), directions and ratios of sizes staying. (5.15) lacks the root
/// that (5.14) has: the global error is ((1 / card) sum alpha^d)^(1/d). With `elements` the metric
/// returned forecasts that number.
/// Errors: as `add_tensors`.
template <int D>
Result<Corrected<D>> uniformize(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                                const std::vector<double>& indicator,
                                const UniformizeParams& params = {}, const Progress& progress = {});

struct Refined {
  std::vector<double> factors;                     ///< [node] of all sizes, in (0, 1]
  double elements_before = 0, elements_after = 0;  ///< forecast (1.34)
};

/// The same by refinement alone: `factors`, [node] those that the mesh was made with, times what
/// evens the indicator out, but never above 1, so that no size grows beyond that of `metric`, which
/// is asked without them. `elements` is a budget here: beta grows until the forecast is within it.
/// Errors: as `add_tensors`.
template <int D>
Result<Refined> refine_evenly(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                              const std::vector<double>& indicator, std::vector<double> factors,
                              const UniformizeParams& params = {}, const Progress& progress = {});

/// The elements (1.34) that a metric at the nodes of a mesh asks for.
template <int D>
double forecast_elements(const SimplexMesh<D>& mesh, const MetricField<D>& metric);

/// The metric that a mesh already is: at each node the log-Euclidean mean of the elements' own
/// metrics M_T (1.11).
template <int D>
MetricField<D> own_metric(const SimplexMesh<D>& mesh, int threads = 0);

}  // namespace lamella
