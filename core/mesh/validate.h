#pragma once

#include <string>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// What `inspect` finds; lengths in mm, measures in mm^D.
struct MeshReport {
  std::size_t nodes = 0;  ///< without the virtual node
  std::size_t elements = 0;
  std::size_t faces_interior = 0;  ///< faces of two elements
  std::size_t faces_boundary = 0;  ///< faces of one element

  std::size_t bad_arrays = 0;    ///< arrays of wrong length, and body or group ids out of range
  std::size_t bad_indices = 0;   ///< elements and facets with a node id out of range or repeated
  std::size_t bad_points = 0;    ///< coordinates that are not finite
  std::size_t inverted = 0;      ///< elements with a signed measure <= 0
  std::size_t faces_shared = 0;  ///< faces of more than two elements, condition (i)
  std::size_t misoriented = 0;  ///< faces that both elements see from the same side, condition (ii)
  std::size_t facets_missing = 0;  ///< boundary faces that are not listed as facets
  std::size_t facets_extra = 0;    ///< facets that are neither a boundary face nor one between two
                                   ///< bodies, or are listed twice
  std::size_t facets_inward = 0;   ///< facets listed with the normal pointing inward
  std::size_t unused = 0;          ///< nodes without an element

  double volume = 0;           ///< sum of |T|, (1.22)
  double volume_boundary = 0;  ///< integral of x . n / d over the boundary faces, (1.23)
  double boundary_area = 0;
  std::string first_finding;  ///< a sentence on the first finding with its place; empty if none

  /// Elements, faces and both volumes make a mesh of the domain (definition 1.4); says nothing of
  /// the list of facets nor of unused nodes.
  bool conforming() const {
    return bad_arrays + bad_indices + bad_points + inverted + faces_shared + misoriented == 0 &&
           volumes_agree();
  }
  /// Conforming, facets the boundary listed outward and perhaps faces between bodies, no unused
  /// node.
  bool valid() const {
    return conforming() && facets_missing + facets_extra + facets_inward + unused == 0;
  }
  /// (1.22) = (1.23) up to rounding: elements do not cover each other.
  bool volumes_agree() const;
};

/// Checks the whole of definition 1.4 and the house rules of SimplexMesh. Where arrays or indices
/// are broken, nothing else is looked at. Error: cancelled only.
template <int D>
Result<MeshReport> inspect(const SimplexMesh<D>& mesh, const Progress& progress = {});

/// ok when `inspect` finds the mesh valid. Errors: bad_input with the first finding, cancelled.
template <int D>
Result<void> validate(const SimplexMesh<D>& mesh, const Progress& progress = {});

}  // namespace lamella
