#include "core/natural/thickness_map.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

using namespace lamella::testing;

double area(const std::vector<Vec<3>>& points,
            const std::vector<std::array<std::int32_t, 3>>& facets) {
  double sum = 0;
  for (const auto& f : facets) {
    const Vec<3>& a = points[std::size_t(f[0])];
    sum += 0.5 * (points[std::size_t(f[1])] - a).cross(points[std::size_t(f[2])] - a).norm();
  }
  return sum;
}

TEST(ThicknessMap, IsThatOfThePlateAndOfTheRibOfATee) {
  const double plate = 0.1, rib = 0.06;
  const auto tee = cell_surface(
      {std::vector{0.0, 0.5 - rib / 2, 0.5 + rib / 2, 1.0}, {0.0, 1.0}, {0.0, plate, 0.5}},
      [](int i, int, int k) { return k == 0 || i == 1; });
  const auto map = thickness_map(tee, 0.05);
  ASSERT_TRUE(map);
  const auto inner = [](double t) { return t > 0.05 && t < 0.95; };
  // Exact on the broad sides; on the narrow ones, within a few percent of the wall they end.
  int plates = 0, ribs = 0;
  for (std::size_t i = 0; i < map->points.size(); ++i) {
    const Vec<3>& x = map->points[i];
    if (std::abs(x[0] - 0.5) > 0.2) {
      EXPECT_NEAR(map->thickness[i], plate, 0.05 * plate) << x.transpose();
      if (inner(x[0]) && inner(x[1])) {
        EXPECT_NEAR(map->thickness[i], plate, 1e-3 * plate) << x.transpose();
      }
      ++plates;
    } else if (x[2] > 0.2) {
      EXPECT_NEAR(map->thickness[i], rib, 0.05 * rib) << x.transpose();
      if (inner(x[1]) && x[2] < 0.45) {
        EXPECT_NEAR(map->thickness[i], rib, 1e-3 * rib) << x.transpose();
      }
      ++ribs;
    }
  }
  EXPECT_GT(plates, 100);
  EXPECT_GT(ribs, 100);
}

TEST(ThicknessMap, DividesTheSurfaceAndKeepsIt) {
  const auto plate = l_surface(0.1);
  const double spacing = 0.07;
  const auto map = thickness_map(plate, spacing);
  ASSERT_TRUE(map);
  ASSERT_EQ(map->thickness.size(), map->points.size());
  ASSERT_EQ(map->facet_of.size(), map->facets.size());
  EXPECT_NEAR(area(map->points, map->facets), area(plate.points, plate.facets), 1e-12);
  for (std::size_t f = 0; f < map->facets.size(); ++f) {
    const auto& whole = plate.facets[std::size_t(map->facet_of[f])];
    const Vec<3>& a = plate.points[std::size_t(whole[0])];
    const Vec<3> normal = (plate.points[std::size_t(whole[1])] - a)
                              .cross(plate.points[std::size_t(whole[2])] - a)
                              .normalized();
    for (int k = 0; k < 3; ++k) {
      const Vec<3>& p = map->points[std::size_t(map->facets[f][k])];
      const Vec<3>& q = map->points[std::size_t(map->facets[f][(k + 1) % 3])];
      EXPECT_LE((p - q).norm(), spacing);
      EXPECT_NEAR((p - a).dot(normal), 0, 1e-12);
    }
  }
}

TEST(ThicknessMap, TurnsWithTheBody) {
  auto body = l_surface(0.1);
  const auto before = thickness_map(body, 0.15);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Vec<3>(1, 2, -1).normalized()).toRotationMatrix();
  for (Vec<3>& p : body.points) p = 3 * (turn * p);
  const auto after = thickness_map(body, 0.45);
  ASSERT_TRUE(before && after);
  ASSERT_EQ(before->points.size(), after->points.size());
  // In the corner of the L, where two walls end, rounding may decide which ball is found.
  std::size_t others = 0;
  for (std::size_t i = 0; i < before->points.size(); ++i) {
    const double ratio = after->thickness[i] / (3 * before->thickness[i]);
    others += std::abs(ratio - 1) > 0.01;
    EXPECT_NEAR(ratio, 1, 0.1);
  }
  EXPECT_LE(others, before->points.size() / 50);
}

TEST(ThicknessMap, StopsWhenAskedAndNeedsASurface) {
  std::stop_source stop;
  stop.request_stop();
  const auto stopped = thickness_map(l_surface(0.1), 0.01, Progress({}, stop.get_token()));
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, Code::cancelled);
  const auto nothing = thickness_map({});
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, Code::bad_input);
}

}  // namespace
}  // namespace lamella
