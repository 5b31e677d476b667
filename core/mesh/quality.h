#pragma once

#include "core/mesh/simplex_mesh.h"
#include "core/metric/metric.h"

namespace lamella {

/// Corners of a D-simplex, mm.
template <int D>
using Corners = std::array<Vec<D>, D + 1>;

/// Criteria of one element in a constant metric. Those that contain the measure carry its sign:
/// an inverted element is negative, a flat one zero.
struct ElementQuality {
  double shape = 0;       ///< (3.1) with (3.5): 1 when equilateral in the metric
  double size = 0;        ///< (3.6): 1 when the mean edge is unit, below 1 otherwise
  double quality = 0;     ///< c(T) = min(shape, size), (3.7)
  double mean_ratio = 0;  ///< (|T|_M / |T_eq|)^(2/D) / mean of squared edge lengths
};
template <int D>
ElementQuality element_quality(const Corners<D>& p, const Metric<D>& m);

/// c(T) of (3.7) alone.
template <int D>
double quality(const Corners<D>& p, const Metric<D>& m) {
  return element_quality<D>(p, m).quality;
}

/// The metric of an element: the mean of M over its nodes, (3.2). It is also the exact mean (1.30)
/// of a field that is linear on the element.
template <int D>
Metric<D> mean_metric(const MetricField<D>& metric, const std::array<NodeId, D + 1>& e);
/// The nodal metric of largest determinant (the first of equals): the one of the UGAWG mean ratio.
template <int D>
Metric<D> densest_metric(const MetricField<D>& metric, const std::array<NodeId, D + 1>& e);

/// Length of an edge whose length is la in the metric of one end and lb in that of the other, where
/// sizes vary geometrically between: (la - lb) / ln(la / lb).
double edge_length(double la, double lb);
template <int D>
double edge_length(const Vec<D>& edge, const Metric<D>& ma, const Metric<D>& mb) {
  return edge_length(metric_length<D>(edge, ma), metric_length<D>(edge, mb));
}
/// A length within [1/sqrt 2, sqrt 2].
bool is_unit_length(double length);

/// Distance of an element's own metric M_T (1.11) to the metric asked; 0 when equal.
struct Conformity {
  double frobenius = 0;  ///< sqrt(trace(R^T R)), (1.31) and (1.32): not affine invariant
  double invariant = 0;  ///< sqrt(trace(R R)): unchanged by an affine map of mesh and metric
};
/// The element must not be flat.
template <int D>
Conformity conformity(const Corners<D>& p, const Metric<D>& m);

/// Growth of the number of elements that the metric asks for, (1.34): the mean over the elements of
/// |T|_M / |T_eq|. Times the number of elements it forecasts the adapted mesh, from above.
template <int D>
double allocation_factor(const SimplexMesh<D>& mesh, const MetricField<D>& metric);

/// Euclidean aspect ratio sqrt(2 D / (D + 1)) times longest edge over smallest height; in 3D
/// sqrt(1.5) Lmax / hmin, which injection molding solvers bound by 50. The best element has
/// 2 D / (D + 1). Infinite when flat.
template <int D>
double aspect_ratio(const Corners<D>& p);

/// c(T) of every element under a nodal metric, [element].
template <int D>
std::vector<double> element_qualities(const SimplexMesh<D>& mesh, const MetricField<D>& metric);

}  // namespace lamella
