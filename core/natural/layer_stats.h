#pragma once

#include <cstddef>

namespace lamella {

/// Layers counted from wall to wall in the mesh's own metric.
struct LayerStats {
  double mean = 0;
  double p5 = 0;             ///< 5 % quantile
  double p50 = 0;            ///< median
  double share_reached = 0;  ///< share of the measured places with at least n layers, 0..1
  std::size_t places = 0;    ///< measured places
  double p95 = 0;            ///< 95 % quantile
};

}  // namespace lamella
