#pragma once

#include <functional>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"
#include "core/natural/layer_stats.h"

namespace lamella {

/// A connected piece of wall with fewer layers than asked.
struct PlaceBelow {
  Vec<3> at = Vec<3>::Zero();  ///< mm, on the boundary, where there are fewest
  double layers = 0;           ///< there
  double area = 0;             ///< mm^2 of boundary
};

struct Layers {
  std::vector<double> at_node;    ///< [node] layers of the wall around it; NaN where not measured
  std::vector<double> at_facet;   ///< [facet] layers behind its center; NaN where not measured
  LayerStats stats;               ///< over the boundary facets' centers
  std::vector<PlaceBelow> below;  ///< places with less than n, the largest first
};

/// Layers measured back: from each boundary facet's center along its inward normal to the opposite
/// wall, the segment's length in the elements' own metric M_T (1.11), summed over the elements it
/// crosses. `asked` is n, for the share that reached it.
///
/// The unit is an edge length: n layers of structured (Kuhn) cells, however stretched, give exactly
/// n, and so does any element with one edge right across each layer. n layers as thick as the
/// height of the regular tetrahedron, sqrt(2/3) of its edge, give 0.816 n.
///
/// A place counts where the wall is thin: the far wall is parallel within 35 degrees, and the
/// segment is no longer than 1.15 times the thickness of `surface` there (the medial ball). When no
/// place is thin, all that have an opposite wall count; when none has, `places` is 0. Statistics
/// are weighted by the facets' areas. Each place passes its value on to the nodes of its facet and
/// of the elements it crosses; a node keeps the mean. Errors: usage (asked < 1), bad_input (empty
/// surface), cancelled.
Result<Layers> measure_layers(const SimplexMesh<3>& mesh, const ReferenceSurface<3>& surface,
                              int asked, int threads = 0, const Progress& progress = {});

/// The same through a boundary layer (7.3.2): from the facets of the given CAD faces (all when
/// there are none) for `thickness` mm along the inward normal, whatever lies beyond. Where the body
/// ends before, nothing is measured.
Result<Layers> measure_boundary_layer(const SimplexMesh<3>& mesh,
                                      const std::vector<std::int32_t>& faces, double thickness,
                                      int asked, int threads = 0, const Progress& progress = {});

/// The same for a body that lies anywhere in the mesh, its surface crossing elements: from points
/// on `surface`, no farther apart than a fiftieth of its diagonal, to the wall of `surface`
/// beyond. What lies outside of the mesh does not count, nor points just below which `inside` says
/// that the body is not; `at_facet` stays empty.
Result<Layers> measure_layers_within(const SimplexMesh<3>& mesh, const ReferenceSurface<3>& surface,
                                     int asked, int threads = 0, const Progress& progress = {},
                                     const std::function<bool(const Vec<3>&)>& inside = {});

}  // namespace lamella
