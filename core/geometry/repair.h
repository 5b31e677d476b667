#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/triangles.h"

namespace lamella {

/// Small repairs of triangles, each named in `notes` (may be null) when it changed something.
using Notes = std::vector<std::string>;

/// Welds the vertices of open edges nearer than `tolerance` mm, by half decades and no farther than
/// closing asks, so that near vertices elsewhere stay apart.
void weld_cracks(Triangles& t, double tolerance, Notes* notes);

/// Splits facets whose open edge passes within `tolerance` mm of a vertex of another open edge.
/// Returns how many vertices were met.
std::size_t split_at_t_vertices(Triangles& t, double tolerance, Notes* notes);

/// Where more than two facets meet at an edge: those that bound the same material stay together, in
/// the radial order around the edge, and the vertices are separated. Bodies that touch come apart;
/// where a body touches itself its sides move inward by `gap` mm, so that they no longer do. Edges
/// whose windings do not alternate stay. Returns how many edges were split.
std::size_t split_fans(Triangles& t, double gap, Notes* notes);

/// Fills holes whose loop of open edges fits into a box of diagonal `limit` mm by the triangles of
/// least area. Open shells of at most a fiftieth of the area whose holes are larger are left out.
/// Error: bad_input, with the size and the place of the largest hole that is refused.
Result<void> fill_holes(Triangles& t, double limit, Notes* notes);

/// Facets of a closed surface that cross each other are cut out, with up to three rings of their
/// neighbors, and the holes filled, each no wider than `limit` mm: for few of them. True when
/// nothing crosses any more and the surface is closed; otherwise nothing is changed.
bool mend_crossings(Triangles& t, double limit, Notes* notes, const Progress& progress = {});

struct Shells {
  std::vector<std::int32_t> of_facet;
  std::int32_t count = 0;
};
/// Winds neighbors alike across the edges of two facets: the larger side of each shell keeps its
/// winding. Error: bad_input on a one-sided surface, with a place.
Result<Shells> orient(Triangles& t, Notes* notes);

}  // namespace lamella
