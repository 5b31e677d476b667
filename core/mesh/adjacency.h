#pragma once

#include <vector>

#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// One element's view of one of its faces.
template <int D>
struct FaceUse {
  std::array<NodeId, D> nodes;  ///< ascending
  // In one word: the faces of ten million elements are the largest list there is.
  std::int32_t element : 28 = 0;
  std::uint32_t local : 3 = 0;  ///< vertex of the element the face is opposite to
  bool odd : 1 = false;         ///< sorting the outward listing took an odd permutation

  /// By number, not by a call for the bytes: this runs for every face of a mesh.
  bool same_face(const FaceUse& o) const {
    for (int k = 0; k < D; ++k)
      if (nodes[k] != o.nodes[k]) return false;
    return true;
  }
  /// Both elements see the face from opposite sides, as neighbors must.
  static bool opposed(const FaceUse& a, const FaceUse& b) { return a.odd != b.odd; }
};

/// Every face of every element, uses of the same face side by side, in ascending order of nodes
/// then of elements. Node ids must lie in [0, node_slots).
template <int D>
std::vector<FaceUse<D>> face_uses(const std::vector<std::array<NodeId, D + 1>>& elements,
                                  std::size_t node_slots);

/// Calls visit(first, last) for each run of uses of the same face.
template <int D, class Visit>
void for_each_face(const std::vector<FaceUse<D>>& uses, Visit visit) {
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t j = i + 1;
    while (j < uses.size() && uses[j].same_face(uses[i])) ++j;
    visit(i, j);
    i = j;
  }
}

/// Edges of the elements, each once, smaller node first, in ascending order.
/// Node ids must lie in [0, node_slots).
template <int D>
std::vector<std::array<NodeId, 2>> unique_edges(
    const std::vector<std::array<NodeId, D + 1>>& elements, std::size_t node_slots);

}  // namespace lamella
