#pragma once

#include "core/metric/metric.h"

namespace lamella {

/// Intersection by simultaneous reduction (A.1.3.2): in the basis where both metrics are diagonal
/// the larger value of each. Its unit ball is the largest ellipsoid inside both unit balls that has
/// those axes, so (A.12) holds.
template <int D>
Metric<D> intersect(const Metric<D>& a, const Metric<D>& b);

/// The approximation (A.9)-(A.11), symmetric in a and b; (A.12) holds only roughly.
template <int D>
Metric<D> intersect_approximately(const Metric<D>& a, const Metric<D>& b);

/// Maximum coefficient by coefficient, (A.13). The thesis uses it for isotropic transition zones.
/// For D >= 3 the result need not be positive definite: check with is_spd.
template <int D>
Mat<D> maximum(const Metric<D>& a, const Metric<D>& b) {
  return a.cwiseMax(b);
}

}  // namespace lamella
