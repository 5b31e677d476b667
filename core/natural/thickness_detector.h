#pragma once

#include <memory>
#include <optional>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"
#include "core/metric/metric.h"
#include "core/natural/detector.h"

namespace lamella {

struct NaturalParams {
  int layers = 4;    ///< n, or n1 of section 4.4.3
  double alpha = 1;  ///< alpha_h of (4.68), or alpha1
  /// n2, for sizes up to (1 + alpha1 + alpha2) h1; unset: as those beyond.
  std::optional<int> layers2{};
  double alpha2 = 0;
  std::optional<int> layers3{};  ///< n3, for sizes beyond; unset: not divided
  double h_min = 0;              ///< mm
  double h_max = 0;              ///< mm; 0: the box diagonal
  double max_anisotropy = 0;     ///< largest over smallest size of a wall, >= 1; 0: no bound
  int threads = 0;               ///< 0: all cores; the result does not depend on it
};

/// Errors: usage (n, n2 or n3 < 1, alpha or alpha2 < 0, h_min > h_max, a bound of anisotropy below
/// 1).
Result<void> check_params(const NaturalParams& params);

struct NaturalField {
  MetricField<3> metric;          ///< [node]
  std::vector<double> thickness;  ///< [node], mm
  std::vector<Vec<3>> direction;  ///< [node], unit, across the wall
};

/// The natural metric (chapter 4) at the nodes of a mesh. Immutable and thread-safe.
class ThicknessDetector {
 public:
  virtual ~ThicknessDetector() = default;
  /// Errors: those of `check_params`; bad_input (nothing to measure walls on), cancelled.
  virtual Result<NaturalField> field(const SimplexMesh<3>& mesh, const NaturalParams& params,
                                     const Progress& progress = {}) const = 0;
  /// The same answer at any point, valid as long as the detector; empty where it needs a mesh.
  virtual MetricFunction<3> function(const NaturalParams&) const { return {}; }
};

/// The surface is copied.
std::unique_ptr<ThicknessDetector> make_detector(Detector kind, const ReferenceSurface<3>& surface);

}  // namespace lamella
