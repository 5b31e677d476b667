#pragma once

#include <filesystem>
#include <variant>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/simplex_mesh.h"
#include "core/metric/metric.h"

namespace lamella {

/// By its ending, .mesh or .meshb.
inline bool names_medit(const std::filesystem::path& file) {
  return file.extension() == ".mesh" || file.extension() == ".meshb";
}

/// A mesh whose dimension only the file knows.
using AnyMesh = std::variant<SimplexMesh<2>, SimplexMesh<3>, SimplexMesh<4>>;

/// A Medit .mesh, or binary .meshb. Tetrahedra make it 3D with the Triangles as boundary; without
/// any, the Triangles of a planar file are the elements and the Edges the boundary. In Dimension 4,
/// vertices have four coordinates and a reference; the section Pentatopes, five nodes and a
/// reference, holds the elements and Tetrahedra the boundary.
///
/// Nodes keep their numbers, used or not, so that a .sol file fits. The reference of an element
/// names its body and that of a boundary face its group: reference r reads as the name "ref r", and
/// facet_face is r. Boundary faces that the file does not list are added with reference 0 (all in
/// the group "walls" when it lists none); listed faces that are neither a boundary nor between two
/// bodies are dropped. The facets are turned outward; elements are left as they are, for `inspect`
/// to judge. Unknown sections are skipped. Errors: io, bad_input (empty, binary, not Medit,
/// truncated, index out of range, no elements), with the line; cancelled.
Result<AnyMesh> read_medit(const std::filesystem::path& file, const Progress& progress = {});
/// The same for a caller that knows the dimension. Error: bad_input when the file has the other.
template <int D>
Result<SimplexMesh<D>> read_medit(const std::filesystem::path& file, const Progress& progress = {});

/// Writes what `read_medit` reads, atomically; binary, in 2D and 3D, by the ending .meshb. A body
/// or group called "ref r" gets reference r when all of its kind are; otherwise references are
/// positions from 1. Errors: io, cancelled.
template <int D>
Result<void> write_medit(const SimplexMesh<D>& mesh, const std::filesystem::path& file,
                         const Progress& progress = {});

/// A nodal metric from a .sol file: sizes h (type 1, read as I/h^2) or metrics (type 3, the lower
/// triangle row by row: m11 m12 m22 m13 m23 m33 m14 m24 m34 m44 in 4D, its beginning below).
/// `nodes` is the node count of the mesh it belongs to.
/// Errors: io, bad_input (not a .sol, truncated, other node count or dimension, a vector field, a
/// value that is no metric), with the line or the node; cancelled.
template <int D>
Result<MetricField<D>> read_sol(const std::filesystem::path& file, std::size_t nodes,
                                const Progress& progress = {});

/// Writes a nodal metric, entry 0 left out, atomically. Errors: io, cancelled.
template <int D>
Result<void> write_sol(const MetricField<D>& metric, const std::filesystem::path& file,
                       const Progress& progress = {});

}  // namespace lamella
