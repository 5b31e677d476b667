#pragma once

#include <string>

#include "core/geometry/simplex.h"

namespace lamella {

/// The chord tolerance that a user asks bounds the distance from the mesh to the exact shape; the
/// tessellation of the shape spends this share of it, the mesh on the tessellation the rest.
inline constexpr double tessellation_share = 0.4;

/// One face of the CAD model, or one patch of an STL between feature edges.
struct SurfaceFace {
  std::string name;                         ///< from the file, else empty
  std::array<double, 3> color{-1, -1, -1};  ///< RGB in [0, 1]; negative: none
};

/// Triangulated boundary of one body, watertight, in mm: the shape that meshing must keep.
///
/// D = 3: triangles and feature edges. D = 2: segments, and the features are corners.
/// Facets are listed so that `facet_normal` points out of the body. Every (D-2)-face belongs to an
/// even number of facets, exactly two unless the body touches itself.
template <int D>
struct ReferenceSurface {
  std::vector<Vec<D>> points;                       ///< [vertex], from 0
  std::vector<std::array<std::int32_t, D>> facets;  ///< [facet] vertices
  std::vector<std::int32_t> facet_face;             ///< [facet] index into `faces`
  std::vector<SurfaceFace> faces;                   ///< CAD faces or STL patches
  /// Edges (pairs of vertices) that the mesh must keep: between two CAD faces that meet at an angle
  /// and at every sharp angle. Empty in 2D.
  std::vector<std::array<std::int32_t, 2>> feature_edges;
  std::vector<std::int32_t> corners;  ///< vertices that must stay: ends and kinks of features
};

/// One solid of an input file.
struct Part {
  std::string name;                         ///< product or file name, never empty
  std::array<double, 3> color{-1, -1, -1};  ///< RGB in [0, 1]; negative: none
  ReferenceSurface<3> surface;
  double cad_volume = 0;           ///< mm^3 of the exact B-rep; of the triangles for an STL
  double chord_error = 0;          ///< mm, bound of the tessellation's distance to the exact shape
  std::vector<std::string> notes;  ///< what reading found worth telling (unit, free shells, welds)
  std::vector<std::string> groups{};  ///< names of faces that are boundary groups in the file
};

}  // namespace lamella
