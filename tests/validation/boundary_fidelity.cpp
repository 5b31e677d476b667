// How well adaption keeps the boundary: bodies whose exact shape is known, remeshed at several
// sizes. Prints the table of resources/docs/validation.md.

#include <cstdio>
#include <ctime>

#include "core/mesh/validate.h"
#include "core/metric/analytic.h"
#include "core/natural/boundary_distance.h"
#include "core/optimize/adapt.h"
#include "tests/support/solids.h"

namespace lamella::test {
namespace {

/// One adaption to a uniform size. The tolerance is what the tessellation leaves of the asked one.
int row(const Solid& s, double h, double asked, double chord_error) {
  AdaptParams params;
  params.chord_tolerance = asked - chord_error;
  const auto metric = [h](const Vec<3>&) { return isotropic_metric<3>(h); };
  const std::clock_t start = std::clock();
  const auto out =
      adapt<3>(s.mesh, sample_metric<3>(metric, s.mesh.points), &s.surface, params, {}, metric);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  if (!out || !validate<3>(out->mesh)) {
    std::fprintf(stderr, "%s: no valid mesh\n", s.name.c_str());
    return 1;
  }
  const auto distance = boundary_distance(out->mesh, s.surface);
  if (!distance) return 1;
  const FeatureFindings features = compare_features(s, out->mesh, *params.chord_tolerance);
  std::printf(
      "| %s | %g | %zu | %.4f | %.2f / %.2f | %.2f / %.2f | %+.2f | %zu | %.1f |\n", s.name.c_str(),
      h, out->mesh.node_count(), asked, distance->to_surface.distance / *params.chord_tolerance,
      distance->from_surface.distance / *params.chord_tolerance, mesh_off(s, out->mesh) / asked,
      shape_off(s, out->mesh) / asked, (volume_of(out->mesh) - volume_of(s.mesh)) / s.lost,
      features.changed + features.corners_lost, seconds);
  std::fflush(stdout);
  return 0;
}

int table() {
  std::printf(
      "| body | size | nodes | tolerance | mesh to tessellation / back | mesh to shape / back | "
      "volume | features changed | CPU s |\n|---|---|---|---|---|---|---|---|---|\n");
  int failed = 0;
  for (const Solid& s : {sphere_solid(16), torus_solid(10, 60), drilled_boss_solid(6)}) {
    const double chord_error = std::max(mesh_off(s, s.mesh), shape_off(s, s.mesh));
    for (const double share : {0.4, 2.0 / 3})
      for (const double h : {0.06, 0.12, 0.25})
        failed += row(s, h, chord_error / share, chord_error);
  }
  return failed == 0 ? 0 : 1;
}

}  // namespace
}  // namespace lamella::test

int main() { return lamella::test::table(); }
