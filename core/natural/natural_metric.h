#pragma once

#include "core/natural/thickness_detector.h"

namespace lamella {

/// What the geometric detector says of one point.
struct Natural {
  Metric<3> metric;
  double thickness = 0;  ///< 2 r of the medial ball, mm; at a re-entrant edge of the smallest
  Vec<3> direction;      ///< unit, across the wall
};

/// The geometric detector of the natural metric (chapter 4): wall thickness and direction at any
/// point from the reference surface alone. Immutable and thread-safe after construction.
class NaturalDetector : public ThicknessDetector {
 public:
  explicit NaturalDetector(const ReferenceSurface<3>& surface);
  ~NaturalDetector() override;
  NaturalDetector(NaturalDetector&&) noexcept;

  Natural at(const Vec<3>& x, const NaturalParams& params) const;

  Result<NaturalField> field(const SimplexMesh<3>& mesh, const NaturalParams& params,
                             const Progress& progress = {}) const override;
  MetricFunction<3> function(const NaturalParams& params) const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lamella
