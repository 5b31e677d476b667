#pragma once

#include <algorithm>
#include <map>

#include "core/mesh/boundary.h"
#include "core/mesh/sample_meshes.h"

namespace lamella::test {

/// Names the groups of a box by its sides (facet_face): the fluid enters at x = low and leaves at
/// x = high; the sides listed are symmetries, the others walls.
template <int D>
void name_channel(SimplexMesh<D>& mesh, const std::vector<int>& symmetries = {}) {
  mesh.groups = {"walls", "gate", "vent", "symmetry"};
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const int side = mesh.facet_face[f];
    const bool even = std::count(symmetries.begin(), symmetries.end(), side) > 0;
    mesh.facet_group[f] = side == 0 ? 1 : side == 1 ? 2 : even ? 3 : 0;
  }
}

/// Channel [0, length] x [0, 1]^(D-1), `cells` cells across; cells are `stretch` times as long.
template <int D>
SimplexMesh<D> channel(double length, int cells, double stretch) {
  std::array<int, D> n;
  n.fill(cells);
  n[0] = std::max(1, static_cast<int>(std::lround(length * cells / stretch)));
  Vec<D> high = Vec<D>::Ones();
  high[0] = length;
  SimplexMesh<D> mesh = box_mesh<D>(n, Vec<D>::Zero(), high);
  name_channel<D>(mesh);
  return mesh;
}

/// A mesh whose groups are given by a function of the center of each boundary face.
template <int D, class Group>
void name_faces(SimplexMesh<D>& mesh, Group group) {
  mesh.facets.clear();
  mesh.facet_group.clear();
  mesh.facet_face.clear();
  rebuild_facets<D>(mesh);
  mesh.groups = {"walls", "gate", "vent", "symmetry"};
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    Vec<D> center = Vec<D>::Zero();
    for (const NodeId v : mesh.facets[f]) center += mesh.points[v] / D;
    mesh.facet_group[f] = group(center);
  }
}

/// Cylinder of radius 1 around z, from 0 to `length`: a disc of n cells (even) along its diameter,
/// each triangle extruded to `layers` prisms of three tetrahedra.
inline SimplexMesh<3> cylinder(int n, int layers, double length) {
  const SimplexMesh<2> disc = ball_mesh<2>(n, 1);
  const auto slice = static_cast<NodeId>(disc.node_count());
  SimplexMesh<3> mesh;
  for (int l = 0; l <= layers; ++l)
    for (std::size_t v = 1; v < disc.points.size(); ++v)
      mesh.points.emplace_back(disc.points[v][0], disc.points[v][1], length * l / layers);
  for (int l = 0; l < layers; ++l)
    for (const auto& triangle : disc.elements) {
      std::array<NodeId, 3> t = triangle;
      std::sort(t.begin(), t.end());  // the diagonals of a side are the same seen from both
      for (int k = 0; k < 3; ++k) {
        std::array<NodeId, 4> e{};
        for (int c = 0; c <= k; ++c) e[c] = t[c] + l * slice;
        for (int c = k; c < 3; ++c) e[c + 1] = t[c] + (l + 1) * slice;
        if (signed_measure<3>(mesh.corners(e)) < 0) std::swap(e[0], e[1]);
        mesh.elements.push_back(e);
        mesh.element_body.push_back(0);
      }
    }
  name_faces<3>(mesh, [&](const Vec<3>& x) {
    return x[2] < 1e-9 * length ? 1 : x[2] > (1 - 1e-9) * length ? 2 : 0;
  });
  return mesh;
}

}  // namespace lamella::test
