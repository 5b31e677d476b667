#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/simplex_mesh.h"
#include "core/sizing/sizing_field.h"

namespace lamella {

struct MeshForecast {
  double elements = 0;
  double nodes = 0;
  double memory = 0;  ///< MB, of the adaption itself, as AdaptReport counts it
};

/// The mesh to expect with the natural metric alone, and with the sizing objects.
struct SizingForecast {
  MeshForecast natural, corrected;
  std::size_t samples = 0;  ///< places where the metric was asked
};

struct ForecastParams {
  double tolerance = 0.02;     ///< relative change of a part's share that is worth a finer look
  std::size_t samples = 8000;  ///< beyond one an element, where no further division begins
  int threads = 0;             ///< 0: all cores; the result does not depend on it
};

/// Integrates sqrt(det M) over the elements and boundary facets of `mesh`, which are divided where
/// the metric changes: (1.34) without the error of the coarse mesh. The boundary counts because
/// its nodes have elements on one side only; in thin walls that is a large share. Not counted are
/// nodes that curved boundaries need beyond the metric.
/// Errors: bad_input (no element, or a metric that is not positive definite), cancelled.
Result<SizingForecast> forecast_mesh(const SimplexMesh<3>& mesh, const MetricFunction<3>& natural,
                                     const SizingField& sizing, const ForecastParams& params = {},
                                     const Progress& progress = {});

}  // namespace lamella
