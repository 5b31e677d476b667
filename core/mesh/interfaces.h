#pragma once

#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// A mesh with all faces between two bodies among its facets: first those of the boundary, then the
/// interfaces that were listed already, then the others.
template <int D>
struct WithInterfaces {
  SimplexMesh<D> mesh;
  std::size_t outer = 0;  ///< facets of the boundary
  std::size_t given = 0;  ///< facets that were listed, outer ones among them
};

/// Lists the faces between two bodies outward from the body of lower id. Those that the mesh lists
/// keep their group and CAD face, the others get a group (behind the mesh's own) and a CAD face for
/// each pair of bodies.
template <int D>
WithInterfaces<D> list_interfaces(const SimplexMesh<D>& mesh);
template <int D>
SimplexMesh<D> with_interfaces(const SimplexMesh<D>& mesh) {
  return list_interfaces(mesh).mesh;
}

/// rebuild_facets, but faces between two bodies that were listed stay so, behind the boundary.
template <int D>
void rebuild_with_interfaces(SimplexMesh<D>& mesh);

/// The mesh without the elements of one body. What its faces towards other bodies were listed as,
/// group and CAD face, they are as boundary; those not listed get group and face 0. `new_id` gets
/// the node that each node of `mesh` became, -1 where it is gone (compact_field).
template <int D>
SimplexMesh<D> drop_body(const SimplexMesh<D>& mesh, std::int32_t body,
                         std::vector<NodeId>* new_id = nullptr);

/// Inner faces whose vertices all lie on the boundary or on interfaces (C.1.1): through them one
/// element reaches from wall to wall, and a flow with zero velocity at the walls is blocked there.
/// Each is listed with ascending node ids.
template <int D>
std::vector<typename SimplexMesh<D>::Facet> blocking_faces(const SimplexMesh<D>& mesh);

}  // namespace lamella
