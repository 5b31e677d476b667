#pragma once

#include <cstddef>

#include "core/base/progress.h"
#include "core/geometry/surface.h"

namespace lamella {

struct ImproveParams {
  double max_aspect = 15;    ///< longest edge over height above which a triangle is a needle
  double tolerance = 0;      ///< mm that the surface may move by where edges are flipped
  double shortest_edge = 0;  ///< mm: edges shorter than this are not split
  double growth = 4;         ///< most facets afterwards, as a multiple of those before ..
  double added = 20000;      ///< .. and most facets added: dense surfaces get no denser
};

/// Removes needles of a closed surface: flips edges inside a face where the triangles are flat to
/// `tolerance`, lets slivers below it vanish, and splits longest edges at a point on them, which
/// moves nothing. Faces, feature edges and corners are kept; the order of work is fixed. Cancel
/// ends it early with a surface as sound as any.
void improve_triangles(ReferenceSurface<3>& surface, const ImproveParams& params,
                       const Progress& progress = {});

}  // namespace lamella
