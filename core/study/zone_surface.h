#pragma once

#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/study/zone_entry.h"

namespace lamella {

/// The closed surface of a zone as far as it lies in `domain` (a ball, box or cylinder is not cut),
/// with chords no farther than `tolerance` mm from it. `all` holds the other seeds of a cell.
/// Errors: bad_input, naming the zone: nothing of it is in the domain.
Result<ReferenceSurface<3>> zone_surface(const StudyZone& zone, const std::vector<StudyZone>& all,
                                         const StudyZone& domain, double tolerance);

/// Volume of the zone, mm^3, by its formula; of one that ends with the domain that of `surface`,
/// with what lies between its chords and the side of a domain that is a cylinder.
double zone_volume(const StudyZone& zone, const ReferenceSurface<3>& surface,
                   const StudyZone& domain);

}  // namespace lamella
