#include "core/metric/metric.h"

#include <gtest/gtest.h>

#include "tests/support/random_metric.h"

namespace lamella {
namespace {

template <class T>
class MetricTest : public testing::Test {
 protected:
  std::mt19937 rng{11};
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                  std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(MetricTest, Dimensions);

TYPED_TEST(MetricTest, PowersMultiplyLikePowers) {
  constexpr int D = TypeParam::value;
  for (int trial = 0; trial < 20; ++trial) {
    const Metric<D> m = test::random_metric<D>(this->rng, 30);
    const Mat<D> root = metric_power<D>(m, 0.5);
    EXPECT_LT((root * root - m).norm(), 1e-10 * m.norm());
    EXPECT_LT((metric_power<D>(m, -1) * m - Mat<D>::Identity()).norm(), 1e-9);
    EXPECT_LT((metric_power<D>(m, 1) - m).norm(), 1e-12 * m.norm());
    EXPECT_LT((metric_exp<D>(metric_log<D>(m)) - m).norm(), 1e-10 * m.norm());
  }
}

TYPED_TEST(MetricTest, SizesComeBackFromTheMetricOfAnyAxes) {
  constexpr int D = TypeParam::value;
  for (int trial = 0; trial < 50; ++trial) {
    Vec<D> h;
    for (int k = 0; k < D; ++k) h[k] = std::pow(10.0, -4 + k);  // 1e-4 .. thinner by 10 an axis
    h[D - 1] = 1;
    const Metric<D> m = metric_from_sizes<D>(test::random_rotation<D>(this->rng), h);
    const Vec<D> back = sizes<D>(m);
    // Rounding of M itself leaves 1e-16 * 1e8 of the smallest eigenvalue.
    for (int k = 0; k < D; ++k) EXPECT_NEAR(back[k] / h[k], 1, 1e-6);
    EXPECT_GT(spectrum<D>(m).vectors.determinant(), 0);
    EXPECT_TRUE(is_spd<D>(m));
  }
}

TYPED_TEST(MetricTest, RefusesWhatIsNoMetric) {
  constexpr int D = TypeParam::value;
  Mat<D> m = Mat<D>::Identity();
  EXPECT_TRUE(is_spd<D>(m));
  m(0, 1) = 0.1;
  EXPECT_FALSE(is_spd<D>(m));
  m(1, 0) = 0.1;
  EXPECT_TRUE(is_spd<D>(m));
  m(0, 1) = m(1, 0) = 1.1;
  EXPECT_FALSE(is_spd<D>(m));
  m = Mat<D>::Identity();
  m(0, 0) = 0;
  EXPECT_FALSE(is_spd<D>(m));
  m(0, 0) = std::nan("");
  EXPECT_FALSE(is_spd<D>(m));
}

TYPED_TEST(MetricTest, PointsOfTheUnitBallHaveUnitLength) {
  constexpr int D = TypeParam::value;
  const Metric<D> m = test::random_metric<D>(this->rng, 100);
  for (int trial = 0; trial < 20; ++trial) {
    const Vec<D> u = test::random_vector<D>(this->rng).normalized();
    EXPECT_NEAR(metric_length<D>(unit_ball_point<D>(m, u), m), 1, 1e-8);
  }
}

TYPED_TEST(MetricTest, ASimplexIsUnitAndEquilateralInItsOwnMetric) {
  constexpr int D = TypeParam::value;
  for (int trial = 0; trial < 20; ++trial) {
    std::array<Vec<D>, D + 1> p;
    do
      for (auto& x : p) x = test::random_vector<D>(this->rng);
    while (std::abs(signed_measure<D>(p)) < 0.01);
    const Metric<D> m = simplex_metric<D>(p);
    EXPECT_TRUE(is_spd<D>(m));
    for (int i = 0; i <= D; ++i)
      for (int j = 0; j < i; ++j) EXPECT_NEAR(metric_length<D>(p[i] - p[j], m), 1, 1e-9);
    EXPECT_LT((simplex_metric_inverse<D>(p) * m - Mat<D>::Identity()).norm(), 1e-9);
  }
}

TEST(UnitBall, DrawsTheEllipseAndTheEllipsoid) {
  const Metric<2> m2 = Vec<2>(eigenvalue_from_size(0.5), eigenvalue_from_size(3)).asDiagonal();
  const auto ellipse = unit_ball(m2, 8);
  ASSERT_EQ(ellipse.size(), 8u);
  EXPECT_LT((ellipse[0] - Vec<2>(0.5, 0)).norm(), 1e-12);
  EXPECT_LT((ellipse[2] - Vec<2>(0, 3)).norm(), 1e-12);
  const Metric<3> m3 = Vec<3>(1, 1 / 4.0, 1 / 9.0).asDiagonal();
  const auto ellipsoid = unit_ball(m3, 4, 5);
  ASSERT_EQ(ellipsoid.size(), 20u);
  EXPECT_LT((ellipsoid[0] - Vec<3>(0, 0, -3)).norm(), 1e-12);
  EXPECT_LT((ellipsoid[2 * 4 + 1] - Vec<3>(0, 2, 0)).norm(), 1e-12);
  for (const Vec<3>& x : ellipsoid) EXPECT_NEAR(metric_length<3>(x, m3), 1, 1e-12);
}

}  // namespace
}  // namespace lamella
