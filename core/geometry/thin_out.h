#pragma once

#include "core/base/progress.h"
#include "core/geometry/triangles.h"

namespace lamella {

struct ThinOutParams {
  double tolerance = 0;  ///< mm that the surface may move by
  double longest = 0;    ///< mm: no longer edges are made; 0: no bound
};

/// Takes vertices out of a closed manifold surface where what remains stays within the tolerance: a
/// vertex is drawn onto a neighbor, so that none moves. The surface stays closed, manifold and free
/// of self-intersections if it was; triangles get no worse than 1 : 12 by it. Points that are no
/// longer used stay in the list. Cancel ends it early with a surface as sound as any.
void thin_out(Triangles& surface, const ThinOutParams& params, const Progress& progress = {});

}  // namespace lamella
