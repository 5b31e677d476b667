#pragma once

#include "core/geometry/surface.h"

namespace lamella {

/// The feature edges of a surface as polylines from corner to corner (or around, the first point
/// repeated at the end), with as few points as keep them within `tolerance` mm of the edges.
std::vector<std::vector<Vec<3>>> feature_chains(const ReferenceSurface<3>& surface,
                                                double tolerance);

/// The surface with its creases among the feature edges: edges on which a chord from one facet to
/// the next would lie deeper than `tolerance` mm, although the angle is too small for a feature.
ReferenceSurface<3> with_creases(ReferenceSurface<3> surface, double tolerance);

}  // namespace lamella
