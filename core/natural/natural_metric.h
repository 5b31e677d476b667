#pragma once

#include <memory>
#include <optional>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"
#include "core/metric/metric.h"

namespace lamella {

struct NaturalParams {
  int layers = 4;    ///< n
  double alpha = 1;  ///< alpha_h of (4.68)
  double h_min = 0;  ///< mm
  double h_max = 0;  ///< mm; 0: the box diagonal
  int threads = 0;   ///< 0: all cores; the result does not depend on it
};

/// What the geometric detector says of one point.
struct Natural {
  Metric<3> metric;
  double thickness = 0;  ///< 2 r of the medial ball, mm
  Vec<3> direction;      ///< unit, across the wall
};

/// The geometric detector of the natural metric (chapter 4): wall thickness and direction at any
/// point from the reference surface alone. Immutable and thread-safe after construction.
class NaturalDetector {
 public:
  explicit NaturalDetector(const ReferenceSurface<3>& surface);
  ~NaturalDetector();
  NaturalDetector(NaturalDetector&&) noexcept;

  Natural at(const Vec<3>& x, const NaturalParams& params) const;

  struct Field {
    MetricField<3> metric;          ///< [node]
    std::vector<double> thickness;  ///< [node], mm
    std::vector<Vec<3>> direction;  ///< [node]
  };
  /// At every node of the mesh. Errors: usage (n < 1, h_min > h_max), cancelled.
  Result<Field> field(const SimplexMesh<3>& mesh, const NaturalParams& params,
                      const Progress& progress = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lamella
