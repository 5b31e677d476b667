#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/metric/metric.h"

namespace lamella {

/// Constant metric with the size h[i] (mm) along column i of the orthonormal `axes`, (A.15).
template <int D>
MetricFunction<D> cartesian_metric(const Mat<D>& axes, const Vec<D>& h);

/// Polar metric around `origin`, (A.25)-(A.27): sizes (mm) along the radius and across it; at the
/// origin h_r in all directions.
MetricFunction<2> polar_metric(const Vec<2>& origin, double h_r, double h_theta);

/// Cylindrical metric around the axis through `origin` along `axis` (any length), (A.16)-(A.19):
/// sizes (mm) along the radius, around and along the axis; on the axis h_r across it.
MetricFunction<3> cylindrical_metric(const Vec<3>& origin, const Vec<3>& axis, double h_r,
                                     double h_theta, double h_z);

/// Spherical metric around `origin` with the pole along z, (A.20)-(A.24): sizes (mm) along the
/// radius, the longitude and the latitude; on the polar axis h_phi in both tangent directions, at
/// the origin h_r in all.
MetricFunction<3> spherical_metric(const Vec<3>& origin, double h_r, double h_theta, double h_phi);

/// The same two at one place d = x - origin (mm), where sizes depend on it: h (mm) along the
/// radius, the longitude, and the axis or the latitude. `axis` is a unit vector, that of the
/// cylinder or of the poles.
Metric<3> cylindrical_metric_at(const Vec<3>& d, const Vec<3>& axis, const Vec<3>& h);
Metric<3> spherical_metric_at(const Vec<3>& d, const Vec<3>& axis, const Vec<3>& h);

/// A benchmark metric from a specification "NAME" or "NAME:key=value,key=value", lengths in mm:
/// - uniform: h = 0.1
/// - constaniso: hx, hy, hz = 0.1 along the axes
/// - linear: 0.1 along x and y; along z h0 = 0.001 at z = 0.5, growing linearly to 0.1 at 0 and 1
/// - polar-1: the same along the radius around z, thinnest at r = 0.5; 0.1 elsewhere
/// - polar-2: also 0.025 around the axis at r = 0.5, back to 0.1 at a distance of 0.1
/// - gb2d, gb2d-iso: George and Borouchaki's rectangle [0, 7] x [0, 9], and its isotropic form
/// - thinbox, thinbox-iso: the box [0, 0.1] x [0, 1]^2 with the sizes of gb2d over s = 10 in its
///   plane and ht = 0.05 across
/// In 2D, z = 0 and the block of x and y. In 4D, with t the fourth coordinate:
/// - uniform: h = 0.1
/// - constaniso: hx, hy, hz, ht = 0.1 along the axes
/// - tesseract-linear: 0.25 along x, y and z; along t h0 = 0.0025 at t = 0.5, growing linearly to
///   0.25 at 0 and 1
/// Errors: usage (a name unknown in this dimension, listing the known ones; unknown key; a value
/// that is not a positive number).
template <int D>
Result<MetricFunction<D>> named_metric(std::string_view specification);
/// The names above, of every dimension, each once and in that order.
const std::vector<std::string>& metric_names();

/// The metric at every node, entry 0 the identity.
template <int D>
MetricField<D> sample_metric(const MetricFunction<D>& metric, const std::vector<Vec<D>>& points);

}  // namespace lamella
