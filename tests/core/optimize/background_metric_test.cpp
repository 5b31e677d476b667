#include "core/optimize/background_metric.h"

#include <gtest/gtest.h>

#include "core/mesh/sample_meshes.h"
#include "core/metric/analytic.h"
#include "tests/support/random_metric.h"

namespace lamella {
namespace {

constexpr std::array kMeans = {MetricMean::m, MetricMean::root, MetricMean::size, MetricMean::log,
                               MetricMean::h};

template <class T>
class BackgroundMetricAnyDimension : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                  std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(BackgroundMetricAnyDimension, Dimensions);

template <int D>
SimplexMesh<D> mesh_of() {
  return unit_box<D>(D == 4 ? 2 : 4);
}

template <int D>
MetricField<D> random_field(const SimplexMesh<D>& mesh, double ratio) {
  std::mt19937 rng(5);
  MetricField<D> field(mesh.points.size(), Metric<D>::Identity());
  for (std::size_t n = 1; n < field.size(); ++n) field[n] = test::random_metric<D>(rng, ratio);
  return field;
}

template <int D>
Vec<D> random_point(std::mt19937& rng, double low = 0, double high = 1) {
  Vec<D> x;
  for (int k = 0; k < D; ++k) x[k] = test::uniform(rng, low, high);
  return x;
}

/// The sizes of a metric along x^T M x, symmetric positive definite and linear in x for each mean.
template <int D>
Mat<D> linear_field(const Vec<D>& x) {
  Mat<D> a = Mat<D>::Identity();
  for (int k = 0; k < D; ++k) {
    a(k, k) += 0.5 * k + x[k];
    for (int j = 0; j < k; ++j) a(k, j) = a(j, k) = 0.1 * x[j] - 0.05 * x[k];
  }
  return a;
}

TYPED_TEST(BackgroundMetricAnyDimension, GivesTheNodalValuesBack) {
  constexpr int D = TypeParam::value;
  const auto mesh = mesh_of<D>();
  const auto field = random_field<D>(mesh, 50);
  for (const MetricMean mean : kMeans) {
    const auto f = background_metric<D>(mesh, field, mean);
    ASSERT_TRUE(f.ok());
    for (std::size_t n = 1; n < field.size(); ++n) {
      const Metric<D> expected =
          mean == MetricMean::h ? isotropic_metric<D>(sizes<D>(field[n])[0]) : field[n];
      EXPECT_LT(((*f)(mesh.points[n]) - expected).norm(), 1e-9 * expected.norm());
    }
  }
}

TYPED_TEST(BackgroundMetricAnyDimension, IsExactWhereTheQuantityOfItsMeanIsLinear) {
  constexpr int D = TypeParam::value;
  const auto mesh = mesh_of<D>();
  const auto exact = [](MetricMean mean, const Vec<D>& x) -> Metric<D> {
    const Mat<D> a = linear_field<D>(x);
    switch (mean) {
      case MetricMean::m:
        return a;
      case MetricMean::root:
        return a * a;
      case MetricMean::size:
        return metric_power<D>(a, -2);
      case MetricMean::log:
        return metric_exp<D>(a);
      case MetricMean::h:
        return isotropic_metric<D>(a(0, 0));
    }
    return a;
  };
  std::mt19937 rng(6);
  for (const MetricMean mean : kMeans) {
    MetricField<D> field(mesh.points.size(), Metric<D>::Identity());
    for (std::size_t n = 1; n < field.size(); ++n) field[n] = exact(mean, mesh.points[n]);
    const auto f = background_metric<D>(mesh, field, mean);
    ASSERT_TRUE(f.ok());
    for (int i = 0; i < 300; ++i) {
      const Vec<D> x = random_point<D>(rng);
      const Metric<D> expected = exact(mean, x);
      EXPECT_LT(((*f)(x)-expected).norm(), 1e-11 * expected.norm());
    }
  }
}

TYPED_TEST(BackgroundMetricAnyDimension, IsContinuousAndBetweenTheNodalValues) {
  constexpr int D = TypeParam::value;
  const auto mesh = mesh_of<D>();
  const auto field = random_field<D>(mesh, 20);  // sizes in [1/20, 1]
  std::mt19937 rng(7);
  for (const MetricMean mean : kMeans) {
    const auto f = background_metric<D>(mesh, field, mean);
    ASSERT_TRUE(f.ok());
    // Nearby points on both sides of every face crossed on a way through the box and out of it.
    for (int i = 0; i < 400; ++i) {
      Vec<D> x = random_point<D>(rng, -0.2, 1.2);
      if (i % 2 == 0) x[i / 2 % D] = 0.25 * (i / 2 % 5);
      const Vec<D> step = 1e-9 * test::random_vector<D>(rng);
      const Metric<D> here = (*f)(x), there = (*f)(x + step);
      ASSERT_TRUE(is_spd<D>(here));
      // Slopes are at most 400 per cell of a quarter, of sizes raised to the power -2.
      EXPECT_LT((here - there).norm(), 1e-3);
      const Vec<D> h = sizes<D>(here);
      EXPECT_GE(h[0], 0.05 * (1 - 1e-9));
      EXPECT_LE(h[D - 1], 1 + 1e-9);
    }
  }
}

TYPED_TEST(BackgroundMetricAnyDimension, OutsideItHasTheValueOfTheNearestPoint) {
  constexpr int D = TypeParam::value;
  const auto mesh = mesh_of<D>();
  const auto f = background_metric<D>(mesh, random_field<D>(mesh, 20), MetricMean::log);
  ASSERT_TRUE(f.ok());
  std::mt19937 rng(8);
  for (int i = 0; i < 200; ++i) {
    const Vec<D> x = random_point<D>(rng, -2, 3);
    const Vec<D> nearest = x.cwiseMax(0.0).cwiseMin(1.0);
    EXPECT_LT(((*f)(x) - (*f)(nearest)).norm(), 1e-9 * (*f)(x).norm());
  }
}

TEST(BackgroundMetric, LivesLongerThanTheMesh) {
  MetricFunction<2> f;
  {
    const auto mesh = unit_box<2>(2);
    const MetricField<2> field(mesh.points.size(), isotropic_metric<2>(0.5));
    f = *background_metric<2>(mesh, field);
  }
  const MetricFunction<2> copy = f;
  EXPECT_NEAR(copy({0.3, 0.7})(0, 0), 4, 1e-12);
}

TEST(BackgroundMetric, AdaptionUnderItReachesTheSizesOfTheAnalyticMetric) {
  // The layer is thinner than the cells of the start by far; the background is fine.
  const auto analytic = [](const Vec<2>& x) -> Metric<2> {
    const double h = 0.02 + 0.3 * std::abs(x[0] - 0.5);
    return Vec<2>(1 / (h * h), 25).asDiagonal();
  };
  const auto fine = unit_box<2>(40);
  const auto f = background_metric<2>(fine, sample_metric<2>(analytic, fine.points));
  ASSERT_TRUE(f.ok());
  SimplexMesh<2> mesh = unit_box<2>(4);
  for (int i = 0; i < 4; ++i) {
    const auto r = adapt<2>(mesh, sample_metric<2>(*f, mesh.points), nullptr, {}, {}, *f);
    ASSERT_TRUE(r.ok());
    mesh = r->mesh;
  }
  const auto exact = sample_metric<2>(analytic, mesh.points);
  const auto asked = sample_metric<2>(*f, mesh.points);
  for (std::size_t n = 1; n < exact.size(); ++n)
    EXPECT_LT((asked[n] - exact[n]).norm(), 0.3 * exact[n].norm());
  // The integral of 1 / (h_x h_y) over the square in unit triangles.
  const double elements = 2 / 0.3 * std::log(0.17 / 0.02) / 0.2 / (std::sqrt(3.0) / 4);
  EXPECT_NEAR(mesh.elements.size(), elements, 0.25 * elements);
}

TEST(BackgroundMetric, TellsAWrongMetricAndHonorsCancel) {
  const auto mesh = unit_box<3>(2);
  MetricField<3> field(mesh.points.size(), Metric<3>::Identity());
  field[5](0, 0) = -1;
  EXPECT_EQ(background_metric<3>(mesh, field).error().code, Code::bad_input);
  field.pop_back();
  EXPECT_EQ(background_metric<3>(mesh, field).error().code, Code::bad_input);
  EXPECT_EQ(background_metric<3>({}, {}).error().code, Code::bad_input);
  std::stop_source stop;
  stop.request_stop();
  const MetricField<3> good(mesh.points.size(), Metric<3>::Identity());
  const auto r = background_metric<3>(mesh, good, MetricMean::size, Progress({}, stop.get_token()));
  ASSERT_FALSE(r.ok());
  EXPECT_EQ(r.error().code, Code::cancelled);
}

}  // namespace
}  // namespace lamella
