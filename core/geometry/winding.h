#pragma once

#include <array>

#include "core/geometry/simplex.h"

namespace lamella {

/// Generalized winding number of triangles (Jacobson, Kavan and Sorkine 2013): how often they wind
/// around a point, also where they are open, cross each other or lie on each other. For a closed
/// surface 1 inside and 0 outside, across a hole it changes smoothly. Facets far away count as the
/// dipole of their cluster (Barill et al. 2018); of the order of 1e-3 is lost.
class WindingNumber {
 public:
  WindingNumber(const std::vector<Vec<3>>& points,
                const std::vector<std::array<std::int32_t, 3>>& facets);

  double operator()(const Vec<3>& x) const;

 private:
  struct Node {
    Vec<3> center;      // area-weighted
    Vec<3> dipole;      // sum of the area vectors
    double radius = 0;  // of a ball around the center that holds all facets
    std::int32_t begin = 0, end = 0;
    std::int32_t second = 0;  // the other child is the next node; 0: a leaf
  };
  void build(std::int32_t begin, std::int32_t end, const std::vector<Vec<3>>& centers);

  std::vector<Node> nodes_;
  std::vector<std::int32_t> items_;
  std::vector<std::array<Vec<3>, 3>> facets_;  // in the order of the leaves
};

}  // namespace lamella
