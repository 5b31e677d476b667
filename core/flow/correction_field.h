#pragma once

#include <memory>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/simplex_mesh.h"
#include "core/metric/metric.h"

namespace lamella {

/// A correction by a flow as a function of position, on the mesh that it was found on: it stays
/// sharp however often another mesh is adapted to it. Outside the mesh the nearest place counts.
/// Copies share their data; thread-safe.
class CorrectionField {
 public:
  CorrectionField() = default;  ///< changes nothing
  /// Adds tensors >= 0 given at the nodes, linear in between. Errors: cancelled.
  static Result<CorrectionField> adding(const SimplexMesh<3>& mesh, std::vector<Mat<3>> tensors,
                                        const Progress& progress = {});
  /// Multiplies all sizes by factors in (0, 1] given at the nodes, linear in between. Errors:
  /// cancelled.
  static Result<CorrectionField> scaling(const SimplexMesh<3>& mesh, std::vector<double> factors,
                                         const Progress& progress = {});

  bool empty() const { return !impl_; }
  /// The corrected metric at x: no size below h_min (mm) that was not below it before.
  Metric<3> apply(const Vec<3>& x, const Metric<3>& asked, double h_min) const;
  /// Of the sizes at x; 1 for tensors.
  double factor(const Vec<3>& x) const;

 private:
  struct Impl;
  static Result<CorrectionField> make(const SimplexMesh<3>& mesh, std::vector<Mat<3>> tensors,
                                      std::vector<double> factors, const Progress& progress);
  std::shared_ptr<const Impl> impl_;
};

}  // namespace lamella
