#include "core/natural/boundary_distance.h"

#include <gtest/gtest.h>

#include "core/mesh/sample_meshes.h"
#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

using namespace lamella::testing;

TEST(BoundaryDistance, IsZeroOnTheSurfaceAndSeesOneBadNode) {
  auto mesh = unit_box<3>(4);
  const Locator<3> cube(box_surface({1, 1, 1}));
  EXPECT_NEAR(boundary_distance(mesh, cube)->largest, 0, 1e-12);
  const auto node = mesh.facets[0][0];
  mesh.points[node] += Vec<3>(-0.3, -0.4, 0);
  const auto found = boundary_distance(mesh, cube);
  EXPECT_NEAR(found->largest, std::sqrt(cube.nearest(mesh.points[node])->distance2), 1e-12);
  EXPECT_EQ(found->place, mesh.points[node]);
}

TEST(BoundaryDistance, SeesTheSagOfFlatFacets) {
  // Facets with vertices on the unit sphere lie below it, by edge^2 / 8 at an edge's middle.
  const Locator<3> sphere(sphere_surface(1, 5));
  const auto mesh = ball_mesh<3>(4, 1);
  double sag = 0;
  for (const auto& f : mesh.facets) {
    const auto p = mesh.corners(f);
    sag = std::max(sag, 1 - ((p[0] + p[1] + p[2]) / 3).norm());
    for (int k = 0; k < 3; ++k) sag = std::max(sag, 1 - (0.5 * (p[k] + p[(k + 1) % 3])).norm());
  }
  EXPECT_GT(sag, 0.01);
  EXPECT_NEAR(boundary_distance(mesh, sphere, 1)->largest, sag, 0.002);
  EXPECT_EQ(boundary_distance(mesh, sphere, 1)->largest,
            boundary_distance(mesh, sphere, 3)->largest);
}

TEST(BoundaryDistance, NeedsASurfaceAndStopsWhenAsked) {
  const auto mesh = unit_box<3>(1);
  EXPECT_EQ(boundary_distance(mesh, Locator<3>(ReferenceSurface<3>{})).error().code,
            Code::bad_input);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(
      boundary_distance(mesh, Locator<3>(box_surface({1, 1, 1})), 0, Progress({}, stop.get_token()))
          .error()
          .code,
      Code::cancelled);
}

}  // namespace
}  // namespace lamella
