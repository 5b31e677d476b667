#pragma once

#include <memory>
#include <vector>

#include "core/base/result.h"
#include "core/mesh/element_locator.h"
#include "core/metric/metric.h"

namespace lamella {

/// By how much sizes must be finer than asked for the layers measured back to come out right: a
/// factor that varies over the body and is learnt from each mesh of the loop.
///
/// The optimizer keeps sizes on average, and not alike everywhere: behind a thick wall or on a
/// curved one it leaves too few layers, on a plate a tenth too many. Copies share their data.
class LayerCorrection {
 public:
  LayerCorrection() = default;  ///< 1 everywhere

  /// What `before` becomes after a mesh was made with it. `layers`: [node], measured, NaN where a
  /// node has no say; `wanted`: what they should be. Does not depend on `threads` (0: all cores).
  /// Errors: cancelled.
  static Result<LayerCorrection> learn(const LayerCorrection& before, const SimplexMesh<3>& mesh,
                                       const std::vector<double>& layers, double wanted,
                                       int threads = 0, const Progress& progress = {});

  /// The factor at x, 1 where nothing is known.
  double at(const Vec<3>& x) const;
  /// The metric asked at x with the sizes that are divided, those up to twice the smallest, divided
  /// by the factor too; not below h_min, mm.
  Metric<3> apply(const Vec<3>& x, const Metric<3>& asked, double h_min) const;

 private:
  struct Field;
  std::shared_ptr<const Field> field_;
};

}  // namespace lamella
