#pragma once

#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// Small meshes for tests, benchmarks and first meshes of boxes. All are valid (definition 1.4),
/// with facets listed outward, group 0 ("walls") and body 0 unless said otherwise.

/// Structured box [low, high] of cells[k] cells along axis k, each cell cut into D! simplices along
/// its diagonal (Kuhn). facet_face is 2 k on the side x_k = low[k], 2 k + 1 on x_k = high[k].
template <int D>
SimplexMesh<D> box_mesh(const std::array<int, D>& cells, const Vec<D>& low, const Vec<D>& high);

/// The unit box [0, 1]^D with n cells along each axis.
template <int D>
SimplexMesh<D> unit_box(int n);

/// One equilateral simplex with edges of the given length, its center at the origin.
template <int D>
SimplexMesh<D> equilateral_simplex(double edge = 1);

/// Ball (D = 2: disc) around the origin: the box of n cells (even) along each axis, blown up to the
/// sphere; boundary nodes lie on it. facet_face is 0.
template <int D>
SimplexMesh<D> ball_mesh(int n, double radius);

/// Box [0, 2] x [0, 2] x [0, 1]^(D-2) without the quarter x, y > 1: a concave edge. n cells a unit.
/// facet_face numbers the flat sides from 0.
template <int D>
SimplexMesh<D> l_shape(int n);

/// Unit box of n cells along each axis (n even) whose elements with center x_0 > 1/2 are a second
/// body.
template <int D>
SimplexMesh<D> two_body_box(int n);

}  // namespace lamella
