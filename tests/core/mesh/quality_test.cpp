#include "core/mesh/quality.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/mesh/sample_meshes.h"
#include "tests/support/random_metric.h"

namespace lamella {
namespace {

template <class T>
class QualityTest : public testing::Test {
 protected:
  static constexpr int kDim = T::value;
  std::mt19937 rng{7};

  Corners<kDim> equilateral(double edge = 1) const {
    const auto mesh = equilateral_simplex<kDim>(edge);
    return mesh.corners(mesh.elements[0]);
  }
  /// Random, well oriented and not too flat.
  Corners<kDim> random_simplex() {
    Corners<kDim> p;
    do
      for (auto& x : p) x = test::random_vector<kDim>(rng);
    while (signed_measure<kDim>(p) < 0.02);
    return p;
  }
  Corners<kDim> mapped(const Corners<kDim>& p, const Mat<kDim>& a) const {
    Corners<kDim> q;
    for (int k = 0; k <= kDim; ++k) q[k] = a * p[k];
    return q;
  }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                  std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(QualityTest, Dimensions);

TYPED_TEST(QualityTest, EveryCriterionIsOneForTheUnitSimplexOfAnyMetric) {
  constexpr int D = TypeParam::value;
  for (int trial = 0; trial < 50; ++trial) {
    const Metric<D> m = test::random_metric<D>(this->rng, 1000);
    const auto p = this->mapped(this->equilateral(), metric_power<D>(m, -0.5));
    const ElementQuality q = element_quality<D>(p, m);
    EXPECT_NEAR(q.shape, 1, 1e-7);
    EXPECT_NEAR(q.size, 1, 1e-7);
    EXPECT_NEAR(q.quality, 1, 1e-7);
    EXPECT_NEAR(q.mean_ratio, 1, 1e-7);
    EXPECT_NEAR(conformity<D>(p, m).invariant, 0, 1e-6);
    EXPECT_LT((simplex_metric<D>(p) - m).norm(), 1e-6 * m.norm());
  }
}

TYPED_TEST(QualityTest, ShapeIgnoresTheSizeAndSizeIgnoresTheShape) {
  constexpr int D = TypeParam::value;
  for (const double h : {0.01, 0.5, 1.0, 3.0}) {
    const ElementQuality q = element_quality<D>(this->equilateral(h), Metric<D>::Identity());
    EXPECT_NEAR(q.shape, 1, 1e-12);
    EXPECT_NEAR(q.size, std::pow(std::min(h, 1 / h), D), 1e-12);
    EXPECT_NEAR(q.quality, q.size, 1e-12);
  }
}

TYPED_TEST(QualityTest, CriteriaAreInvariantUnderAnAffineMapOfMeshAndMetric) {
  constexpr int D = TypeParam::value;
  for (int trial = 0; trial < 50; ++trial) {
    const auto p = this->random_simplex();
    const Metric<D> m = test::random_metric<D>(this->rng, 3);
    Mat<D> a = metric_power<D>(test::random_metric<D>(this->rng, 30), 0.5) *
               test::random_rotation<D>(this->rng);
    const Metric<D> back = a.inverse().transpose() * m * a.inverse();
    const auto q = this->mapped(p, a);
    const ElementQuality before = element_quality<D>(p, m), after = element_quality<D>(q, back);
    EXPECT_NEAR(before.quality, after.quality, 1e-8);
    EXPECT_NEAR(before.mean_ratio, after.mean_ratio, 1e-8);
    const double e = conformity<D>(p, m).invariant;
    EXPECT_NEAR(conformity<D>(q, back).invariant, e, 1e-6 * (1 + e));
  }
}

TYPED_TEST(QualityTest, FrobeniusConformityGrowsWithAnisotropyAndTheInvariantFormDoesNot) {
  constexpr int D = TypeParam::value;
  const auto p = this->random_simplex();
  Vec<D> h = Vec<D>::Ones();
  h[0] = 100;
  const Mat<D> a = h.asDiagonal();
  const Metric<D> m = (a * a).inverse();
  const Conformity plain = conformity<D>(p, Metric<D>::Identity());
  EXPECT_NEAR(plain.frobenius, plain.invariant, 1e-9 * plain.invariant);  // isotropic: equal
  const Conformity stretched = conformity<D>(this->mapped(p, a), m);
  EXPECT_NEAR(stretched.invariant, plain.invariant, 1e-6 * plain.invariant);
  EXPECT_GT(stretched.frobenius, 5 * plain.frobenius);
}

TYPED_TEST(QualityTest, ConformityOfAScaledSimplexIsTheFormula) {
  constexpr int D = TypeParam::value;
  // M_T = I / h^2, M = I: R = (h^2 + h^-2 - 2) I.
  const double h = 1.7;
  const Conformity c = conformity<D>(this->equilateral(h), Metric<D>::Identity());
  const double expected = (h * h + 1 / (h * h) - 2) * std::sqrt(double{D});
  EXPECT_NEAR(c.frobenius, expected, 1e-12);
  EXPECT_NEAR(c.invariant, expected, 1e-12);
}

TYPED_TEST(QualityTest, SignsTellInvertedAndFlatElements) {
  constexpr int D = TypeParam::value;
  auto p = this->random_simplex();
  const ElementQuality good = element_quality<D>(p, Metric<D>::Identity());
  std::swap(p[0], p[1]);
  const ElementQuality bad = element_quality<D>(p, Metric<D>::Identity());
  EXPECT_NEAR(bad.shape, -good.shape, 1e-12);
  EXPECT_NEAR(bad.mean_ratio, -good.mean_ratio, 1e-12);
  EXPECT_LT(bad.quality, 0);
  p[0] = (p[1] + p[2]) / 2;
  p[D] = (p[1] + p[2]) / 2;
  EXPECT_EQ(element_quality<D>(p, Metric<D>::Identity()).quality, 0);
  EXPECT_TRUE(std::isinf(aspect_ratio<D>(p)));
}

TYPED_TEST(QualityTest, MeanRatioIsAPowerOfTheShape) {
  constexpr int D = TypeParam::value;
  const ElementQuality q = element_quality<D>(this->random_simplex(), Metric<D>::Identity());
  EXPECT_NEAR(q.shape, std::pow(q.mean_ratio, 0.5 * D), 1e-12);
  EXPECT_GT(q.shape, 0);
  EXPECT_LT(q.shape, 1);
}

TYPED_TEST(QualityTest, AllocationForecastsTheElementsOfAFinerBox) {
  constexpr int D = TypeParam::value;
  // Kuhn elements of a box half as large are as good: the forecast grows by 2^D exactly.
  const auto coarse = unit_box<D>(1), fine = unit_box<D>(2);
  const MetricField<D> field(fine.points.size(), isotropic_metric<D>(0.1));
  const double f = allocation_factor(fine, field), c = allocation_factor(coarse, field);
  EXPECT_NEAR(c / f, 1 << D, 1e-9);
  // An element that already is unit asks for one.
  const auto unit = equilateral_simplex<D>(0.1);
  EXPECT_NEAR(allocation_factor(unit, field), 1, 1e-12);
}

TYPED_TEST(QualityTest, AspectRatioOfTheBestElementAndOfAThinOne) {
  constexpr int D = TypeParam::value;
  EXPECT_NEAR(aspect_ratio<D>(this->equilateral(3)), 2.0 * D / (D + 1), 1e-12);
  Corners<D> p;
  p[0].setZero();
  for (int k = 0; k < D; ++k) p[k + 1] = Vec<D>::Unit(k);
  p[D] *= 0.01;  // the smallest height tends to .01, the longest edge is sqrt 2 (1 in 2D)
  const double longest = D == 2 ? std::hypot(1, 0.01) : std::sqrt(2.0);
  const double height = 0.01 / std::sqrt(1 + (D - 1) * 1e-4);
  EXPECT_NEAR(aspect_ratio<D>(p), std::sqrt(2.0 * D / (D + 1)) * longest / height, 1e-6);
}

TYPED_TEST(QualityTest, ElementMetricsComeFromTheNodes) {
  constexpr int D = TypeParam::value;
  const auto mesh = equilateral_simplex<D>();
  MetricField<D> field;
  Metric<D> sum = Metric<D>::Zero();
  for (int k = 0; k <= D + 1; ++k) field.push_back(isotropic_metric<D>(k == 2 ? 0.1 : 1));
  for (int k = 1; k <= D + 1; ++k) sum += field[k];
  EXPECT_LT((mean_metric<D>(field, mesh.elements[0]) - sum / (D + 1)).norm(), 1e-12);
  EXPECT_EQ((densest_metric<D>(field, mesh.elements[0])), field[2]);
  EXPECT_NEAR(element_qualities(mesh, field)[0],
              quality<D>(mesh.corners(mesh.elements[0]), sum / (D + 1)), 1e-15);
}

TEST(EdgeLength, IsTheIntegralOfGeometricallyVaryingSizes) {
  // Size h(s) = h0 (h1/h0)^s along a unit edge: the length is the integral of 1/h.
  const double h0 = 0.1, h1 = 0.7;
  double integral = 0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) integral += 1 / (n * h0 * std::pow(h1 / h0, (i + 0.5) / n));
  EXPECT_NEAR(edge_length(1 / h0, 1 / h1), integral, 1e-6);
  EXPECT_DOUBLE_EQ(edge_length(2, 3), edge_length(3, 2));
  EXPECT_DOUBLE_EQ(edge_length(1.5, 1.5), 1.5);
  EXPECT_NEAR(edge_length(1, 1.00099), edge_length(1, 1.00101), 1e-4);  // no jump at the switch
  EXPECT_TRUE(is_unit_length(1));
  EXPECT_FALSE(is_unit_length(0.7));
  EXPECT_FALSE(is_unit_length(1.42));
}

}  // namespace
}  // namespace lamella
