#include "core/metric/average.h"

#include <gtest/gtest.h>

#include "tests/support/random_metric.h"

namespace lamella {
namespace {

constexpr double kExponents[] = {mean_exponent::arithmetic, mean_exponent::root,
                                 mean_exponent::log_euclidean, mean_exponent::size,
                                 mean_exponent::harmonic};

template <class T>
class AverageTest : public testing::Test {
 protected:
  std::mt19937 rng{3};
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                  std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(AverageTest, Dimensions);

TYPED_TEST(AverageTest, OfEqualMetricsIsThatMetric) {
  constexpr int D = TypeParam::value;
  const std::vector<Metric<D>> same(3, test::random_metric<D>(this->rng, 100));
  for (const double p : kExponents)
    EXPECT_LT((average<D>(same, p) - same[0]).norm(), 1e-9 * same[0].norm()) << p;
}

TYPED_TEST(AverageTest, OfSizesAlongTheSameAxesIsTheMeanOfThatPower) {
  constexpr int D = TypeParam::value;
  const Mat<D> axes = test::random_rotation<D>(this->rng);
  Vec<D> a, b;
  for (int k = 0; k < D; ++k) {
    a[k] = 0.1 + 0.2 * k;
    b[k] = 0.9 - 0.1 * k;
  }
  const std::vector<Metric<D>> both = {metric_from_sizes<D>(axes, a),
                                       metric_from_sizes<D>(axes, b)};
  const double w[] = {3, 1};
  const auto expect = [&](double p, auto mean) {
    Vec<D> h;
    for (int k = 0; k < D; ++k) h[k] = mean(a[k], b[k]);
    const Metric<D> expected = metric_from_sizes<D>(axes, h);
    EXPECT_LT((average<D>(both, p, w) - expected).norm(), 1e-10 * expected.norm()) << p;
  };
  expect(-0.5, [](double x, double y) { return (3 * x + y) / 4; });
  expect(-1, [](double x, double y) { return std::sqrt((3 * x * x + y * y) / 4); });
  expect(0, [](double x, double y) { return std::pow(x * x * x * y, 0.25); });
  expect(0.5, [](double x, double y) { return 4 / (3 / x + 1 / y); });
  expect(1, [](double x, double y) { return 1 / std::sqrt((3 / (x * x) + 1 / (y * y)) / 4); });
}

TYPED_TEST(AverageTest, DensityRisesWithTheExponent) {
  // Power means are ordered; the determinant, a product of eigenvalues, follows.
  constexpr int D = TypeParam::value;
  for (int trial = 0; trial < 20; ++trial) {
    const std::vector<Metric<D>> list = {test::random_metric<D>(this->rng, 30),
                                         test::random_metric<D>(this->rng, 30),
                                         test::random_metric<D>(this->rng, 30)};
    double previous = average<D>(list, 1).trace() * (1 + 1e-12);
    for (const double p : {1.0, 0.5}) {
      const Metric<D> m = average<D>(list, p);
      EXPECT_TRUE(is_spd<D>(m));
      EXPECT_LE(m.trace(), previous);
      previous = m.trace();
    }
    double log_det = 0;
    for (const auto& m : list) log_det += std::log(m.determinant()) / 3;
    EXPECT_NEAR(std::log(average<D>(list, 0).determinant()), log_det, 1e-9);
    const Metric<D> inverse_mean =
        (list[0].inverse() + list[1].inverse() + list[2].inverse()).inverse() * 3;
    EXPECT_LT((average<D>(list, -1) - inverse_mean).norm(), 1e-7 * inverse_mean.norm());
  }
}

TYPED_TEST(AverageTest, DoesNotDependOnOrderAndTurnsWithTheAxes) {
  constexpr int D = TypeParam::value;
  const Metric<D> a = test::random_metric<D>(this->rng, 50),
                  b = test::random_metric<D>(this->rng, 50);
  const Mat<D> r = test::random_rotation<D>(this->rng);
  for (const double p : kExponents) {
    const Metric<D> ab = average<D>(std::vector<Metric<D>>{a, b}, p);
    const Metric<D> ba = average<D>(std::vector<Metric<D>>{b, a}, p);
    EXPECT_LT((ab - ba).norm(), 1e-9 * ab.norm());
    const std::vector<Metric<D>> turned = {r * a * r.transpose(), r * b * r.transpose()};
    EXPECT_LT((average<D>(turned, p) - r * ab * r.transpose()).norm(), 1e-8 * ab.norm());
  }
}

TEST(Average, ArithmeticMeanLosesTheStretchingAndTheSizeMeanKeepsIt) {
  // Figures A.1 and A.2 with the metrics (A.3) and (A.4).
  const auto turned = [](double angle, double l1, double l2) -> Metric<2> {
    const Mat<2> r = Eigen::Rotation2Dd(angle).toRotationMatrix();
    return r * Vec<2>(l1, l2).asDiagonal() * r.transpose();
  };
  const std::vector<Metric<2>> list = {turned(-M_PI / 32, 1, 1000), turned(M_PI / 16, 0.5, 1000)};
  const auto stretching = [](const Metric<2>& m) {
    const Vec<2> h = sizes<2>(m);
    return h[1] / h[0];
  };
  EXPECT_LT(stretching(average<2>(list, 1)), 10);
  EXPECT_GT(stretching(average<2>(list, -0.5)), 20);
}

}  // namespace
}  // namespace lamella
