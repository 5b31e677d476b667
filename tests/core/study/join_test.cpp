#include "core/study/join.h"

#include <gtest/gtest.h>

#include "core/io/export_certificate.h"
#include "core/mesh/validate.h"
#include "core/study/measure.h"
#include "tests/support/box_mesh.h"

namespace lamella {
namespace {

MeshState state_of(const SimplexMesh<3>& mesh, double thickness) {
  MeshState state;
  state.mesh = mesh;
  state.metric.assign(mesh.points.size(), Metric<3>::Identity());
  state.thickness.assign(mesh.points.size(), thickness);
  state.layers.assign(mesh.points.size(), 4);
  state.quality.assign(mesh.elements.size(), 1);
  return state;
}

TEST(Join, KeepsEachBodyWhole) {
  const MeshState a = state_of(test::box_mesh(2, 1, 1), 1),
                  b = state_of(test::box_mesh(1, 3, 1), 2);
  const auto joined = join({&a, &b}, {"part", "insert"});
  EXPECT_TRUE(validate<3>(joined->mesh).ok());
  const MeshSummary s = summarize(joined->mesh);
  ASSERT_EQ(s.bodies.size(), 2u);
  EXPECT_EQ(s.bodies[0].name, "part");
  EXPECT_DOUBLE_EQ(s.bodies[0].measure, 2);
  EXPECT_DOUBLE_EQ(s.bodies[1].measure, 3);
  EXPECT_EQ(s.groups[1].name, "insert walls");
  EXPECT_DOUBLE_EQ(s.groups[0].measure, 10);
  EXPECT_DOUBLE_EQ(s.groups[1].measure, 14);
  EXPECT_EQ(joined->thickness.size(), joined->mesh.points.size());
  EXPECT_EQ(joined->thickness.back(), 2);
  EXPECT_EQ(joined->quality.size(), joined->mesh.elements.size());
}

TEST(Join, OneBodyHasPlainWalls) {
  const MeshState a = state_of(test::box_mesh(1, 1, 1), 1);
  EXPECT_EQ(join({&a}, {"part"})->mesh.groups, std::vector<std::string>{"walls"});
}

TEST(JoinRecords, SumsMeansAndWorst) {
  IterationRecord a, b;
  a.nodes = 10, a.elements = 100, a.quality_min = 0.3, a.quality_mean = 0.6;
  a.layers = {5, 4, 5, 1, 30};
  b.nodes = 20, b.elements = 300, b.quality_min = 0.1, b.quality_mean = 0.8;
  b.layers = {9, 3, 8, 0.5, 10};
  const IterationRecord all = join(std::vector<const IterationRecord*>{&a, &b});
  EXPECT_EQ(all.nodes, 30u);
  EXPECT_DOUBLE_EQ(all.quality_min, 0.1);
  EXPECT_DOUBLE_EQ(all.quality_mean, 0.75);
  EXPECT_DOUBLE_EQ(all.layers.mean, 6);
  EXPECT_DOUBLE_EQ(all.layers.p5, 3);
}

TEST(Measure, KnowsTheCubeInTheUnitMetric) {
  MeshState state = state_of(test::box_mesh(2, 2, 2), 1);
  const IterationRecord r = measure(state).value();
  EXPECT_EQ(r.nodes, 27u);
  EXPECT_EQ(r.elements, 48u);
  EXPECT_DOUBLE_EQ(r.volume, 8);
  EXPECT_EQ(state.quality.size(), 48u);
  EXPECT_GT(r.quality_min, 0);
  // Of the 98 edges only the 8 diagonals of the cubes (sqrt 3) are longer than sqrt 2.
  EXPECT_NEAR(r.unit_edges, 90.0 / 98, 1e-12);
}

TEST(BoundarySurface, OfOneBodyIsClosedAroundIt) {
  const SimplexMesh<3> mesh = test::box_mesh(2, 2, 2, true);
  const ReferenceSurface<3> right = boundary_surface(mesh, 1);
  EXPECT_EQ(right.facets.size(), 2u * (4 + 4 + 2 + 2 + 2 + 2));
  const SimplexMesh<3> part = extract_body(mesh, 1);
  EXPECT_TRUE(validate<3>(part).ok());
}

}  // namespace
}  // namespace lamella
