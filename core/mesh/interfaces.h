#pragma once

#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// The mesh with the faces between two bodies as facets too, behind its own: listed outward from
/// the body of lower id, in a group (behind the mesh's own) and with a CAD face for each pair of
/// bodies. Its facets are then no longer the boundary of its elements.
template <int D>
SimplexMesh<D> with_interfaces(const SimplexMesh<D>& mesh);

/// Inner faces whose vertices all lie on the boundary or on interfaces (C.1.1): through them one
/// element reaches from wall to wall, and a flow with zero velocity at the walls is blocked there.
/// Each is listed with ascending node ids.
template <int D>
std::vector<typename SimplexMesh<D>::Facet> blocking_faces(const SimplexMesh<D>& mesh);

}  // namespace lamella
