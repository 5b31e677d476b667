#include "core/multidomain/pierced.h"

#include <gtest/gtest.h>

namespace lamella {
namespace {

/// A rod that passes through a tetrahedron between its edges.
const Corners<3> tetrahedron{Vec<3>(0, 0, 0), Vec<3>(4, 0, 0), Vec<3>(0, 4, 0), Vec<3>(0, 0, 4)};

TEST(Pierced, FindsARodBetweenTheEdges) {
  const double r = 0.3;
  const ZonePtr<3> rod = cylinder_zone({1.25, 0.75, -5}, {1.25, 0.75, 5}, r);
  std::array<double, 4> phi;
  for (int k = 0; k < 4; ++k) phi[k] = rod->distance(tetrahedron[k]);
  const auto found = pierced_at(*rod, tetrahedron, phi, 0.1);
  ASSERT_TRUE(found.has_value());
  EXPECT_LE(found->depth, r);
  EXPECT_GT(found->depth, 0.1);
  EXPECT_NEAR(rod->distance(found->point), 0, 1e-4);
  EXPECT_GE(found->point.minCoeff(), 0);
  EXPECT_LE(found->point.sum(), 4);
  EXPECT_FALSE(pierced_at(*rod, tetrahedron, phi, r).has_value());
}

TEST(Pierced, NothingPassesThroughOneSide) {
  const ZonePtr<3> half = half_space_zone<3>(Vec<3>(1, 0, 0), 5);
  std::array<double, 4> phi;
  for (int k = 0; k < 4; ++k) phi[k] = half->distance(tetrahedron[k]);
  EXPECT_FALSE(pierced_at(*half, tetrahedron, phi, 1e-9).has_value());
}

TEST(Pierced, TheMeanDepthTellsTheSide) {
  EXPECT_LT(depth_in(*half_space_zone<3>(Vec<3>(1, 0, 0), 2), tetrahedron).mean, 0);
  EXPECT_GT(depth_in(*half_space_zone<3>(Vec<3>(1, 0, 0), 0.1), tetrahedron).mean, 0);
  const DepthIn in = depth_in(*half_space_zone<3>(Vec<3>(1, 0, 0), 1), tetrahedron);
  EXPECT_NEAR(in.mean, 0, 1e-12);  // the centroid lies at x = 1
  EXPECT_GT(in.most, 0.2);
  EXPECT_LT(in.most, 3);
}

}  // namespace
}  // namespace lamella
