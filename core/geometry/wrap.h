#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/triangles.h"

namespace lamella {

struct WrapParams {
  double spacing = 0;    ///< mm between grid planes; 0: 1/160 of the box diagonal
  double memory = 1000;  ///< MB that the grid may take: a coarser one is used above it
  /// mm that the surface may move by where its triangles are thinned out; negative: a twentieth of
  /// the spacing.
  double thinning = -1;
};

/// How far one surface lies from another at most, mm, and where.
struct Deviation {
  double distance = 0;
  Vec<3> place = Vec<3>::Zero();
};

struct Wrapped {
  Triangles surface;        ///< closed, manifold, outward, free of self-intersections
  double spacing = 0;       ///< mm, that was used
  Deviation to_file;        ///< from the wrap to the triangles it was made of, away from holes
  Deviation from_file;      ///< from those of them that bound the volume to the wrap
  double bridged_area = 0;  ///< mm^2 of the wrap that closes holes of the file
  std::size_t specks = 0;   ///< shells smaller than two cells that were dropped
};

/// A closed surface around whatever the triangles enclose, though they be open, not manifold or
/// cross each other: the boundary of where their winding number exceeds 1/2, which is the union of
/// bodies that overlap, without their common walls.
///
/// On a grid of cubes near the surface (Lorensen and Cline 1987, loops chosen by the signs of each
/// face alone, so that cells fit), with the points exactly where the file's facets cross the grid,
/// and a point at the corner or edge of the facets' planes in each cell that holds one (Kobbelt et
/// al. 2001). What would cross itself is undone there. Flat places are thinned out. Errors:
/// bad_input (nothing is enclosed at this spacing); failed; cancelled.
Result<Wrapped> wrap(const Triangles& triangles, const WrapParams& params = {},
                     const Progress& progress = {});

}  // namespace lamella
