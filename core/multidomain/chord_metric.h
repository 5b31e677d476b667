#pragma once

#include "core/metric/metric.h"
#include "core/multidomain/partition.h"

namespace lamella {

/// The metric with sizes along the nearest border small enough there for edges to be chords of it
/// within `tolerance` mm; away from the border they grow by the share `growth` of the distance.
/// Sharp edges of the border do not count. Thread-safe.
Metric<3> with_chords(const Metric<3>& metric, const Partition<3>& partition, const Vec<3>& x,
                      double tolerance, double growth = 0.5);

}  // namespace lamella
