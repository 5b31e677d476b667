#include "core/mesh/check.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/mesh/quality.h"
#include "core/mesh/sample_meshes.h"

namespace lamella {
namespace {

TEST(Stats, AreThePlainOnesOfARange) {
  std::vector<double> sample(101);
  std::iota(sample.rbegin(), sample.rend(), 0);  // 100 .. 0
  const Stats s = stats_of(sample);
  EXPECT_EQ(s.count, 101u);
  EXPECT_EQ(s.min, 0);
  EXPECT_EQ(s.p1, 1);
  EXPECT_EQ(s.p5, 5);
  EXPECT_EQ(s.p25, 25);
  EXPECT_EQ(s.p50, 50);
  EXPECT_EQ(s.p75, 75);
  EXPECT_EQ(s.p95, 95);
  EXPECT_EQ(s.p99, 99);
  EXPECT_EQ(s.max, 100);
  EXPECT_DOUBLE_EQ(s.mean, 50);
  EXPECT_EQ(stats_of({}).count, 0u);
  EXPECT_EQ(stats_of({3}).p99, 3);
}

TEST(Check, AKuhnBoxHasTheValuesOfItsOnlyShape) {
  // Every element of the unit cube of size a: edges a (7 of the 19 families), a sqrt 2, a sqrt 3.
  const double a = 0.25, h = 0.3;
  const auto mesh = unit_box<3>(4);
  const MetricField<3> metric(mesh.points.size(), isotropic_metric<3>(h));
  const auto r = check(mesh, metric);
  ASSERT_TRUE(r.ok()) << r.error().message;
  EXPECT_TRUE(r->mesh.valid());
  EXPECT_EQ(r->dimension, 3);
  EXPECT_NEAR(r->edge_length.min, a / h, 1e-12);
  EXPECT_NEAR(r->edge_length.max, std::sqrt(3) * a / h, 1e-12);
  // Unit: lengths .83 and 1.18 but not 1.44. n = 4: 3 n (n+1)^2 + 3 n^2 (n+1) of all.
  const double axis = 3 * 4 * 25, face = 3 * 16 * 5, space = 64;
  EXPECT_EQ(r->edges, static_cast<std::size_t>(axis + face + space));
  EXPECT_NEAR(r->unit_edges, (axis + face) / (axis + face + space), 1e-12);
  // Squared edges of one element: 3 of 1, 2 of 2, 1 of 3 (times a^2): mean 10/6.
  const double mean_square = a * a / (h * h) * 10 / 6;
  const double units = a * a * a / 6 / (h * h * h) / unit_simplex_measure(3);
  const double mean_ratio = std::pow(units, 2.0 / 3) / mean_square;
  for (const Stats* s : {&r->mean_ratio, &r->mean_ratio_mean}) {
    EXPECT_NEAR(s->min, mean_ratio, 1e-12);
    EXPECT_NEAR(s->max, mean_ratio, 1e-12);
    EXPECT_EQ(s->count, mesh.element_count());
  }
  const double shape = std::pow(mean_ratio, 1.5), size = std::pow(mean_square, -1.5);
  EXPECT_NEAR(r->shape.mean, shape, 1e-12);
  EXPECT_NEAR(r->quality.mean, std::min({shape, size, 1 / size}), 1e-12);
  EXPECT_NEAR(r->allocation, units, 1e-12);
  // Isotropic metric: both forms of the conformity are the same number.
  EXPECT_NEAR(r->conformity.mean, r->conformity_invariant.mean, 1e-9);
  EXPECT_NEAR(r->conformity.min, r->conformity.max, 1e-9);
  EXPECT_NEAR(r->aspect_ratio.min, std::sqrt(1.5 * 3) * std::sqrt(2), 1e-12);
}

template <int D>
void check_perfect() {
  const auto mesh = equilateral_simplex<D>(0.3);
  const MetricField<D> metric(mesh.points.size(), isotropic_metric<D>(0.3));
  const auto r = check(mesh, metric);
  ASSERT_TRUE(r.ok());
  EXPECT_EQ(r->unit_edges, 1);
  EXPECT_NEAR(r->quality.min, 1, 1e-12);
  EXPECT_NEAR(r->mean_ratio.min, 1, 1e-12);
  EXPECT_NEAR(r->conformity.max, 0, 1e-12);
  EXPECT_NEAR(r->allocation, 1, 1e-12);
}

TEST(Check, AnEquilateralSimplexIsPerfect) {
  check_perfect<2>();
  check_perfect<3>();
  check_perfect<4>();
}

TEST(Check, FlatElementsAreLeftOutOfTheConformityAndInvertedOnesAreNegative) {
  auto mesh = unit_box<2>(4);
  std::swap(mesh.elements.back()[1], mesh.elements.back()[2]);
  for (auto& v : mesh.elements[3]) mesh.points[v][1] = 0;
  const MetricField<2> metric(mesh.points.size(), Metric<2>::Identity());
  const auto r = check(mesh, metric);
  ASSERT_TRUE(r.ok());
  EXPECT_LT(r->quality.min, 0);
  EXPECT_GT(r->flat, 0u);
  EXPECT_EQ(r->conformity.count + r->flat, mesh.element_count());
  EXPECT_TRUE(std::isfinite(r->conformity.max));
  EXPECT_FALSE(r->mesh.valid());
}

TEST(Check, RefusesWhatCannotBeMeasured) {
  auto mesh = unit_box<2>(2);
  MetricField<2> metric(mesh.points.size(), Metric<2>::Identity());
  metric.pop_back();
  EXPECT_EQ(check(mesh, metric).error().code, Code::bad_input);
  metric.push_back(Metric<2>::Identity());
  std::stop_source source;
  source.request_stop();
  EXPECT_EQ(check(mesh, metric, Progress({}, source.get_token())).error().code, Code::cancelled);
  mesh.elements[0][0] = 99;
  EXPECT_EQ(check(mesh, metric).error().code, Code::bad_input);
}

}  // namespace
}  // namespace lamella
