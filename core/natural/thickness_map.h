#pragma once

#include <array>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"

namespace lamella {

/// Wall thickness on the surface of a body, known before it is meshed.
///
/// The triangles of the surface, divided until none of their sides is long or there are 200,000 of
/// them. Every face has points
/// of its own: the thickness may jump where two of them meet.
struct ThicknessMap {
  std::vector<Vec<3>> points;                       ///< mm
  std::vector<double> thickness;                    ///< [point] 2 r of the medial ball, mm
  std::vector<std::array<std::int32_t, 3>> facets;  ///< points
  std::vector<std::int32_t> facet_of;               ///< [facet] triangle of the surface it is in
};

/// The thickness that the natural metric divides (geometric detector), at points at most `spacing`
/// mm apart as far as that many triangles do; 0: a hundredth of the box diagonal. A point on the
/// border of a face is judged from just within the face. Errors: bad_input (no surface), cancelled.
Result<ThicknessMap> thickness_map(const ReferenceSurface<3>& surface, double spacing = 0,
                                   const Progress& progress = {});

}  // namespace lamella
