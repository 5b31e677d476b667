#include "core/natural/boundary_distance.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace lamella {

namespace {

// More than the centers and edge middles that adaption itself watches.
constexpr int kOrder = 4;

}  // namespace

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
    for (int i = 0; i <= kOrder; ++i)
      for (int j = 0; i + j <= kOrder; ++j)
        look((i * p[0] + j * p[1] + (kOrder - i - j) * p[2]) / kOrder);
  });
  if (!complete) return cancelled_error();
  BoundaryDistance worst;
  for (const auto& d : of_facet)
    if (d.largest > worst.largest) worst = d;
  return worst;
}

}  // namespace lamella
