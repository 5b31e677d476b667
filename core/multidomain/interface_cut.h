#pragma once

#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"
#include "core/metric/metric.h"
#include "core/multidomain/partition.h"

namespace lamella {

/// Of the tolerance: borders of two zones this near to each other become one.
inline constexpr double shared_share = 0.5;

struct CutParams {
  double tolerance = 0;  ///< mm, > 0: how far an interface may lie from the borders
  double snap = 0.4;     ///< of the size across: nodes nearer to a border are moved onto it
  /// [region] mm: how far its surface, of chords of a smooth one, is from that; empty: not at all
  std::vector<double> chord_error{};
  int threads = 0;  ///< 0: all cores; the result does not depend on it
};

/// A mesh whose faces follow the borders between regions.
struct CutMesh {
  /// Elements with their region as body. Facets: the boundary, then the faces between regions, each
  /// outward from the region of lower number, with group and CAD face 0.
  SimplexMesh<3> mesh;
  MetricField<3> metric;                        ///< [node]
  std::size_t outer = 0;                        ///< facets of the boundary
  std::vector<std::array<NodeId, 2>> features;  ///< edges that lie on feature edges of the surfaces
  std::size_t snapped = 0;                      ///< nodes moved
  std::size_t added = 0;                        ///< nodes added
  std::size_t lost = 0;  ///< pieces of feature edges that could not be followed
};

/// Cuts the mesh along the borders of the partition, region after region by falling priority: nodes
/// are brought to the corners of the region's surface, edges to its feature edges, near nodes onto
/// the border, and edges that still cross it are split there. `surfaces`: the boundary of each
/// region's zone, without the background; one without facets has no features. Elements are well
/// oriented, but may be poor. Errors: cancelled.
Result<CutMesh> cut_interfaces(const SimplexMesh<3>& mesh, const MetricField<3>& metric,
                               const Partition<3>& partition,
                               const std::vector<ReferenceSurface<3>>& surfaces,
                               const CutParams& params, const Progress& progress = {},
                               const MetricFunction<3>& metric_at = {});

}  // namespace lamella
