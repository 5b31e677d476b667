#include "core/multidomain/chord_metric.h"

#include <gtest/gtest.h>

#include "core/geometry/soup.h"
#include "tests/support/random_metric.h"
#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

constexpr double tolerance = 1e-3, large = 0.5;

/// The middle of a chord of length h lies h^2 kappa / 8 deep: half of the tolerance.
double chord(double radius) { return std::sqrt(8 * 0.5 * tolerance * radius); }

TEST(ChordField, ChordsOfABallKeepTheTolerance) {
  const double r = 0.7;
  const Partition<3> ball({{"ball", ball_zone<3>(Vec<3>::Zero(), r)}});
  const ChordField field(ball, {testing::sphere_surface(r, 5)}, {tolerance});
  std::mt19937 rng(1);
  for (int i = 0; i < 50; ++i) {
    const Vec<3> n = test::random_vector<3>(rng).normalized();
    const Metric<3> m = field.at(isotropic_metric<3>(large), r * n);
    const Vec<3> t = n.unitOrthogonal(), b = n.cross(t);
    for (const Vec<3>& along : {t, b, Vec<3>((t + b).normalized())})
      EXPECT_NEAR(1 / metric_length<3>(along, m), chord(r), 0.03 * chord(r));
    // Across, no farther than where sizes along have grown to 2.5 times.
    const double across = 1 / metric_length<3>(n, m);
    EXPECT_NEAR(chord(r) + 0.5 * across, 2.5 * chord(r), 0.05 * chord(r));
  }
}

TEST(ChordField, ACylinderIsCurvedAroundOnly) {
  const double a = 0.3, b = 0.5;
  const ReferenceSurface<3> tube = testing::tube_surface(a, b, 2, 200, 1);
  const Partition<3> rod({{"tube", surface_zone<3>(tube)}});
  const ChordField field(rod, {tube}, {tolerance});
  for (const double r : {a, b}) {
    const Metric<3> m = field.at(isotropic_metric<3>(large), {r, 0, 1});
    EXPECT_NEAR(1 / metric_length<3>(Vec<3>::UnitY(), m), chord(r), 0.1 * chord(r));
    EXPECT_NEAR(1 / metric_length<3>(Vec<3>::UnitZ(), m), large, 0.02 * large);
  }
}

TEST(ChordField, SizesGrowWithTheDistanceFromWhatIsCurved) {
  // Above the plane at a box's top the nearest border is flat: the ball asks all the same.
  const double r = 0.2, growth = 0.5;
  const ReferenceSurface<3> sphere = testing::sphere_surface(r, 5, {0, 0, 0});
  const Partition<3> partition({{"ball", ball_zone<3>(Vec<3>::Zero(), r)},
                                {"half", half_space_zone<3>(Vec<3>(0, 0, 1), -0.5)}});
  const ChordField field(partition, {sphere, {}}, {tolerance, growth});
  const Metric<3> given = isotropic_metric<3>(large);
  for (const double z : {-0.25, 0.25, -0.45}) {
    const double expected = chord(r) + growth * (std::abs(z) - r);
    ASSERT_LT(expected, large);
    const Metric<3> m = field.at(given, {0, 0, z});
    EXPECT_NEAR(1 / metric_length<3>(Vec<3>::UnitX(), m), expected, 0.05 * expected) << z;
    EXPECT_LE(1 / metric_length<3>(Vec<3>::UnitZ(), m), large);
  }
}

constexpr double wide = 0.02, deep = 0.03;

/// A block with a groove across its top.
ReferenceSurface<3> grooved() {
  ReferenceSurface<3> s =
      testing::cell_surface({{{0, 0.5, 0.5 + wide, 1}, {0, 2}, {0, 1 - deep, 1}}},
                            [](int i, int, int k) { return i != 1 || k == 0; });
  find_features(s, 0.6);
  return s;
}

TEST(ChordField, SizesAreNoLargerThanDetails) {
  const double growth = 0.5;
  const ReferenceSurface<3> s = grooved();
  const Partition<3> partition({{"block", surface_zone<3>(s)}});
  const ChordField field(partition, {s}, {tolerance, growth});
  const Metric<3> given = isotropic_metric<3>(large);
  const auto size = [&](const Vec<3>& x, int axis) {
    return 1 / metric_length<3>(Vec<3>::Unit(axis), field.at(given, x));
  };
  for (const double y : {0.3, 1.0, 1.7}) {
    EXPECT_LE(size({0.5, y, 1}, 0), 1.01 * wide);  // between its upper edges
    EXPECT_LE(size({0.5, y, 1 - deep}, 2), 1.51 * wide / growth);
    EXPECT_GT(size({0.5, y, 1}, 1), 10 * wide);  // along
    EXPECT_NEAR(size({0.5, y, 1.1}, 0), wide + growth * 0.1, 0.01);
  }
  EXPECT_LE(size({0.5, 0, 1 - deep / 2}, 2), 1.01 * deep);  // its edge at the end of the block
  EXPECT_LT((field.at(given, {0.5, 1, 0}) - given).norm(), 1e-9 * given.norm());
}

TEST(ChordField, SizesBetweenReentrantEdgesAreAShareOfTheirDistance) {
  ChordParams params{tolerance};
  params.between_reentrant = 0.5;
  const ChordField field = ChordField::of_body(grooved(), params);
  const Metric<3> given = isotropic_metric<3>(large);
  const auto size = [&](const Vec<3>& x) {
    return 1 / metric_length<3>(Vec<3>::UnitX(), field.at(given, x));
  };
  for (const double y : {0.3, 1.0, 1.7}) {
    EXPECT_NEAR(size({0.5, y, 1 - deep}), 0.5 * wide, 0.01 * wide) << "the bottom of the groove";
    EXPECT_NEAR(size({0.5, y, 1}), wide, 0.01 * wide) << "its upper edges";
  }
}

TEST(ChordField, FlatSidesAndTheirEdgesAskForNothing) {
  ReferenceSurface<3> s = testing::box_surface({1, 2, 3});
  find_features(s, 0.6);
  const Partition<3> partition({{"box", surface_zone<3>(s)}});
  const ChordField field(partition, {s}, {tolerance});
  const Metric<3> given = isotropic_metric<3>(large);
  for (const Vec<3>& x : {Vec<3>(0.5, 1, 3.1), Vec<3>(0.01, 0.02, 2.9), Vec<3>(0.5, 0.5, 0.5),
                          Vec<3>(0, 0, 1.2), Vec<3>(1, 2, 3)})
    EXPECT_LT((field.at(given, x) - given).norm(), 1e-9 * given.norm());
}

}  // namespace
}  // namespace lamella
