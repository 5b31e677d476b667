#include "core/mesh/element_locator.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/mesh/sample_meshes.h"
#include "tests/support/random_metric.h"

namespace lamella {
namespace {

template <class T>
class ElementLocatorAnyDimension : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                  std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(ElementLocatorAnyDimension, Dimensions);

template <int D>
Vec<D> place(const SimplexMesh<D>& mesh, const Located<D>& found) {
  Vec<D> x = Vec<D>::Zero();
  for (int k = 0; k <= D; ++k) x += found.weights[k] * mesh.points[mesh.elements[found.element][k]];
  return x;
}

template <int D>
void expect_convex(const Located<D>& found) {
  double sum = 0;
  for (const double w : found.weights) {
    EXPECT_GE(w, 0);
    sum += w;
  }
  EXPECT_NEAR(sum, 1, 1e-14);
}

TYPED_TEST(ElementLocatorAnyDimension, FindsEveryPointOfTheBox) {
  constexpr int D = TypeParam::value;
  const auto mesh = unit_box<D>(D == 4 ? 2 : 5);
  const ElementLocator<D> locator(mesh);
  std::mt19937 rng(1);
  for (int i = 0; i < 2000; ++i) {
    Vec<D> x;
    for (int k = 0; k < D; ++k) x[k] = test::uniform(rng, 0, 1);
    // A third of the points on faces of the elements or of the box.
    if (i % 3 == 0) x[i % D] = std::round(x[i % D] * 10) / 10;
    const Located<D> found = locator.locate(x);
    ASSERT_TRUE(found.inside) << x.transpose();
    EXPECT_EQ(found.distance2, 0);
    expect_convex<D>(found);
    EXPECT_LT((place<D>(mesh, found) - x).norm(), 1e-14);
  }
}

TYPED_TEST(ElementLocatorAnyDimension, FindsNodesAndCentroidsExactly) {
  constexpr int D = TypeParam::value;
  const auto mesh = D == 4 ? unit_box<D>(2) : ball_mesh<D>(4, 3.0);
  const ElementLocator<D> locator(mesh);
  for (const auto& e : mesh.elements) {
    Vec<D> center = Vec<D>::Zero();
    for (const NodeId n : e) center += mesh.points[n] / (D + 1);
    const Located<D> found = locator.locate(center);
    EXPECT_EQ(mesh.elements[found.element], e);
    for (const double w : found.weights) EXPECT_NEAR(w, 1.0 / (D + 1), 1e-12);
  }
  for (std::size_t n = 1; n < mesh.points.size(); ++n) {
    const Located<D> found = locator.locate(mesh.points[n]);
    const auto& e = mesh.elements[found.element];
    const auto at = std::find(e.begin(), e.end(), static_cast<NodeId>(n));
    ASSERT_NE(at, e.end());
    EXPECT_NEAR(found.weights[at - e.begin()], 1, 1e-12);
  }
}

TYPED_TEST(ElementLocatorAnyDimension, OutsideTheNearestPointOfTheBoxAnswers) {
  constexpr int D = TypeParam::value;
  const auto mesh = unit_box<D>(D == 4 ? 2 : 4);
  const ElementLocator<D> locator(mesh);
  std::mt19937 rng(2);
  int outside = 0;
  for (int i = 0; i < 2000; ++i) {
    Vec<D> x;
    for (int k = 0; k < D; ++k) x[k] = test::uniform(rng, -1, 2);
    const Vec<D> nearest = x.cwiseMax(0.0).cwiseMin(1.0);
    const Located<D> found = locator.locate(x);
    expect_convex<D>(found);
    EXPECT_LT((place<D>(mesh, found) - nearest).norm(), 1e-12);
    EXPECT_NEAR(found.distance2, (x - nearest).squaredNorm(), 1e-12);
    EXPECT_EQ(found.inside, x == nearest);
    outside += !found.inside;
  }
  EXPECT_GT(outside, 500);
}

TYPED_TEST(ElementLocatorAnyDimension, ThinElementsLoseNoPoint) {
  constexpr int D = TypeParam::value;
  // Cells a thousand times longer than thin, and far from the origin.
  std::array<int, D> cells;
  cells.fill(2);
  cells[D - 1] = 8;
  Vec<D> low = Vec<D>::Constant(1000), high = low + Vec<D>::Constant(10);
  high[D - 1] = low[D - 1] + 0.04;
  const auto mesh = box_mesh<D>(cells, low, high);
  const ElementLocator<D> locator(mesh);
  std::mt19937 rng(3);
  for (int i = 0; i < 2000; ++i) {
    Vec<D> x;
    for (int k = 0; k < D; ++k) x[k] = test::uniform(rng, low[k], high[k]);
    if (i % 2 == 0) x[D - 1] = i % 4 == 0 ? low[D - 1] : high[D - 1];
    const Located<D> found = locator.locate(x);
    ASSERT_TRUE(found.inside);
    EXPECT_LT((place<D>(mesh, found) - x).norm(), 1e-10);
  }
}

TEST(ElementLocator, AConcaveCornerIsOutside) {
  const auto mesh = l_shape<3>(2);
  const ElementLocator<3> locator(mesh);
  const Located<3> found = locator.locate({1.3, 1.2, 0.5});
  EXPECT_FALSE(found.inside);
  EXPECT_NEAR(found.distance2, 0.04, 1e-14);
  EXPECT_LT((place<3>(mesh, found) - Vec<3>(1.3, 1, 0.5)).norm(), 1e-14);
}

}  // namespace
}  // namespace lamella
