#pragma once

#include <string>

#include "core/geometry/simplex.h"

namespace lamella {

using NodeId = std::int32_t;

/// What a boundary node may do: its dimension as a set of the boundary it must stay on.
enum class NodeKind : std::uint8_t {
  interior,  ///< moves freely
  surface,   ///< stays on a smooth part of the boundary
  feature,   ///< stays on a feature edge (3D)
  corner     ///< never moves nor disappears
};

/// A mesh of D-simplices as plain arrays (definition 1.4), lengths in mm.
///
/// Node 0 is the virtual node (section 2.2.2.3): it has a slot in `points` and no place in space.
/// Each boundary face stands for one virtual element, made of the face and node 0, and carries what
/// belongs to the boundary: the group and the CAD face.
///
/// Orientation: elements are well oriented (A.28). A boundary facet is listed so that
/// `facet_normal` points outward; equivalently, the element {facet, apex inside} would be ill
/// oriented. Faces between two bodies may be listed too, so that they have a group and a CAD face.
template <int D>
struct SimplexMesh {
  static_assert(D >= 2 && D <= 4);
  using Element = std::array<NodeId, D + 1>;
  using Facet = std::array<NodeId, D>;

  std::vector<Vec<D>> points{Vec<D>::Zero()};  ///< [node]; entry 0 is the virtual node
  std::vector<Element> elements;               ///< [element]
  std::vector<std::int32_t> element_body;      ///< [element] index into `bodies`
  std::vector<Facet> facets;                   ///< [boundary face]
  std::vector<std::int32_t> facet_group;       ///< [boundary face] index into `groups`
  std::vector<std::int32_t> facet_face;        ///< [boundary face] CAD face id, as in the surface
  std::vector<std::string> bodies{"body"};     ///< names of bodies
  std::vector<std::string> groups{"walls"};    ///< names of boundary groups

  /// Nodes without the virtual one.
  std::size_t node_count() const { return points.size() - 1; }
  std::size_t element_count() const { return elements.size(); }

  std::array<Vec<D>, D + 1> corners(const Element& e) const {
    std::array<Vec<D>, D + 1> p;
    for (int k = 0; k <= D; ++k) p[k] = points[e[k]];
    return p;
  }
  std::array<Vec<D>, D> corners(const Facet& f) const {
    std::array<Vec<D>, D> p;
    for (int k = 0; k < D; ++k) p[k] = points[f[k]];
    return p;
  }
};

/// Facet of `e` opposite to its vertex k, listed so that `facet_normal` points out of `e`.
template <int D>
std::array<NodeId, D> opposite_facet(const std::array<NodeId, D + 1>& e, int k) {
  std::array<NodeId, D> f;
  for (int i = 0, j = 0; i <= D; ++i)
    if (i != k) f[j++] = e[i];
  // Listing the others in order gives det(f, e_k) the sign (-1)^(D-k) of e; outward needs minus.
  if ((D - k) % 2 == 0) std::swap(f[0], f[1]);
  return f;
}

}  // namespace lamella
