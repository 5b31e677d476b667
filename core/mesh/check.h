#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/validate.h"
#include "core/metric/metric.h"

namespace lamella {

/// Distribution of a sample; p5 is the value at position floor(0.05 (n - 1)) of the sorted sample,
/// and so on. All zero for an empty one.
struct Stats {
  std::size_t count = 0;
  double min = 0, p1 = 0, p5 = 0, p25 = 0, p50 = 0, p75 = 0, p95 = 0, p99 = 0, max = 0;
  double mean = 0;
};
Stats stats_of(std::vector<double> sample);

/// Everything there is to say of a mesh under a metric. Inverted elements count with a negative
/// quality; flat ones are left out of the conformity.
struct CheckReport {
  MeshReport mesh;
  int dimension = 0;
  std::size_t edges = 0;
  Stats edge_length;           ///< in the metric, `edge_length` of quality.h
  double unit_edges = 0;       ///< share of edges with length in [1/sqrt 2, sqrt 2], 0..1
  Stats mean_ratio;            ///< in the densest nodal metric, as the UGAWG defines it
  Stats mean_ratio_mean;       ///< in the mean metric (3.2)
  Stats shape;                 ///< (3.1)
  Stats quality;               ///< c(T), (3.7)
  Stats conformity;            ///< (1.32); its mean is (1.33)
  Stats conformity_invariant;  ///< sqrt(trace(R R))
  std::size_t flat = 0;        ///< elements without a measure
  double allocation = 0;       ///< (1.34)
  Stats aspect_ratio;          ///< Euclidean, `aspect_ratio` of quality.h; flat ones left out
};

/// Errors: bad_input (arrays or indices of the mesh broken, or a metric of another length),
/// cancelled. An invalid mesh with sound arrays is reported, not refused.
template <int D>
Result<CheckReport> check(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                          const Progress& progress = {});

}  // namespace lamella
