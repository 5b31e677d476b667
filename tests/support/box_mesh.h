#pragma once

#include <algorithm>
#include <map>

#include "core/mesh/simplex_mesh.h"

namespace lamella::test {

/// The box [0, nx] x [0, ny] x [0, nz] of unit cubes of six tetrahedra each (Kuhn). The left half
/// (x < nx/2) is body "left", the rest "right", when `two_bodies`; the bottom is group "gate", the
/// rest "walls"; the CAD face is the number of the box side.
inline SimplexMesh<3> box_mesh(int nx, int ny, int nz, bool two_bodies = false) {
  SimplexMesh<3> mesh;
  if (two_bodies) mesh.bodies = {"left", "right"};
  mesh.groups = {"walls", "gate"};
  const auto id = [&](int i, int j, int k) {
    return static_cast<NodeId>(1 + i + (nx + 1) * (j + (ny + 1) * k));
  };
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) mesh.points.emplace_back(i, j, k);

  std::map<std::array<NodeId, 3>, std::pair<int, std::array<NodeId, 3>>> faces;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        std::array<int, 3> axes = {0, 1, 2};
        do {
          std::array<int, 3> at = {i, j, k};
          SimplexMesh<3>::Element e{id(i, j, k)};
          for (int step = 0; step < 3; ++step) {
            ++at[axes[step]];
            e[step + 1] = id(at[0], at[1], at[2]);
          }
          if (signed_measure<3>(mesh.corners(e)) < 0) std::swap(e[2], e[3]);
          mesh.elements.push_back(e);
          mesh.element_body.push_back(two_bodies && 2 * i >= nx ? 1 : 0);
          for (int c = 0; c < 4; ++c) {
            const auto facet = opposite_facet<3>(e, c);
            auto key = facet;
            std::sort(key.begin(), key.end());
            auto& [count, kept] = faces[key];
            ++count;
            kept = facet;
          }
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
  for (const auto& [key, entry] : faces) {
    if (entry.first != 1) continue;
    mesh.facets.push_back(entry.second);
    const Vec<3> n = facet_normal<3>(mesh.corners(entry.second));
    int axis = 0;
    n.cwiseAbs().maxCoeff(&axis);
    const int side = 2 * axis + (n[axis] > 0 ? 1 : 0);
    mesh.facet_face.push_back(side);
    mesh.facet_group.push_back(side == 4 ? 1 : 0);
  }
  return mesh;
}

}  // namespace lamella::test
