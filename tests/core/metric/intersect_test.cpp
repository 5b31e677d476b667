#include "core/metric/intersect.h"

#include <gtest/gtest.h>

#include "tests/support/random_metric.h"

namespace lamella {
namespace {

template <class T>
class IntersectTest : public testing::Test {
 protected:
  std::mt19937 rng{17};
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                  std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(IntersectTest, Dimensions);

TYPED_TEST(IntersectTest, IsAtLeastBothMetricsAndTouchesThem) {
  constexpr int D = TypeParam::value;
  for (int trial = 0; trial < 30; ++trial) {
    const Metric<D> a = test::random_metric<D>(this->rng, 100),
                    b = test::random_metric<D>(this->rng, 100), m = intersect<D>(a, b);
    EXPECT_TRUE(is_spd<D>(m));
    EXPECT_LT((m - intersect<D>(b, a)).norm(), 1e-8 * m.norm());
    // (A.12): m - a and m - b are positive semi-definite, and each direction touches one of them.
    EXPECT_GT(spectrum<D>(Mat<D>(m - a)).values[0], -1e-9 * m.norm());
    EXPECT_GT(spectrum<D>(Mat<D>(m - b)).values[0], -1e-9 * m.norm());
    const double gap_a = (Mat<D>(a.inverse() * m) - Mat<D>::Identity()).determinant();
    EXPECT_NEAR(gap_a * (Mat<D>(b.inverse() * m) - Mat<D>::Identity()).determinant(), 0,
                1e-5 * (1 + std::abs(gap_a)));
  }
}

TYPED_TEST(IntersectTest, OfNestedUnitBallsIsTheInnerOne) {
  constexpr int D = TypeParam::value;
  const Metric<D> a = test::random_metric<D>(this->rng, 100);
  for (const auto& m : {intersect<D>(a, 2 * a), intersect_approximately<D>(a, 2 * a)})
    EXPECT_LT((m - 2 * a).norm(), 1e-9 * a.norm());
}

TYPED_TEST(IntersectTest, TakesTheSmallerSizeOfEachCommonAxis) {
  constexpr int D = TypeParam::value;
  const Mat<D> axes = test::random_rotation<D>(this->rng);
  Vec<D> h1, h2;
  for (int k = 0; k < D; ++k) {
    h1[k] = k % 2 == 0 ? 0.1 : 1;
    h2[k] = k % 2 == 0 ? 0.7 : 0.2;
  }
  const Metric<D> a = metric_from_sizes<D>(axes, h1), b = metric_from_sizes<D>(axes, h2);
  const Metric<D> expected = metric_from_sizes<D>(axes, h1.cwiseMin(h2));
  EXPECT_LT((intersect<D>(a, b) - expected).norm(), 1e-9 * expected.norm());
  EXPECT_LT((intersect_approximately<D>(a, b) - expected).norm(), 1e-9 * expected.norm());
}

TYPED_TEST(IntersectTest, ApproximationIsSymmetricAndKeepsTheVolumeOfTheSmaller) {
  constexpr int D = TypeParam::value;
  for (int trial = 0; trial < 30; ++trial) {
    const Metric<D> a = test::random_metric<D>(this->rng, 10),
                    b = test::random_metric<D>(this->rng, 10);
    const Metric<D> m = intersect_approximately<D>(a, b);
    EXPECT_TRUE(is_spd<D>(m));
    EXPECT_LT((m - intersect_approximately<D>(b, a)).norm(), 1e-9 * m.norm());
    // Both terms are raised from a and from b, so that the mean of the two is below the sum.
    EXPECT_GE(spectrum<D>(Mat<D>(m - 0.5 * (a + b))).values[0], -1e-9 * m.norm());
  }
}

TEST(Maximum, TakesTheLargerCoefficient) {
  const Metric<2> a = Vec<2>(1, 100).asDiagonal(), b = Vec<2>(50, 2).asDiagonal();
  EXPECT_EQ(maximum<2>(a, b), (Metric<2>(Vec<2>(50, 100).asDiagonal())));
}

TEST(Maximum, NeedNotBeAMetricIn3D) {
  Metric<3> a, b;
  a << 1, .9, -.9, .9, 1, -.7, -.9, -.7, 1;
  b << 1, -.9, .9, -.9, 1, -.7, .9, -.7, 1;
  // Some diagonal makes both positive definite, d (d + .7) > 2 .9^2, but not yet their maximum,
  // d (d - .7) < 2 .9^2.
  a.diagonal().array() += 0.2;
  b.diagonal().array() += 0.2;
  ASSERT_TRUE(is_spd<3>(a));
  ASSERT_TRUE(is_spd<3>(b));
  EXPECT_FALSE(is_spd<3>(maximum<3>(a, b)));
}

}  // namespace
}  // namespace lamella
