#pragma once

#include <cstddef>
#include <string>

#include "core/natural/layer_stats.h"

namespace lamella {

/// One line of the convergence record; iteration 0 is the first mesh.
struct IterationRecord {
  int iteration = 0;
  std::size_t nodes = 0;
  std::size_t elements = 0;
  double volume = 0;       ///< mm^3
  double quality_min = 0;  ///< worst c(T), eq. (3.7), in the metric asked
  double quality_mean = 0;
  double conformity = 0;  ///< mean of sqrt(trace(R R)), invariant form of (1.33)
  double unit_edges = 0;  ///< share of edges with length in [1/sqrt 2, sqrt 2]
  LayerStats layers;
  double layers_by_nodes = 0;  ///< (B.2), as the thesis counts them
  double seconds = 0;          ///< wall time of this iteration
  double forecast_nodes = 0;   ///< of the mesh at the end; 0 where nothing was forecast
  double forecast_memory = 0;  ///< MB its adaption takes
  std::size_t mixed = 0;       ///< elements that more than one body fills
  double flow_rate = 0;        ///< mm^3/s that enter by the gates; 0 where no flow was solved
  double flow_pressure = 0;    ///< MPa, the largest of a gate
  double interface_error = 0;  ///< largest relative L2 error (6.12) of a body's filling ratio
};

}  // namespace lamella
