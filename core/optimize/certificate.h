#pragma once

#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// Sum of |T| over the elements, the left side of (2.20), mm^D.
template <int D>
double covered_measure(const SimplexMesh<D>& mesh);

/// The measure inside `surface` by the divergence theorem (2.3), mm^D.
template <int D>
double domain_measure(const ReferenceSurface<D>& surface);

/// Tells whether `mesh` is a mesh of the domain bounded by `surface` (theorem 2.2): every element
/// well oriented and not flat; every face in two elements, or in one and then a facet of `surface`
/// with its winding, all of them once; and the minimal volume (2.20), relative 1e-10.
/// Node k + 1 of the mesh is point k of the surface.
/// Errors: failed, naming the first finding and its place.
template <int D>
Result<void> certify(const SimplexMesh<D>& mesh, const ReferenceSurface<D>& surface);

}  // namespace lamella
