#pragma once

#include <functional>
#include <vector>

#include "core/base/result.h"
#include "core/geometry/simplex.h"

namespace lamella {

/// Symmetric positive definite matrix (definition 1.1); unit mm^-2: a vector e has the length
/// sqrt(e^T M e) in units of the asked mesh size.
template <int D>
using Metric = Mat<D>;

/// One metric a node, indexed by NodeId like SimplexMesh::points; entry 0 (the virtual node) is
/// the identity and is never read.
template <int D>
using MetricField = std::vector<Metric<D>>;

/// Metric as a function of position, thread-safe.
template <int D>
using MetricFunction = std::function<Metric<D>(const Vec<D>&)>;

/// Mesh size (mm) asked along an eigenvector, from its eigenvalue (mm^-2), and back.
inline double size_from_eigenvalue(double lambda) { return 1 / std::sqrt(lambda); }
inline double eigenvalue_from_size(double h) { return 1 / (h * h); }

/// Length of e in the metric, ||e||_M.
template <int D>
double metric_length(const Vec<D>& e, const Metric<D>& m) {
  return std::sqrt(std::max(0.0, e.dot(m * e)));
}

/// Eigenvalues (mm^-2) ascending and their unit eigenvectors as columns, det > 0, (1.1).
template <int D>
struct Spectrum {
  Vec<D> values;
  Mat<D> vectors;
};
template <int D>
Spectrum<D> spectrum(const Mat<D>& symmetric);

/// Sizes h_i (mm), ascending, asked along the eigenvectors.
template <int D>
Vec<D> sizes(const Metric<D>& m);

/// R diag(h_i^-2) R^T for orthonormal columns `axes` and sizes h (mm), (1.1).
template <int D>
Metric<D> metric_from_sizes(const Mat<D>& axes, const Vec<D>& h);

/// The metric that asks for the size h (mm) in every direction.
template <int D>
Metric<D> isotropic_metric(double h) {
  return Metric<D>::Identity() * eigenvalue_from_size(h);
}

/// M^p for any real p, (1.4). M must be positive definite.
template <int D>
Mat<D> metric_power(const Metric<D>& m, double p);
/// Matrix logarithm and exponential, the way in and out of log-Euclidean averages.
template <int D>
Mat<D> metric_log(const Metric<D>& m);
template <int D>
Metric<D> metric_exp(const Mat<D>& symmetric);

/// Finite, symmetric up to rounding and positive definite.
template <int D>
bool is_spd(const Mat<D>& m);

/// Whether the field has one metric for each of `nodes` nodes, all of them positive definite.
/// Errors: bad_input.
template <int D>
Result<void> check_metric(const MetricField<D>& metric, std::size_t nodes);

/// Point of the unit ball of M in the direction of the unit vector u of the reference sphere:
/// M^(-1/2) u, (A.1) and (A.2).
template <int D>
Vec<D> unit_ball_point(const Metric<D>& m, const Vec<D>& u) {
  return metric_power<D>(m, -0.5) * u;
}
/// The ellipse (A.1), `count` points counterclockwise from theta = 0.
std::vector<Vec<2>> unit_ball(const Metric<2>& m, int count);
/// The ellipsoid (A.2): `rings` circles of latitude (phi from -pi/2 to pi/2, both poles
/// included) of `count` points each, theta from 0; point i of ring j at [j * count + i].
std::vector<Vec<3>> unit_ball(const Metric<3>& m, int count, int rings);

/// The only metric in which the simplex is unit and equilateral, (1.11) and (1.12). The simplex
/// must not be flat.
template <int D>
Metric<D> simplex_metric(const std::array<Vec<D>, D + 1>& p);
/// Its inverse M_T^-1, without inverting anything: defined for flat simplices too.
template <int D>
Mat<D> simplex_metric_inverse(const std::array<Vec<D>, D + 1>& p);

}  // namespace lamella
