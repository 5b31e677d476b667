#include "core/natural/boundary_distance.h"

#include <gtest/gtest.h>

#include "core/geometry/locator.h"
#include "core/mesh/sample_meshes.h"
#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

using namespace lamella::testing;

TEST(BoundaryDistance, IsZeroOnTheSurfaceAndSeesOneBadNode) {
  auto mesh = unit_box<3>(4);
  const auto cube = box_surface({1, 1, 1});
  EXPECT_NEAR(boundary_distance(mesh, cube)->largest(), 0, 1e-12);
  const auto node = mesh.facets[0][0];
  mesh.points[node] += Vec<3>(-0.3, -0.4, 0);
  const auto found = boundary_distance(mesh, cube)->to_surface;
  EXPECT_NEAR(found.distance, std::sqrt(Locator<3>(cube).nearest(mesh.points[node])->distance2),
              1e-12);
  EXPECT_EQ(found.place, mesh.points[node]);
}

TEST(BoundaryDistance, SeesTheSagOfFlatFacetsFromBothSides) {
  // Facets with vertices on the unit sphere lie below it, deepest where their circumcenters are or,
  // outside of those, at the middle of an edge.
  const auto sphere = sphere_surface(1, 5);
  const auto mesh = ball_mesh<3>(4, 1);
  double sag = 0;
  for (const auto& f : mesh.facets) {
    const auto p = mesh.corners(f);
    for (int i = 0; i <= 60; ++i)
      for (int j = 0; i + j <= 60; ++j)
        sag = std::max(sag, 1 - ((i * p[0] + j * p[1] + (60 - i - j) * p[2]) / 60).norm());
  }
  EXPECT_GT(sag, 0.01);
  const auto one = boundary_distance(mesh, sphere, 1), three = boundary_distance(mesh, sphere, 3);
  EXPECT_NEAR(one->to_surface.distance, sag, 0.002);
  EXPECT_NEAR(one->from_surface.distance, sag, 0.002);
  EXPECT_EQ(one->to_surface.distance, three->to_surface.distance);
  EXPECT_EQ(one->from_surface.place, three->from_surface.place);
}

TEST(BoundaryDistance, SeesAPinThatTheMeshLeavesOut) {
  // Every point of the mesh lies on the surface; the tip of the pin is 0.5 from the mesh.
  const auto mesh = unit_box<3>(2);
  auto surface = box_surface({1, 1, 1}, {8, 8, 8});
  for (auto& p : surface.points)
    if (p == Vec<3>(0.625, 0.375, 1)) p[2] = 1.5;
  const auto found = boundary_distance(mesh, surface);
  EXPECT_NEAR(found->from_surface.distance, 0.5, 1e-12);
  EXPECT_EQ(found->from_surface.place, Vec<3>(0.625, 0.375, 1.5));
  // Below the pin the mesh is off by less: the pin's sides are near.
  EXPECT_GT(found->to_surface.distance, 0.05);
  EXPECT_LT(found->to_surface.distance, 0.125);
}

TEST(BoundaryDistance, FindsTheFarthestPointBetweenVerticesAndWithinTheResolution) {
  // Two squares in the planes z = 0 and z = 0.2 |x - 0.3|: farthest at a crease of neither's
  // vertices' grid.
  const auto sheet = [](const std::vector<double>& xs, const auto& height) {
    ReferenceSurface<3> s;
    for (const double y : {0.0, 1.0})
      for (const double x : xs) s.points.push_back({x, y, height(x)});
    const auto n = static_cast<std::int32_t>(xs.size());
    for (std::int32_t i = 0; i + 1 < n; ++i) {
      s.facets.push_back({i, i + 1, n + i + 1});
      s.facets.push_back({i, n + i + 1, n + i});
    }
    return s;
  };
  const auto tent = [](double x) { return 0.1 * std::min(x / 0.3, (1 - x) / 0.7); };
  const auto flat = sheet({0, 0.5, 1}, [](double) { return 0.0; });
  const auto roof = sheet({0, 0.3, 1}, tent);
  EXPECT_NEAR(farthest_point(roof, flat)->distance, 0.1, 1e-12);
  // Without what lies under something as far as x = 0.5.
  const Covered covered = [](const Vec<3>& x) { return 0.5 - x[0]; };
  EXPECT_NEAR(farthest_point(roof, flat, 1e-7, 1, {}, covered)->distance, tent(0.5), 2e-7);
  // From the plane the nearest point of the roof is beside the ridge: the perpendicular of the
  // flatter side, which the steeper one reaches as well at the place sought.
  double expected = 0;
  for (int i = 0; i <= 100000; ++i) {
    const double x = i * 1e-5;
    const double left = 0.1 * x / std::hypot(0.3, 0.1),
                 right = 0.1 * (1 - x) / std::hypot(0.7, 0.1);
    expected = std::max(expected, std::min(left, right));
  }
  for (const double resolution : {1e-2, 1e-4, 1e-6}) {
    const double found = farthest_point(flat, roof, resolution)->distance;
    EXPECT_LE(found, expected + 1e-5 * expected);
    EXPECT_GE(found, expected - resolution - 1e-5 * expected);
  }
}

TEST(BoundaryDistance, NeedsASurfaceAndStopsWhenAsked) {
  const auto mesh = unit_box<3>(1);
  EXPECT_EQ(boundary_distance(mesh, ReferenceSurface<3>{}).error().code, Code::bad_input);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(boundary_distance(mesh, box_surface({1, 1, 1}), 0, Progress({}, stop.get_token()))
                .error()
                .code,
            Code::cancelled);
}

}  // namespace
}  // namespace lamella
