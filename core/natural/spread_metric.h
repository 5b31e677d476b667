#pragma once

#include <memory>
#include <vector>

#include "core/base/progress.h"
#include "core/metric/metric.h"

namespace lamella {

struct SpreadParams {
  double growth = 1.2;  ///< of sizes, a share of the distance, > 0
  int threads = 0;      ///< 0: all cores; the result does not depend on it
};

/// Sizes that grow from what is asked at the nodes of a mesh into what is around them, as a metric
/// at any point. Copies share their data.
///
/// The natural metric jumps where walls meet: sizes along one of them fall within a tenth of a
/// millimeter to those across the other. A sample asks at the distance d for its own directions
/// with sizes h + growth d. Of the samples whose middle sizes are alike within a factor of two the
/// nearest one has a say, and of those whose largest are. For the middle sizes distances along the
/// largest count less, by the ratio of the two: nodes are that far apart there.
class SpreadMetric {
 public:
  SpreadMetric() = default;  ///< asks for nothing

  /// `points`, `metrics`: [node], the first is the virtual one. Of one that was cancelled parts are
  /// missing.
  static SpreadMetric from(const std::vector<Vec<3>>& points, const MetricField<3>& metrics,
                           const SpreadParams& params = {}, const Progress& progress = {});

  /// The metric intersected with what comes from the samples.
  Metric<3> at(const Metric<3>& metric, const Vec<3>& x) const;

 private:
  struct Levels;
  std::shared_ptr<const Levels> levels_;
};

}  // namespace lamella
