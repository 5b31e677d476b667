#pragma once

#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// What algorithm 2.1 starts from when the boundary is not connected.
template <int D>
struct Bridged {
  std::vector<std::array<NodeId, D + 1>> elements;  ///< the bridges, as nodes (vertex + 1)
  std::vector<std::array<NodeId, D>> facets;        ///< one connected boundary of what is left
  int shells = 0;
};

/// Shell number of each facet in `shell`, and their count.
template <int D>
int number_shells(const std::vector<std::array<NodeId, D>>& facets, std::vector<int>& shell);

/// The star operator never joins what shares no face, so a body with cavities inside would stay in
/// pieces for ever (the thesis assumes a connected boundary). Each further shell is therefore tied
/// to the nearest part of the others by a prism of D simplices between two facets, well oriented
/// or not: the optimization will sort that out. With one shell: the surface itself.
template <int D>
Bridged<D> bridge_shells(const ReferenceSurface<D>& surface);

/// Whether the facets are a mesh topology without boundary, as the star operator needs: every
/// (D-2)-face in exactly two facets that see it with opposite windings.
/// Errors: bad_input (open, wrongly wound or inside out), failed (the body touches itself).
template <int D>
Result<void> check_boundary(const ReferenceSurface<D>& surface);

}  // namespace lamella
