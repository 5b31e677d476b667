#include "core/optimize/ease.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/mesh/quality.h"
#include "core/mesh/validate.h"
#include "tests/support/adapt_cases.h"
#include "tests/support/three_bodies.h"

namespace lamella {
namespace {

double worst(const SimplexMesh<3>& mesh, const MetricField<3>& metric) {
  const std::vector<double> q = element_qualities<3>(mesh, metric);
  return *std::min_element(q.begin(), q.end());
}

/// Three boxes side by side with groups, their inner nodes and those within the sides and the
/// interfaces thrown about as far as the elements stay valid.
struct Shaken {
  SimplexMesh<3> mesh = test::ThreeBodies().mesh;
  MetricField<3> metric{mesh.points.size(), Metric<3>::Identity()};

  Shaken() {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> by(-0.7, 0.7);
    for (std::size_t n = 1; n < mesh.points.size(); ++n) {
      const Vec<3> old = mesh.points[n];
      Vec<3> to = old;
      for (int k = 0; k < 3; ++k) {
        const double most = k == 0 ? 6 : k == 1 ? 4 : 2;
        const bool held = old[k] < 1e-9 || old[k] > most - 1e-9 ||
                          (k == 0 && std::abs(std::remainder(old[k], 2)) < 1e-9);
        if (!held) to[k] += by(random);
      }
      for (double part = 1; part > 0.01; part *= 0.8) {
        mesh.points[n] = old + part * (to - old);
        if (validate(mesh).ok()) break;
        mesh.points[n] = old;
      }
    }
  }
};

TEST(EasePoor, ElementsGetBetterAndEverySideStaysWhereItWas) {
  Shaken shaken;
  const SimplexMesh<3> before = shaken.mesh;
  const double poor = worst(before, shaken.metric);
  ASSERT_LT(poor, 0.1);
  EXPECT_GT(ease_poor(shaken.mesh, shaken.metric), 0u);
  ASSERT_TRUE(validate(shaken.mesh).ok());
  EXPECT_GT(worst(shaken.mesh, shaken.metric), std::max(0.2, 2 * poor));
  for (int body = 0; body < 3; ++body)
    EXPECT_NEAR(test::volumes(shaken.mesh)[body], 16, 1e-6) << body;
  // Each facet is in the plane it was in, and so is the outline of each group.
  for (std::size_t f = 0; f < before.facets.size(); ++f) {
    const Vec<3> normal = facet_normal<3>(before.corners(before.facets[f])).normalized();
    for (const NodeId n : before.facets[f])
      EXPECT_NEAR(normal.dot(shaken.mesh.points[n] - before.points[n]), 0, 1e-7);
  }
}

TEST(EasePoor, WhereGroupsMeetOnAPlaneTheirBorderStays) {
  Shaken shaken;
  // The side y = 4 in two groups that meet at x = 3.
  shaken.mesh.groups.push_back("half");
  const auto half = static_cast<std::int32_t>(shaken.mesh.groups.size()) - 1;
  for (std::size_t f = 0; f < shaken.mesh.facets.size(); ++f) {
    const auto p = shaken.mesh.corners(shaken.mesh.facets[f]);
    const Vec<3> middle = (p[0] + p[1] + p[2]) / 3;
    if (middle[1] < 4 - 1e-9) continue;
    if (middle[0] < 3) shaken.mesh.facet_group[f] = half;
  }
  const SimplexMesh<3> before = shaken.mesh;
  EXPECT_GT(ease_poor(shaken.mesh, shaken.metric), 0u);
  double area[2] = {0, 0};
  const SimplexMesh<3>* const meshes[2] = {&before, &shaken.mesh};
  for (int k = 0; k < 2; ++k)
    for (std::size_t f = 0; f < before.facets.size(); ++f)
      if (before.facet_group[f] == half)
        area[k] += facet_normal<3>(meshes[k]->corners(before.facets[f])).norm() / 2;
  EXPECT_NEAR(area[0], area[1], 1e-6);
}

TEST(EasePoor, WhatIsGoodStaysAndTheOrderOfNodesIsKept) {
  SimplexMesh<3> mesh = box_mesh<3>({3, 3, 3}, Vec<3>::Zero(), Vec<3>(3, 3, 3));
  MetricField<3> metric(mesh.points.size(), Metric<3>::Identity());
  const SimplexMesh<3> before = mesh;
  EXPECT_EQ(ease_poor(mesh, metric), 0u);
  EXPECT_EQ(mesh.points, before.points);
  EXPECT_EQ(mesh.elements, before.elements);
}

TEST(EasePoor, ACancelLeavesAValidMesh) {
  Shaken shaken;
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(ease_poor(shaken.mesh, shaken.metric, {}, Progress({}, stop.get_token())), 0u);
  EXPECT_TRUE(validate(shaken.mesh).ok());
}

}  // namespace
}  // namespace lamella
