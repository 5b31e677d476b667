#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/mesh/simplex_mesh.h"

namespace lamella::ui {

/// Which elements of a mesh meet in a face: with it a view of any of the elements is put together
/// in one pass. Made off the window's thread.
struct MeshFaces {
  /// [element][k] the element beyond the face opposite to corner k; -1: none.
  std::vector<std::array<std::int32_t, 4>> neighbor;
  /// 4 element + k of faces that the mesh lists, with their numbers there; sorted.
  std::vector<std::pair<std::int64_t, std::int32_t>> listed;

  /// Number of the listed face opposite to corner k; -1: the mesh does not list it.
  std::int32_t facet(std::size_t element, int k) const;
};
MeshFaces mesh_faces(const SimplexMesh<3>& mesh);

}  // namespace lamella::ui
