#include "ui/views/first_direction.h"

#include <algorithm>
#include <cmath>

namespace lamella::ui {

Vec<3> first_direction(const std::array<double, 6>& b, const std::vector<Part>& parts) {
  // Flat parts are seen on their flat side, and from where they have more to show.
  int thin = 0;
  int wide = 0;
  const Vec<3> size(b[1] - b[0], b[3] - b[2], b[5] - b[4]);
  size.minCoeff(&thin);
  size.maxCoeff(&wide);
  Vec<3> direction(-0.55, 0.72, -0.58);
  if (size[thin] < 0.35 * size[3 - thin - wide]) {
    direction = Vec<3>(-0.42, 0.48, -0.46);
    direction[thin] = direction[thin] < 0 ? -0.85 : 0.85;
    double shown = 0;  // CAD faces that look our way, less those that look away
    double all = 0;
    for (const Part& part : parts) {
      std::vector<double> along(part.surface.faces.size());
      all += static_cast<double>(along.size());
      for (std::size_t k = 0; k < part.surface.facets.size(); ++k) {
        const auto& f = part.surface.facets[k];
        const Vec<3>& a = part.surface.points[static_cast<std::size_t>(f[0])];
        const Vec<3> n = (part.surface.points[static_cast<std::size_t>(f[1])] - a)
                             .cross(part.surface.points[static_cast<std::size_t>(f[2])] - a);
        if (std::abs(n[thin]) > 0.5 * n.norm())
          along[static_cast<std::size_t>(part.surface.facet_face[k])] += n[thin];
      }
      for (const double n : along)
        if (n != 0) shown += n * direction[thin] < 0 ? 1 : -1;
    }
    // From below only if there is much more to see there.
    const double much = thin == 2 ? 0.5 : 0.0;
    if (shown < -much * all) direction[thin] = -direction[thin];
  }
  return direction.normalized();
}

}  // namespace lamella::ui
