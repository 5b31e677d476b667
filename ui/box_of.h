#pragma once

#include <vector>

#include "core/geometry/bvh.h"

namespace lamella::ui {

/// The box of the points, mm; without any it is empty.
inline Box<3> box_of(const std::vector<Vec<3>>& points) {
  Box<3> box;
  for (const Vec<3>& p : points) box.add(p);
  return box;
}

}  // namespace lamella::ui
