#pragma once

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "core/base/progress.h"
#include "core/geometry/locator.h"
#include "core/metric/metric.h"
#include "core/multidomain/partition.h"

namespace lamella {

struct ChordParams {
  double tolerance = 0;  ///< mm
  double growth = 0.5;   ///< of sizes along the border, a share of the distance from it
  double smallest = 0;   ///< mm, no size along the border is below
  int threads = 0;       ///< 0: all cores
  /// Of the distance between two re-entrant edges: the largest size from one to the other.
  double between_reentrant = 1;
};

/// A metric with sizes along all that is curved in the surfaces of the zones small enough for edges
/// to be chords of it within the tolerance, wherever the nearest border is: a fillet makes sizes
/// small around it too. Away from the border they grow; the size across is small enough for them to
/// grow to no more than 2.5 times within it. Sharp edges do not count as curved, but details do,
/// whose edges the mesh has to follow: along a feature edge from corner to corner sizes are at most
/// its length, and between edges that have no corner in common at most their distance, or a share
/// of it where both are re-entrant: what is between may be a throat. Zones without a surface ask
/// for nothing. Immutable and thread-safe. Of one that was cancelled while it was made parts are
/// missing.
class ChordField {
 public:
  ChordField(const Partition<3>& partition, const std::vector<ReferenceSurface<3>>& surfaces,
             const ChordParams& params, const Progress& progress = {});
  /// Of the surface of a single body.
  static ChordField of_body(const ReferenceSurface<3>& surface, const ChordParams& params,
                            const Progress& progress = {});
  Metric<3> at(const Metric<3>& metric, const Vec<3>& x) const;

  /// Sizes along a border at a point of it, the smaller first.
  struct Curved {
    Vec<3> normal;
    std::array<Vec<3>, 2> direction;
    std::array<double, 2> size;
    Metric<3> at(const Metric<3>& metric, double distance, double growth) const;
  };

 private:
  /// Facets whose sizes are alike.
  struct Level {
    ReferenceSurface<3> surface;
    std::vector<Curved> curved;  ///< [facet]
    double least = 0;            ///< mm, that sizes are not below
    std::unique_ptr<const Locator<3>> locator;

    void add(const std::array<Vec<3>, 3>& facet, const Curved& asked);
  };
  /// By the power of two of the smallest size.
  using Levels = std::map<int, Level>;
  static void add_details(const ReferenceSurface<3>& surface, const Partition<3>& partition,
                          const Zone<3>& zone, const ChordParams& params, double largest,
                          const Progress& progress, Levels& levels);

  std::vector<Level> levels_;
  double growth_;
};

}  // namespace lamella
