#include "core/natural/ellipsoid_fit.h"

#include <gtest/gtest.h>

#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

using namespace lamella::testing;

TEST(EllipsoidFit, EllipsoidsAreSeenExactly) {
  const Mat<3> r = turn(0.8, {1, 2, -1});
  for (const Vec<3>& s : {Vec<3>(1, 1.3, 1.8), Vec<3>(1, 1, 1), Vec<3>(1, 4, 6)}) {
    auto surface = sphere_surface(1, 5);
    for (auto& p : surface.points) p = r * s.asDiagonal() * p;
    const SeenAxes seen = EllipsoidFit::at(Locator<3>(surface), {0, 0, 0}, s[0]);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen.length[k] / s[k], 1, 0.01);
    for (int k = 0; k < 3 && s[2] > 1; ++k)
      EXPECT_NEAR(std::abs(seen.axis.col(k).dot(r.col(k))), 1, 1e-3);
    EXPECT_NEAR((seen.axis.transpose() * seen.axis - Mat<3>::Identity()).norm(), 0, 1e-9);
  }
}

TEST(EllipsoidFit, SlabIsThinAcrossAndEndsAtItsSides) {
  const Mat<3> r = turn(0.6, {2, -1, 1});
  const auto s = moved<3>(box_surface({1, 3, 0.1}, {5, 5, 1}), r, {0, 0, 0});
  const SeenAxes seen = EllipsoidFit::at(Locator<3>(s), r * Vec<3>(0.5, 1.5, 0.05), 0.05);
  EXPECT_NEAR(seen.length[0], 0.05, 0.002);
  EXPECT_NEAR(std::abs(seen.axis.col(0).dot(r.col(2))), 1, 1e-4);
  EXPECT_NEAR(std::abs(seen.axis.col(1).dot(r.col(0))), 1, 0.01);
  EXPECT_NEAR(seen.length[1], 0.5, 0.1);
  EXPECT_NEAR(seen.length[2], 1, 0.25);  // the side is at 1.5, rays end at 20 r = 1
}

TEST(EllipsoidFit, RodIsLongAlongItsAxis) {
  std::vector<Vec<2>> circle;
  for (int i = 0; i < 64; ++i)
    circle.push_back(
        {0.1 * std::cos(i * std::numbers::pi / 32), 0.1 * std::sin(i * std::numbers::pi / 32)});
  const SeenAxes seen = EllipsoidFit::at(Locator<3>(prism_surface(circle, 1.6)), {0, 0.6, 0}, 0.1);
  EXPECT_NEAR(seen.length[0], 0.1, 0.002);
  EXPECT_NEAR(seen.length[1], 0.1, 0.002);
  EXPECT_NEAR(seen.length[2], std::sqrt(0.6 * 1.0), 0.02);
  EXPECT_NEAR(std::abs(seen.axis(1, 2)), 1, 1e-3);
}

}  // namespace
}  // namespace lamella
