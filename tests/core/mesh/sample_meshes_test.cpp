#include "core/mesh/sample_meshes.h"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "core/mesh/validate.h"

namespace lamella {
namespace {

template <int D>
double volume(const SimplexMesh<D>& mesh) {
  const auto report = inspect(mesh);
  EXPECT_TRUE(report->valid()) << report->first_finding;
  return report->volume;
}

template <int D>
void check_box() {
  std::array<int, D> cells;
  Vec<D> low, high;
  double expected = 1;
  int simplices = factorial(D), nodes = 1;
  for (int k = 0; k < D; ++k) {
    cells[k] = k + 1;
    low[k] = -0.3 * k;
    high[k] = low[k] + 1 + k;
    expected *= 1 + k;
    simplices *= k + 1;
    nodes *= k + 2;
  }
  const auto mesh = box_mesh<D>(cells, low, high);
  EXPECT_NEAR(volume(mesh), expected, 1e-12 * expected);
  EXPECT_EQ(mesh.element_count(), static_cast<std::size_t>(simplices));
  EXPECT_EQ(mesh.node_count(), static_cast<std::size_t>(nodes));
  // Every facet normal is the outward axis of the side that facet_face names.
  std::set<int> sides;
  for (std::size_t i = 0; i < mesh.facets.size(); ++i) {
    const int side = mesh.facet_face[i];
    sides.insert(side);
    const Vec<D> n = facet_normal<D>(mesh.corners(mesh.facets[i])).normalized();
    EXPECT_NEAR(n[side / 2], side % 2 == 1 ? 1 : -1, 1e-12);
  }
  EXPECT_EQ(sides.size(), 2u * D);
}

TEST(SampleMeshes, BoxesFillTheirVolumeAndNameTheirSides) {
  check_box<2>();
  check_box<3>();
  check_box<4>();
}

template <int D>
void check_equilateral() {
  const auto mesh = equilateral_simplex<D>(2.5);
  EXPECT_NEAR(volume(mesh), unit_simplex_measure(D) * std::pow(2.5, D), 1e-12);
  for (int i = 1; i <= D + 1; ++i)
    for (int j = 1; j < i; ++j) EXPECT_NEAR((mesh.points[i] - mesh.points[j]).norm(), 2.5, 1e-12);
}

TEST(SampleMeshes, EquilateralSimplexHasEqualEdges) {
  check_equilateral<2>();
  check_equilateral<3>();
  check_equilateral<4>();
}

template <int D>
void check_ball(int n, double exact, double tolerance) {
  const auto mesh = ball_mesh<D>(n, 2);
  const double v = volume(mesh);
  EXPECT_LT(v, exact);  // inscribed
  EXPECT_GT(v, exact * (1 - tolerance));
  for (const auto& f : mesh.facets)
    for (const NodeId node : f) EXPECT_NEAR(mesh.points[node].norm(), 2, 1e-12);
}

TEST(SampleMeshes, BallsAreInscribed) {
  check_ball<2>(16, 4 * std::numbers::pi, 0.01);
  check_ball<3>(12, 32 * std::numbers::pi / 3, 0.04);
  check_ball<4>(4, 8 * std::numbers::pi * std::numbers::pi, 0.3);
}

TEST(SampleMeshes, LShapesHaveThreeQuartersOfTheBox) {
  EXPECT_NEAR(volume(l_shape<2>(2)), 3, 1e-12);
  EXPECT_NEAR(volume(l_shape<3>(2)), 3, 1e-12);
  EXPECT_NEAR(volume(l_shape<4>(1)), 3, 1e-12);
  const auto mesh = l_shape<3>(2);
  const std::set<int> sides(mesh.facet_face.begin(), mesh.facet_face.end());
  EXPECT_EQ(sides, (std::set<int>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(SampleMeshes, TwoBodiesShareTheBoxEvenly) {
  const auto mesh = two_body_box<3>(2);
  EXPECT_NEAR(volume(mesh), 1, 1e-12);
  double right = 0;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    if (mesh.element_body[e] == 1) right += signed_measure<3>(mesh.corners(mesh.elements[e]));
  EXPECT_NEAR(right, 0.5, 1e-12);
}

}  // namespace
}  // namespace lamella
