#include "core/multidomain/partition.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

/// Three bodies that overlap, a fourth of grains without end, by falling priority.
Partition<3> crowded() {
  return Partition<3>({{"ball", ball_zone<3>({0, 0, 0}, 1)},
                       {"box", box_zone<3>({0, -1.5, -0.5}, {2, 0.5, 0.5})},
                       {"sphere", surface_zone<3>(testing::sphere_surface(1.2, 3))},
                       {"cell", intersection_zone<3>({voronoi_zone<3>({{0, 2, 0}, {0, -2, 0}}, 0),
                                                      ball_zone<3>({0, 0, 1}, 2)})}},
                      "mold");
}

Vec<3> random_point(std::mt19937_64& random, double reach) {
  std::uniform_real_distribution<double> u(-reach, reach);
  return {u(random), u(random), u(random)};
}

TEST(Partition, AFirstRegionThatContainsAPointOwnsIt) {
  const Partition<3> p = crowded();
  EXPECT_EQ(p.count(), 5);
  EXPECT_EQ(p.background(), 4);
  EXPECT_EQ(p.names(), (std::vector<std::string>{"ball", "box", "sphere", "cell", "mold"}));
  EXPECT_EQ(p.region_of({0.5, 0, 0}), 0);  // ball over box over sphere
  EXPECT_EQ(p.region_of({1.1, 0, 0}), 1);  // box over sphere
  EXPECT_EQ(p.region_of({-1.1, 0, 0}), 2);
  EXPECT_EQ(p.region_of({0, 1.5, 1}), 3);
  EXPECT_EQ(p.region_of({0, -1.5, 1.5}), 4);
}

TEST(Partition, APointBetweenCellsBelongsToOneOfThem) {
  std::mt19937_64 random(9);
  std::vector<Vec<3>> seeds;
  for (int s = 0; s < 6; ++s) seeds.push_back(random_point(random, 3));
  std::vector<Region<3>> cells;
  for (std::size_t s = 0; s < seeds.size(); ++s)
    cells.push_back({"cell", voronoi_zone<3>(seeds, s)});
  const Partition<3> p(cells);
  int border = 0;
  for (int i = 0; i < 3000; ++i) {
    // Onto the plane between two seeds, as well as it can be computed.
    const Vec<3> between = seeds[i % 6] - seeds[(i + 1 + i % 5) % 6];
    const Vec<3> n = between.normalized(), x = random_point(random, 3);
    const Vec<3> on = x - n.dot(x - seeds[i % 6] + 0.5 * between) * n;
    EXPECT_NE(p.region_of(on), p.background());
    border += p.border(on).distance < 1e-12;
  }
  EXPECT_GT(border, 100);
}

TEST(Partition, APointThatRoundingPutsBesideABodyBelongsToIt) {
  const Partition<3> p({{"block", box_zone<3>({-30, -30, 0}, {30, 30, 60})}});
  for (const double off : {-1e-9, 0.0, 1e-15, 1e-9})
    EXPECT_EQ(p.region_of({7, -8, -off}), 0) << off;
  EXPECT_EQ(p.region_of({7, -8, -1e-6}), p.background());
}

TEST(Partition, ItsDistancesAreNegativeInOneRegionOnlyAndThatIsTheOwner) {
  const Partition<3> p = crowded();
  std::mt19937_64 random(3);
  for (int i = 0; i < 3000; ++i) {
    const Vec<3> x = random_point(random, 3);
    const int owner = p.region_of(x);
    for (int k = 0; k < p.count(); ++k) EXPECT_EQ(p.distance(k, x) < 0, k == owner);
    // What lies in the owner's ball of that radius has the same owner.
    const double r = std::abs(p.distance(owner, x));
    EXPECT_EQ(p.region_of(x + 0.999 * r * random_point(random, 1).normalized()), owner);
  }
}

TEST(Partition, TheBorderIsWhereTheOwnerChanges) {
  const Partition<3> p = crowded();
  std::mt19937_64 random(5);
  for (int i = 0; i < 2000; ++i) {
    const Vec<3> x = random_point(random, 2);
    const ZoneDistance<3> border = p.border(x);
    EXPECT_NEAR(border.distance, std::abs(p.distance(p.region_of(x), x)), 1e-12);
    if (border.distance < 1e-3) continue;
    EXPECT_NEAR(border.normal.norm(), 1, 1e-12);
    // The foot is on one of both sides along the normal; the cell is a bound only.
    const double inner = std::min(p.border(x + border.distance * border.normal).distance,
                                  p.border(x - border.distance * border.normal).distance);
    if (p.region_of(x) != 3 && p.distance(3, x) > border.distance + 0.1) {
      EXPECT_LT(inner, 1e-9);
    }
  }
}

TEST(Partition, AReachChangesNothingNearAndIsABoundBeyond) {
  const Partition<3> p = crowded();
  std::mt19937_64 random(9);
  for (int i = 0; i < 1000; ++i) {
    const Vec<3> x = random_point(random, 6);
    const double reach = 0.5;
    const ZoneDistance<3> far = p.border(x), near = p.border(x, reach);
    EXPECT_LE(near.distance, far.distance + 1e-12);
    if (far.distance < reach) {
      EXPECT_DOUBLE_EQ(near.distance, far.distance);
    }
    for (int k = 0; k < p.count(); ++k) {
      const double d = p.distance(k, x), bounded = p.at(k, x, reach).distance;
      EXPECT_EQ(bounded < 0, d < 0);
      EXPECT_LE(std::abs(bounded), std::abs(d) + 1e-12);
      if (std::abs(d) < reach) {
        EXPECT_DOUBLE_EQ(bounded, d);
      }
    }
  }
}

TEST(Partition, WithoutRegionsAllIsBackground) {
  const Partition<2> p({});
  EXPECT_EQ(p.count(), 1);
  EXPECT_EQ(p.region_of({1, 2}), 0);
  EXPECT_EQ(p.distance(0, {1, 2}), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(p.border({1, 2}).distance, std::numeric_limits<double>::infinity());
}

TEST(Partition, ABodyWithoutSurfaceIsNowhere) {
  const Partition<3> p({{"none", surface_zone<3>({})}, {"ball", ball_zone<3>({0, 0, 0}, 1)}});
  EXPECT_EQ(p.region_of({0.5, 0, 0}), 1);
  EXPECT_DOUBLE_EQ(p.border({3, 0, 0}, 5).distance, 2);
  EXPECT_EQ(p.at(0, {0, 0, 0}, 1).normal, Vec<3>(0, 0, 0));
}

}  // namespace
}  // namespace lamella
