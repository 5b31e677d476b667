#include "core/natural/spread_metric.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lamella {
namespace {

constexpr double kThin = 0.25, kLong = 4;

Metric<3> wall(const Vec<3>& h) { return metric_from_sizes<3>(Mat<3>::Identity(), h); }

double size_along(const Metric<3>& m, int axis) { return 1 / std::sqrt(m(axis, axis)); }

/// Nodes of a plate z = 0 .. 2 as far apart as its sizes, those beyond x = 20 with sizes in x as
/// across, as where another wall meets it.
struct Junction {
  std::vector<Vec<3>> points{Vec<3>::Zero()};
  MetricField<3> metrics{Metric<3>::Identity()};

  Junction() {
    for (double x = 0; x < 22; x += x < 20 ? kLong : kThin)
      for (double y = 0; y <= 20; y += kLong)
        for (double z = 0; z <= 2; z += kThin) {
          points.push_back({x, y, z});
          metrics.push_back(at(points.back()));
        }
  }
  static Metric<3> at(const Vec<3>& x) { return wall({x[0] < 20 ? kLong : kThin, kLong, kThin}); }
};

TEST(SpreadMetric, AsksForNothingWithoutSamples) {
  const Metric<3> m = wall({kLong, 3, kThin});
  EXPECT_EQ(SpreadMetric().at(m, {1, 2, 3}), m);
  EXPECT_EQ(SpreadMetric::from({Vec<3>::Zero()}, {Metric<3>::Identity()}).at(m, {1, 2, 3}), m);
}

TEST(SpreadMetric, SizesGrowWithTheDistanceFromASample) {
  const double growth = 0.5;
  const SpreadMetric spread =
      SpreadMetric::from({Vec<3>::Zero(), {1, 2, 3}},
                         {Metric<3>::Identity(), isotropic_metric<3>(kThin)}, {growth, 1});
  const Metric<3> coarse = isotropic_metric<3>(kLong);
  for (double d : {0.0, 0.3, 1.0, 5.0}) {
    const Metric<3> m = spread.at(coarse, Vec<3>(1, 2, 3) + d * Vec<3>(0.6, 0, 0.8));
    EXPECT_LE((sizes<3>(m).array() - (kThin + growth * d)).abs().maxCoeff(), 1e-9) << d;
  }
  EXPECT_EQ(spread.at(coarse, {100, 2, 3}), coarse);
}

TEST(SpreadMetric, WallsThatDoNotChangeKeepTheirSizes) {
  std::vector<Vec<3>> points = Junction().points;
  const Metric<3> m = wall({kLong, kLong, kThin});
  const SpreadMetric spread = SpreadMetric::from(points, MetricField<3>(points.size(), m));
  for (const Vec<3>& x : {Vec<3>(7, 3, 0.1), Vec<3>(12.1, 9, 1.4), Vec<3>(0, 0, 0)})
    EXPECT_LE((spread.at(m, x) - m).cwiseAbs().maxCoeff(), 1e-9 * m.maxCoeff());
}

TEST(SpreadMetric, SizesFallTowardsAJunctionAllAlongIt) {
  const Junction junction;
  const SpreadParams params;
  const SpreadMetric spread = SpreadMetric::from(junction.points, junction.metrics, params);
  // Between nodes along the junction, too, which are 4 mm apart.
  for (double y : {4.0, 5.0, 6.0, 7.5})
    for (double d : {0.05, 0.5, 1.0, 2.0}) {
      const Vec<3> x(20 - d, y, 0.6);
      const Metric<3> m = spread.at(Junction::at(x), x);
      EXPECT_LE(size_along(m, 0), kThin + params.growth * (d + 2 * kThin)) << y << " " << d;
      EXPECT_GE(size_along(m, 0), kThin + 0.5 * params.growth * d) << y << " " << d;
      EXPECT_NEAR(size_along(m, 2), kThin, 1e-9);
      EXPECT_NEAR(size_along(m, 1), kLong, 1e-9);
    }
}

TEST(SpreadMetric, DoesNotDependOnThreads) {
  const Junction junction;
  const SpreadMetric one = SpreadMetric::from(junction.points, junction.metrics, {1, 1});
  const SpreadMetric two = SpreadMetric::from(junction.points, junction.metrics, {1, 2});
  for (double t = 0; t < 20; t += 0.37) {
    const Vec<3> x(t, 0.7 * t, 0.1 * t);
    EXPECT_EQ(one.at(Junction::at(x), x), two.at(Junction::at(x), x));
  }
}

}  // namespace
}  // namespace lamella
