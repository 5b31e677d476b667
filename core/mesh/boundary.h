#pragma once

#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// A face that belongs to one element only.
template <int D>
struct BoundaryFace {
  typename SimplexMesh<D>::Facet facet;  ///< listed outward
  std::int32_t element = 0;              ///< the element it belongs to
};

/// The topological boundary of a set of elements, in the order of the elements.
template <int D>
std::vector<BoundaryFace<D>> boundary_faces(
    const std::vector<typename SimplexMesh<D>::Element>& elements, std::size_t node_slots);

/// Replaces the facets by the topological boundary of the elements, listed outward. A facet listed
/// before (with any winding) keeps its group and CAD face; a new one gets group 0 and face 0.
/// Facets that were listed but are no boundary disappear.
template <int D>
void rebuild_facets(SimplexMesh<D>& mesh);

/// The facets of the given numbers as a surface without features, with their CAD faces; negative
/// faces become 0.
ReferenceSurface<3> surface_of_facets(const SimplexMesh<3>& mesh,
                                      const std::vector<std::size_t>& facets);
/// The same of all facets.
ReferenceSurface<3> surface_of_facets(const SimplexMesh<3>& mesh);

/// Removes the nodes that no element uses; the others keep their order. Returns the new id of each
/// old node, -1 where it was removed; entry 0 (the virtual node) stays 0.
template <int D>
std::vector<NodeId> compact_nodes(SimplexMesh<D>& mesh);

/// Moves nodal values along with `compact_nodes`.
template <class T>
void compact_field(const std::vector<NodeId>& new_id, std::vector<T>& field) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < new_id.size(); ++i)
    if (new_id[i] >= 0) field[kept++] = field[i];
  field.resize(kept);
}

}  // namespace lamella
