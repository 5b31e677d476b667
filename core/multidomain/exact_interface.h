#pragma once

#include "core/multidomain/chord_metric.h"
#include "core/multidomain/partition.h"
#include "core/optimize/adapt.h"

namespace lamella {

struct ExactParams {
  /// Of the mesh that was cut; its chord tolerance holds for the interfaces too.
  AdaptParams adapt;
  double snap = 0.4;  ///< of the size across: nodes nearer to a border are moved onto it
  std::vector<double> chord_error{};  ///< [region] mm, see CutParams
  /// The boundary of the domain, with the CAD faces of the mesh; null: that of the mesh is plane
  /// enough to be its own reference.
  const ReferenceSurface<3>* wall = nullptr;
};

/// A mesh every element of which belongs to one region.
struct Exact {
  /// The regions as bodies. Facets: the boundary and the interfaces, these in a group
  /// "region|region" for each pair and with the CAD face of `surface` that they lie on.
  SimplexMesh<3> mesh;
  MetricField<3> metric;  ///< [node]
  /// The boundary of the domain, then the surfaces of the regions, their faces numbered on, with
  /// the lines where interfaces meet each other and the boundary: what holds the mesh when it is
  /// adapted again, the background dropped or not.
  ReferenceSurface<3> surface;
  std::vector<std::int32_t> first_face;  ///< [region] in `surface`, the background left out
  std::size_t snapped = 0;               ///< nodes moved onto borders
  std::size_t added = 0;                 ///< nodes added on borders
  std::size_t lost = 0;                  ///< pieces of feature edges that could not be followed
  /// What the borders' curves and details ask for, at a share of the chord tolerance.
  std::shared_ptr<const ChordField> chords;
  AdaptReport adapt;
};

/// From any mesh of the domain (one body) to a conforming mesh of the regions: it is adapted to the
/// metric, with sizes along the borders small enough for the chord tolerance (chord_metric.h), once
/// or twice, then cut along the borders (interface_cut.h), then adapted again with the interfaces
/// held on `surfaces` within the chord tolerance. Around elements that stay below a quality of .2
/// the mesh is made finer and cut anew, some times and unless they are many; the mesh that falls
/// short least counts. `metric` may be empty where there is `metric_at`.
/// `surfaces`: the boundary of each region's zone, without the background; what a region without
/// facets cuts out is its surface itself. Boundary nodes move in the boundary only. A cancel after
/// the first cut returns the valid mesh reached so far, with `adapt.cancelled` set. Errors:
/// bad_input (sizes of arrays, no elements), cancelled, memory.
Result<Exact> exact_interfaces(const SimplexMesh<3>& mesh, const MetricField<3>& metric,
                               const Partition<3>& partition,
                               const std::vector<ReferenceSurface<3>>& surfaces,
                               const ExactParams& params = {}, const Progress& progress = {},
                               const MetricFunction<3>& metric_at = {});

}  // namespace lamella
