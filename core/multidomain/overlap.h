#pragma once

#include <optional>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/multidomain/partition.h"

namespace lamella {

struct OverlapOptions {
  double gap_width = 0;            ///< mm, gaps narrower than it are looked for; 0: none
  double tolerance = 1e-3;         ///< of each volume, as a share of it
  double contact = 0;              ///< mm, what is no deeper is contact and no overlap
  std::optional<Box<3>> within{};  ///< needed where zones have no end
  int threads = 0;                 ///< 0: all cores; the report does not depend on it
};

/// Where two bodies both are.
struct Overlap {
  int first = 0, second = 0;      ///< regions of the partition, first < second
  double volume = 0;              ///< mm^3
  double error = 0;               ///< mm^3, estimated from two finenesses
  Vec<3> place = Vec<3>::Zero();  ///< the deepest point
  double depth = 0;               ///< mm, distance of the place to the nearer border
  std::optional<int> inner{};     ///< which of the two lies wholly in the other
};

/// Where two bodies face each other with nothing between them: outside of both, nearer to them than
/// to any third, on a way from one to the other shorter than the gap width.
struct Gap {
  int first = 0, second = 0;
  double volume = 0;              ///< mm^3
  double error = 0;               ///< mm^3; what lies around the rim of the gap is sampled only
  double mean_width = 0;          ///< mm
  double least_width = 0;         ///< mm
  Vec<3> place = Vec<3>::Zero();  ///< where it is narrowest
};

struct OverlapReport {
  std::vector<Overlap> overlaps;  ///< by first, then second
  std::vector<Gap> gaps;
};

/// Overlaps of the zones as they were given, whatever their priority, and gaps between them. Bodies
/// that only touch do not overlap. The work is that of the cells which the borders cross, for pairs
/// whose boxes meet. Errors: bad_input (a zone without end), cancelled.
Result<OverlapReport> find_overlaps(const Partition<3>& partition,
                                    const OverlapOptions& options = {},
                                    const Progress& progress = {});

}  // namespace lamella
