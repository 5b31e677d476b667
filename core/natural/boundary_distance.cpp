#include "core/natural/boundary_distance.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace lamella {

Result<BoundaryDistance> boundary_distance(const SimplexMesh<3>& mesh, const Locator<3>& surface,
                                           int threads, const Progress& progress) {
  if (surface.empty())
    return Error{Code::bad_input, "There is no surface to measure the distance to.", ""};
  std::vector<BoundaryDistance> of_facet(mesh.facets.size());
  const bool complete = parallel_each(mesh.facets.size(), threads, progress, [&](std::size_t f) {
    const auto p = mesh.corners(mesh.facets[f]);
    const auto look = [&](const Vec<3>& x) {
      const double d = std::sqrt(surface.nearest(x)->distance2);
      if (d > of_facet[f].largest) of_facet[f] = {d, x};
    };
    look((p[0] + p[1] + p[2]) / 3);
    for (int k = 0; k < 3; ++k) {
      look(p[k]);
      look(0.5 * (p[k] + p[(k + 1) % 3]));
    }
  });
  if (!complete) return cancelled_error();
  BoundaryDistance worst;
  for (const auto& d : of_facet)
    if (d.largest > worst.largest) worst = d;
  return worst;
}

}  // namespace lamella
