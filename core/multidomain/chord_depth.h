#pragma once

#include <vector>

#include "core/geometry/surface.h"

namespace lamella {

/// How deep the triangles of a smooth surface lie below it in the mean, [CAD face] mm; negative
/// where the face is hollow. It is read off the angles between triangles that no feature edge
/// parts, and scaled to what they lack of the body's volume (mm^3) all together; zero on every face
/// where that is not what the angles tell, as of triangles that are the shape itself.
std::vector<double> chord_depths(const ReferenceSurface<3>& surface, double volume);

}  // namespace lamella
