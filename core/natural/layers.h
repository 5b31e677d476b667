#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"
#include "core/natural/layer_stats.h"

namespace lamella {

struct Layers {
  std::vector<double> at_node;  ///< [node] layers of the wall around it; NaN where not measured
  LayerStats stats;             ///< over the boundary facets' centers
};

/// Layers measured back: from each boundary facet's center along the inward wall direction to the
/// opposite wall, the segment's length in the elements' own metric M_T (1.11), summed over the
/// elements it crosses. A place counts only where the wall is thin (the far wall is a true opposite
/// wall). `asked` is n, for the share that reached it.
Result<Layers> measure_layers(const SimplexMesh<3>& mesh, const ReferenceSurface<3>& surface,
                              int asked, int threads = 0, const Progress& progress = {});

}  // namespace lamella
