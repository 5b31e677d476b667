#pragma once

#include <string>

#include "core/geometry/edge_table.h"
#include "core/geometry/surface.h"

namespace lamella {

/// Triangles as a file holds them: three points each, no connectivity.
using TriangleSoup = std::vector<std::array<Vec<3>, 3>>;

/// Triangles that share vertices; nothing is said about how they fit together.
struct Triangles {
  std::vector<Vec<3>> points;
  std::vector<std::array<std::int32_t, 3>> facets;

  std::array<Vec<3>, 3> corners(std::size_t f) const {
    return {points[facets[f][0]], points[facets[f][1]], points[facets[f][2]]};
  }
};

/// Equal coordinates become one vertex; vertices are numbered in the order of the soup.
Triangles merge_exact(const TriangleSoup& soup);

/// Drops facets that name a vertex twice; returns how many went.
std::size_t drop_degenerate(Triangles& t);

/// Facets on the same three vertices: opposite pairs enclose nothing and leave none; copies of the
/// same winding leave one, but where closed bodies share them. Returns how many went.
std::size_t drop_duplicates(Triangles& t);

/// Some of the facets, with the vertices that they use.
Triangles subset(const Triangles& t, const std::vector<std::int32_t>& facets);

/// As a surface of one face without features, which need not be closed.
ReferenceSurface<3> plain_surface(const Triangles& t);

/// Whether the facets `in` lie inside the closed shell `out`: by the winding number of the middle
/// of a facet that is not on `out` itself.
bool lies_inside(const Triangles& t, const std::vector<std::int32_t>& in,
                 const std::vector<std::int32_t>& out);

struct EdgeDefects {
  std::size_t open = 0;          ///< edges of one facet
  std::size_t non_manifold = 0;  ///< edges of more than two
  Vec<3> open_at = Vec<3>::Zero();
  Vec<3> non_manifold_at = Vec<3>::Zero();
};
EdgeDefects find_edge_defects(const Triangles& t);

/// Solid angle of a facet seen from x, in (-2 pi, 2 pi) (van Oosterom and Strackee 1983): their sum
/// over a closed surface is 4 pi inside and 0 outside.
double solid_angle(const std::array<Vec<3>, 3>& facet, const Vec<3>& x);

/// Diagonal of the box of the points, mm.
double diagonal_of(const std::vector<Vec<3>>& points);

/// "(1, 2.5, 0)"; what is nothing beside the largest of them is 0.
std::string place_text(const Vec<3>& p);
/// "1 edge", "4 edges"
std::string counted(std::size_t n, const std::string& what);
/// Three digits.
std::string length_text(double x);

}  // namespace lamella
