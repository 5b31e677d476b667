#pragma once

#include <cstddef>

#include "core/base/progress.h"
#include "core/geometry/surface.h"

namespace lamella {

struct SelfIntersections {
  std::size_t pairs = 0;          ///< pairs of facets that cross or fold onto each other
  Vec<3> place = Vec<3>::Zero();  ///< a vertex of the first pair
};

/// Pairs of facets that properly cross, or that fold onto each other at a common edge. Facets that
/// only touch are not counted. Cancel ends the search: what was found by then comes back, and the
/// caller asks `progress` before believing it.
SelfIntersections find_self_intersections(const ReferenceSurface<3>& surface,
                                          const Progress& progress = {});

/// The pairs themselves, in the order of their facets; searched on all cores.
std::vector<std::array<std::int32_t, 2>> self_intersecting_pairs(
    const std::vector<Vec<3>>& points, const std::vector<std::array<std::int32_t, 3>>& facets,
    const Progress& progress = {});

}  // namespace lamella
