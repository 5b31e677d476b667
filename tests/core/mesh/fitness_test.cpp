#include "core/mesh/fitness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/mesh/sample_meshes.h"

namespace lamella {
namespace {

SimplexMesh<3> of_elements(std::vector<Vec<3>> points,
                           std::vector<std::array<NodeId, 4>> elements) {
  SimplexMesh<3> mesh;
  mesh.points = {Vec<3>::Zero()};
  mesh.points.insert(mesh.points.end(), points.begin(), points.end());
  mesh.elements = std::move(elements);
  mesh.element_body.assign(mesh.elements.size(), 0);
  mesh.bodies = {"body"};
  return mesh;
}

const FitnessLine& line(const std::vector<FitnessLine>& lines, const std::string& criterion) {
  const auto found = std::find_if(lines.begin(), lines.end(), [&](const FitnessLine& l) {
    return l.criterion.find(criterion) != std::string::npos;
  });
  EXPECT_NE(found, lines.end()) << criterion;
  return *found;
}

// Two regular tetrahedra on one face: their centers' line is the normal through its middle.
TEST(Fitness, RegularNeighborsAreOrthogonalAndSmooth) {
  const double h = std::sqrt(2.0 / 3), r = 1 / std::sqrt(3.0);
  const auto mesh =
      of_elements({{r, 0, 0}, {-r / 2, 0.5, 0}, {-r / 2, -0.5, 0}, {0, 0, h}, {0, 0, -h}},
                  {{1, 2, 3, 4}, {1, 3, 2, 5}});
  const auto f = fitness(mesh);
  ASSERT_TRUE(f.ok());
  EXPECT_EQ(f->inner_faces, 1u);
  EXPECT_NEAR(f->non_orthogonality, 0, 1e-5);
  EXPECT_NEAR(f->skewness.max, 0, 1e-12);
  EXPECT_NEAR(f->smoothness.min, 1, 1e-12);
  EXPECT_NEAR(f->dihedral_min, std::acos(1.0 / 3) * 180 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(f->dihedral_max, std::acos(1.0 / 3) * 180 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(f->aspect.max, 1.5, 1e-12);
}

// With the lower apex moved along a direction of the face, the centers' line leans by a known
// angle.
TEST(Fitness, ALeaningNeighborLeansByItsAngle) {
  const double h = std::sqrt(2.0 / 3), r = 1 / std::sqrt(3.0), lean = 2;
  const auto mesh =
      of_elements({{r, 0, 0}, {-r / 2, 0.5, 0}, {-r / 2, -0.5, 0}, {0, 0, h}, {lean, 0, -2 * h}},
                  {{1, 2, 3, 4}, {1, 3, 2, 5}});
  const auto f = fitness(mesh);
  ASSERT_TRUE(f.ok());
  // Centers (0, 0, h / 4) and (lean / 4, 0, -h / 2).
  EXPECT_NEAR(f->non_orthogonality, std::atan2(lean / 4, 0.75 * h) * 180 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(f->smoothness.min, 0.5, 1e-12);
  // The line meets the face a third of the way, lean / 12 off its middle; the face reaches r there.
  EXPECT_NEAR(f->skewness.max, (lean / 12) / r, 1e-9);
}

TEST(Fitness, RegionsAndCrossedEdgesAreCounted) {
  // Two tetrahedra that share the edge 1-2 only.
  const auto mesh =
      of_elements({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                  {{1, 3, 4, 2}, {1, 5, 6, 2}});
  const auto f = fitness(mesh);
  ASSERT_TRUE(f.ok());
  EXPECT_EQ(f->regions, 2u);
  EXPECT_EQ(f->crossed_edges, 1u);
  EXPECT_EQ(f->free_edges, 0u);
  const auto lines = fitness_lines(*f, 1, {});
  EXPECT_FALSE(line(lines, "regions").holds);
  EXPECT_FALSE(line(lines, "more than two facets").holds);
  EXPECT_TRUE(line(fitness_lines(*f, 2, {}), "regions").holds);
}

TEST(Fitness, AStretchedBoxIsRefusedWhereItsSolversRefuseIt) {
  const auto good = fitness(box_mesh<3>({3, 3, 3}, Vec<3>(0, 0, 0), Vec<3>(1, 1, 1)));
  const auto thin = fitness(box_mesh<3>({3, 3, 3}, Vec<3>(0, 0, 0), Vec<3>(90, 90, 1)));
  ASSERT_TRUE(good.ok() && thin.ok());
  for (const FitnessLine& l : fitness_lines(*good, 1, 3.2)) EXPECT_TRUE(l.holds) << l.criterion;
  const auto lines = fitness_lines(*thin, 1, 2.5);
  EXPECT_FALSE(line(lines, "non-orthogonality, largest").holds);
  EXPECT_FALSE(line(lines, "aspect ratio").holds);
  EXPECT_FALSE(line(lines, "rows of elements").holds);
  EXPECT_EQ(thin->regions, 1u);
  EXPECT_EQ(thin->crossed_edges + thin->free_edges, 0u);
}

// Angles and ratios know neither place, nor direction, nor unit, nor numbering.
TEST(Fitness, IsTheSameForARotatedScaledRenumberedMesh) {
  SimplexMesh<3> mesh = box_mesh<3>({3, 2, 4}, Vec<3>(0, 0, 0), Vec<3>(3, 1, 7));
  const auto before = fitness(mesh);
  const Eigen::AngleAxisd turn(0.7, Vec<3>(1, 2, 3).normalized());
  for (Vec<3>& p : mesh.points) p = 25.4 * (turn * p) + Vec<3>(5, 6, 7);
  std::reverse(mesh.elements.begin(), mesh.elements.end());
  const auto after = fitness(mesh);
  ASSERT_TRUE(before.ok() && after.ok());
  EXPECT_NEAR(after->non_orthogonality, before->non_orthogonality, 1e-6);
  EXPECT_NEAR(after->non_orthogonality_mean, before->non_orthogonality_mean, 1e-6);
  EXPECT_NEAR(after->skewness.mean, before->skewness.mean, 1e-9);
  EXPECT_NEAR(after->smoothness.mean, before->smoothness.mean, 1e-9);
  EXPECT_NEAR(after->aspect.max, before->aspect.max, 1e-9);
  EXPECT_NEAR(after->dihedral_max, before->dihedral_max, 1e-6);
}

}  // namespace
}  // namespace lamella
