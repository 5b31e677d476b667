#include "core/multidomain/chord_depth.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/geometry/soup.h"
#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

/// The distance between two balls of these volumes.
double shell(double volume, double less) {
  const auto radius = [](double v) { return std::cbrt(3 * v / (4 * std::numbers::pi)); };
  return radius(volume) - radius(less);
}

TEST(ChordDepths, TrianglesOfABallLieBelowItAsDeepAsTheirVolumeTells) {
  const ReferenceSurface<3> ball = testing::sphere_surface(2, 3);
  const double volume = 32.0 / 3 * std::numbers::pi;
  const std::vector<double> depth = chord_depths(ball, volume);
  ASSERT_EQ(depth.size(), 1u);
  const double mean = shell(volume, enclosed_measure(ball));
  EXPECT_NEAR(depth[0], mean, 0.02 * mean);
}

TEST(ChordDepths, AHollowFaceHasANegativeDepth) {
  ReferenceSurface<3> hollow = testing::sphere_surface(2, 3);
  for (auto& f : hollow.facets) std::swap(f[1], f[2]);
  const std::vector<double> depth = chord_depths(hollow, -32.0 / 3 * std::numbers::pi);
  ASSERT_EQ(depth.size(), 1u);
  EXPECT_LT(depth[0], 0);
}

TEST(ChordDepths, TrianglesThatAreTheShapeItselfLackNothing) {
  const ReferenceSurface<3> ball = testing::sphere_surface(2, 3);
  for (const double d : chord_depths(ball, enclosed_measure(ball))) EXPECT_EQ(d, 0);
  const ReferenceSurface<3> box = testing::box_surface({1, 2, 3});
  for (const double d : chord_depths(box, 6)) EXPECT_EQ(d, 0);
}

}  // namespace
}  // namespace lamella
