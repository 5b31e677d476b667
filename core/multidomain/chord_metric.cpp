#include "core/multidomain/chord_metric.h"

#include <numbers>

#include "core/metric/intersect.h"

namespace lamella {
namespace {

/// Of the tolerance: what the middle of an edge takes; the middle of a facet takes more.
constexpr double edge_share = 0.5;
/// Of a step along the border: how far it may rise for the border to be a parabola.
constexpr double parabola = 0.08;
/// Cosine between normals a step apart below which there is an edge between.
constexpr double sharp_turn = 0.85;

}  // namespace

Metric<3> with_chords(const Metric<3>& metric, const Partition<3>& partition, const Vec<3>& x,
                      double tolerance, double growth) {
  // Where the size along the border is h already, what lies farther than this asks for more.
  const double largest = 1 / std::sqrt(spectrum<3>(metric).values[0]);
  const double reach = largest / growth;
  const Zone<3>* zone = nullptr;
  ZoneDistance<3> near{reach};
  for (int k = 0; k < partition.background(); ++k) {
    const Box<3>& box = partition.box(k);
    if ((x - x.cwiseMax(box.lo).cwiseMin(box.hi)).norm() >= std::abs(near.distance)) continue;
    const ZoneDistance<3> d = partition.zone(k).at(x);
    if (std::abs(d.distance) < std::abs(near.distance)) {
      near = d;
      zone = &partition.zone(k);
    }
    if (d.distance < 0) break;  // the others are hidden
  }
  if (!zone || !(near.normal.squaredNorm() > 0)) return metric;
  const Vec<3> foot = x - near.distance * near.normal;
  Mat<3> axes;
  axes.col(2) = near.normal;
  axes.col(0) = near.normal.unitOrthogonal();
  axes.col(1) = near.normal.cross(axes.col(0));

  // The second fundamental form from how the border falls off on both sides in four directions.
  constexpr int directions = 4;
  double h = largest;
  std::array<double, directions> fall{};  // kappa h^2 / 8
  bool smooth = false;
  for (int i = 0; i < 12 && !smooth; ++i) {
    if (i > 0) h *= 0.6;
    smooth = true;
    double most = 0;
    for (int k = 0; k < directions; ++k) {
      const double angle = std::numbers::pi * k / directions;
      const Vec<3> t = std::cos(angle) * axes.col(0) + std::sin(angle) * axes.col(1);
      fall[k] = 0;
      for (double side : {-0.5, 0.5}) {
        const ZoneDistance<3> d = zone->at(foot + side * h * t);
        fall[k] += 0.5 * d.distance;
        most = std::max(most, std::abs(d.distance));
        smooth = smooth && d.normal.dot(near.normal) >= sharp_turn;
      }
    }
    smooth = smooth && most <= parabola * h;
  }
  if (!smooth) return metric;  // on an edge
  // Least squares of a cos^2 + 2 b cos sin + c sin^2 over the directions.
  const double mean = (fall[0] + fall[1] + fall[2] + fall[3]) / 4;
  const double half = (fall[0] - fall[2]) / 2, cross = (fall[1] - fall[3]) / 2;
  Mat<2> form;
  form << mean + half, cross, cross, mean - half;
  const Spectrum<2> principal = spectrum<2>(form);
  const double none = 1e3 * largest;
  Metric<3> chords = eigenvalue_from_size(none) * near.normal * near.normal.transpose();
  bool asks = false;
  for (int k = 0; k < 2; ++k) {
    const Vec<3> t = axes.leftCols<2>() * principal.vectors.col(k);
    const double most = std::abs(principal.values[k]);
    const double along = most > 0 ? h * std::sqrt(edge_share * tolerance / most) : none;
    const double size = std::min(none, along + growth * std::abs(near.distance));
    asks = asks || metric_length<3>(t, metric) * size < 1;
    chords += eigenvalue_from_size(size) * t * t.transpose();
  }
  return asks ? intersect<3>(metric, chords) : metric;
}

}  // namespace lamella
