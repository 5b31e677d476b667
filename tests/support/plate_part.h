#pragma once

#include "core/geometry/soup.h"
#include "core/mesh/sample_meshes.h"
#include "core/study/measure.h"

namespace lamella {

/// A plate of 8 x 8 x 1.
inline Part plate(const std::string& name) {
  Part part;
  part.name = name;
  part.surface = boundary_surface(box_mesh<3>({2, 2, 1}, Vec<3>::Zero(), Vec<3>(8, 8, 1)), 0);
  find_features(part.surface, 0.5);
  part.cad_volume = 64;
  return part;
}

}  // namespace lamella
