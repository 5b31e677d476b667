#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/io/mesh_fields.h"

namespace lamella {

/// VTK unstructured grid (XML, appended data packed by zlib): the tetrahedra, then the boundary
/// triangles. Written and read a block at a time, so that beside the mesh there are a few MB.
///
/// Cell arrays, Int32: `body` (-1 on triangles), `group` and `face` (-1 on tetrahedra); `quality`
/// and further fields of elements are NaN on triangles. Point arrays: `metric` (active tensors, XX
/// YY ZZ XY YZ XZ, mm^-2), `thickness` (mm), `layers` and further fields of nodes. Field arrays of
/// strings: `body_names`, `group_names`, `unit`, `generator`, `provenance`. Errors: io; cancelled.
/// Nothing is left behind on failure.
Result<void> write_vtu(const SimplexMesh<3>& mesh, const MeshFields& fields,
                       const std::filesystem::path& file, const Progress& progress = {});

/// A sound file laid out as `write_vtu` does (VTK's own writer does by default as well), of one
/// piece of tetrahedra with triangles behind them. Nothing for any other, and when cancelled: VTK
/// (core/io_vtk/vtu.h) knows more layouts, and what is wrong with a file.
std::optional<MeshContent> read_appended_vtu(const std::filesystem::path& file,
                                             const Progress& progress = {});

/// Row and column of the six components of a symmetric matrix, in the order that VTK has for them.
inline constexpr std::array<std::array<int, 2>, 6> kVtkTensor = {
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};

}  // namespace lamella
