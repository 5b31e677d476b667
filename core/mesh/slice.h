#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/simplex_mesh.h"
#include "core/metric/metric.h"

namespace lamella {

/// The cross-section of a mesh with a hyperplane, and the metric restricted to it.
template <int D>
struct Slice {
  SimplexMesh<D> mesh;
  MetricField<D> metric;  ///< [node]; empty when none was given
};

/// The cross-section of a D-mesh with the hyperplane x_(D-1) = value: space at one time for
/// D = 4, a plane of constant z for D = 3.
///
/// A simplex with b nodes below and a above is cut into the joins of its nodes on the hyperplane
/// with the cells of the product of a (b-1)-simplex and an (a-1)-simplex: a tetrahedron or a prism
/// for D = 4. The staircases that divide the product follow the node ids, so that neighbors divide
/// their common face alike; no piece is flat. A facet in the hyperplane belongs to the slice and
/// has the body of its element before the hyperplane, or else of the one after it. Nodes nearer to
/// the hyperplane than 1e-9 of the extent along that axis count as on it.
///
/// New nodes lie on edges, by linear interpolation, in ascending order of (lower node, upper node).
/// Bodies, groups and CAD faces are carried over; boundary facets are the slices of boundary
/// facets. `metric` (nodal, may be empty) is interpolated linearly, as (3.2) has it in an element;
/// its block of the first D - 1 axes measures lengths within the hyperplane.
///
/// The mesh must be conforming. Errors: usage (no element meets the hyperplane), bad_input (a
/// metric of another length), cancelled.
template <int D>
Result<Slice<D - 1>> slice(const SimplexMesh<D>& mesh, double value,
                           const MetricField<D>& metric = {}, const Progress& progress = {});

}  // namespace lamella
