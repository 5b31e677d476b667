#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/repair.h"

namespace lamella {

struct SoupParams {
  bool repair = true;            ///< false: only points and windings are put in order
  double weld_tolerance = 1e-4;  ///< of the box diagonal: open cracks narrower than this are closed
  double hole_limit = 0.1;       ///< of the box diagonal: holes not wider than this are filled
  double feature_angle = 0.6;    ///< radians between normals that makes a feature edge
};

/// Turns triangles without connectivity (an STL) into a watertight, outward, manifold surface
/// segmented into patches between feature edges. Exact duplicates of points merge; duplicates go,
/// cracks are welded only as far as needed, facets split at vertices on their open edges,
/// non-manifold fans split, small holes filled (core/geometry/repair.h); wrongly wound facets and
/// inside-out shells are turned. Errors: bad_input, with counts, a place and a size: open or
/// non-manifold edges left, no volume.
/// `notes` (may be null) gets a sentence for everything that was repaired.
Result<ReferenceSurface<3>> surface_from_soup(const TriangleSoup& soup,
                                              const SoupParams& params = {},
                                              std::vector<std::string>* notes = nullptr,
                                              const Progress& progress = {});

/// The same, one surface an outer shell with the voids directly inside it; a shell within a void is
/// a body of its own. Largest volume first.
Result<std::vector<ReferenceSurface<3>>> surfaces_from_soup(
    const TriangleSoup& soup, const SoupParams& params = {},
    std::vector<std::string>* notes = nullptr, const Progress& progress = {});

/// The same of triangles whose vertices are known: equal coordinates stay apart.
Result<std::vector<ReferenceSurface<3>>> surfaces_from_triangles(
    Triangles triangles, const SoupParams& params = {}, std::vector<std::string>* notes = nullptr,
    const Progress& progress = {});

/// Volume enclosed by a closed surface, eq. (1.23), mm^D.
template <int D>
double enclosed_measure(const ReferenceSurface<D>& surface);

/// Area of one facet, mm^2.
double facet_area(const ReferenceSurface<3>& surface, std::size_t facet);

/// Closedness and winding: ok, or bad_input naming the count and one place of the first finding.
template <int D>
Result<void> check_closed(const ReferenceSurface<D>& surface);

/// Feature edges where facets meet at more than `angle` radians; `facet_face` and `faces` become
/// the patches between them, and `corners` the vertices where features end, branch or kink by more
/// than 0.6 radians.
void find_features(ReferenceSurface<3>& surface, double angle);

/// The vertices where feature edges end, branch or kink by more than 0.6 radians, rising.
std::vector<std::int32_t> kinks_of_features(const ReferenceSurface<3>& surface);

}  // namespace lamella
