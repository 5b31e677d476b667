#include "core/multidomain/microstructure.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace lamella {
namespace {

double nearest_pair(const std::vector<Vec<3>>& points) {
  double least = 1e300;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) least = std::min(least, (points[i] - points[j]).norm());
  return least;
}

TEST(Polycrystal, SeedsKeepTheirDistanceInsideTheSpecimen) {
  for (const Specimen& specimen :
       {cylinder_specimen({1, 0, 0}, {1, 3, 9}, 4), box_specimen({-5, 0, 0}, {5, 4, 20})}) {
    PolycrystalOptions options;
    options.grains = 150;
    const auto seeds = polycrystal_seeds(specimen, options);
    ASSERT_TRUE(seeds.ok()) << seeds.error().message;
    ASSERT_EQ(seeds->size(), 150u);
    EXPECT_GE(nearest_pair(*seeds), 0.7 * std::cbrt(specimen.volume / 150));
    for (const Vec<3>& x : *seeds) EXPECT_LT(specimen.zone->distance(x), 0);
    EXPECT_EQ(*seeds, *polycrystal_seeds(specimen, options));
    options.seed = 2;
    EXPECT_NE(*seeds, *polycrystal_seeds(specimen, options));
  }
}

TEST(Polycrystal, RelaxationMakesGrainsOfEqualSizeOnAnyNumberOfThreads) {
  const Specimen specimen = cylinder_specimen({0, 0, 0}, {0, 0, 10}, 4);
  const auto spread = [&](const std::vector<Vec<3>>& seeds) {
    const Partition<3> grains(regions_of(seeds));
    std::vector<double> volume(seeds.size(), 0);
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> u(-4, 4), h(0, 10);
    double all = 0;
    for (int i = 0; i < 40000; ++i) {
      const Vec<3> x(u(random), u(random), h(random));
      if (specimen.zone->distance(x) > 0) continue;
      const int owner = grains.region_of(x);
      EXPECT_LT(owner, grains.background());
      ++volume[owner];
      ++all;
    }
    const double mean = all / static_cast<double>(seeds.size());
    double square = 0;
    for (const double v : volume) square += (v / mean - 1) * (v / mean - 1);
    return std::sqrt(square / static_cast<double>(seeds.size()));
  };
  PolycrystalOptions options;
  options.grains = 40;
  options.spacing = 0;
  const auto loose = polycrystal_seeds(specimen, options);
  options.spacing = 0.7;
  const auto spaced = polycrystal_seeds(specimen, options);
  options.relaxations = 20;
  options.threads = 1;
  const auto relaxed = polycrystal_seeds(specimen, options);
  options.threads = 2;
  EXPECT_EQ(*relaxed, *polycrystal_seeds(specimen, options));
  EXPECT_LT(spread(*spaced), spread(*loose));
  EXPECT_LT(spread(*relaxed), 0.5 * spread(*spaced));
  for (const Vec<3>& x : *relaxed) EXPECT_LT(specimen.zone->distance(x), 0);
}

TEST(Polycrystal, TooManyGrainsAreRefusedWithAHint) {
  PolycrystalOptions options;
  options.spacing = 1.5;
  const auto seeds = polycrystal_seeds(box_specimen({0, 0, 0}, {1, 1, 1}), options);
  ASSERT_FALSE(seeds.ok());
  EXPECT_EQ(seeds.error().code, Code::bad_input);
  EXPECT_NE(seeds.error().hint.find("spacing"), std::string::npos);
  options.grains = 0;
  EXPECT_FALSE(polycrystal_seeds(box_specimen({0, 0, 0}, {1, 1, 1}), options).ok());
}

TEST(Polycrystal, GrainsAreNamedAndFillTheSpecimen) {
  const auto regions = regions_of(std::vector<Vec<3>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  ASSERT_EQ(regions.size(), 3u);
  EXPECT_EQ(regions.front().name, "grain 1");
  EXPECT_EQ(regions.back().name, "grain 3");
  EXPECT_EQ(Partition<3>(regions).region_of({0.8, 0.1, 7}), 1);
}

TEST(Inclusions, FillTheFractionAskedWithoutOverlap) {
  const Specimen specimen = box_specimen({0, 0, 0}, {10, 10, 10});
  InclusionOptions options;
  options.fraction = 0.2;
  options.radius_min = 0.5;
  options.radius_max = 1;
  options.gap = 0.05;
  const auto balls = pack_balls(specimen, options);
  ASSERT_TRUE(balls.ok()) << balls.error().message;
  double volume = 0;
  for (std::size_t i = 0; i < balls->size(); ++i) {
    const BallInclusion& b = (*balls)[i];
    volume += 4 * std::numbers::pi / 3 * std::pow(b.radius, 3);
    EXPECT_GE(b.radius, 0.5);
    EXPECT_LE(b.radius, 1);
    EXPECT_LE(specimen.zone->distance(b.center), -b.radius - 0.05);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE((b.center - (*balls)[j].center).norm(), b.radius + (*balls)[j].radius + 0.05);
  }
  EXPECT_NEAR(volume / 1000, 0.2, 0.5 * 4.19 / 1000 + 1e-9);
  const auto again = pack_balls(specimen, options);
  ASSERT_EQ(again->size(), balls->size());
  EXPECT_EQ(again->back().center, balls->back().center);
  EXPECT_EQ(regions_of(*balls).back().name, "inclusion " + std::to_string(balls->size()));
}

TEST(Inclusions, AreShakenTogetherWhereChanceAloneFindsNoRoom) {
  const Specimen specimen = box_specimen({0, 0, 0}, {10, 10, 10});
  InclusionOptions options;
  options.fraction = 0.33;
  const auto balls = pack_balls(specimen, options);
  ASSERT_TRUE(balls.ok()) << balls.error().message;
  std::vector<Vec<3>> centers;
  for (const BallInclusion& b : *balls) {
    EXPECT_LE(specimen.zone->distance(b.center), -1);
    centers.push_back(b.center);
  }
  EXPECT_EQ(centers.size(), 79u);  // 330 / (4 pi / 3)
  EXPECT_GE(nearest_pair(centers), 2);
}

TEST(Inclusions, ByNumberToo) {
  InclusionOptions options;
  options.count = 25;
  const auto balls = pack_balls(cylinder_specimen({0, 0, 0}, {20, 0, 0}, 6), options);
  ASSERT_TRUE(balls.ok());
  EXPECT_EQ(balls->size(), 25u);
}

TEST(Inclusions, WhatCannotBePackedIsRefusedWithAHint) {
  const Specimen specimen = box_specimen({0, 0, 0}, {10, 10, 10});
  InclusionOptions options;
  EXPECT_FALSE(pack_balls(specimen, options).ok());  // neither count nor fraction
  options.fraction = 0.7;
  const auto full = pack_balls(specimen, options);
  ASSERT_FALSE(full.ok());
  EXPECT_EQ(full.error().code, Code::bad_input);
  EXPECT_NE(full.error().message.find("70 %"), std::string::npos) << full.error().message;
  EXPECT_FALSE(full.error().hint.empty());
  options.count = 3;
  EXPECT_FALSE(pack_balls(specimen, options).ok());  // both
  options.fraction.reset();
  options.radius_min = 2;
  EXPECT_FALSE(pack_balls(specimen, options).ok());  // more than the largest
  options.radius_max = 6;
  options.radius_min = 6;
  EXPECT_NE(pack_balls(specimen, options).error().message.find("Only 0"), std::string::npos);
  options.gap = -1;
  EXPECT_FALSE(pack_balls(specimen, options).ok());
}

/// Mean of p p^T.
Mat<3> orientation_of(const std::vector<FiberInclusion>& fibers) {
  Mat<3> mean = Mat<3>::Zero();
  for (const FiberInclusion& f : fibers) {
    const Vec<3> p = (f.to - f.from).normalized();
    mean += p * p.transpose() / static_cast<double>(fibers.size());
  }
  return mean;
}

TEST(Fibers, HaveTheOrientationTensorAsked) {
  const Specimen specimen = box_specimen({0, 0, 0}, {100, 100, 100});
  FiberOptions options;
  options.count = 4000;
  options.length = 1;
  options.radius = 0.05;
  const Vec<3> axis = Vec<3>(1, 2, 2) / 3;
  const Mat<3> aligned = axis * axis.transpose();
  Mat<3> flow;
  flow << 0.7, 0.1, 0, 0.1, 0.25, 0, 0, 0, 0.05;
  for (const Mat<3>& asked :
       {Mat<3>(Mat<3>::Identity() / 3), aligned, flow, Mat<3>(Vec<3>(0.6, 0.4, 0).asDiagonal())}) {
    options.orientation = asked;
    const auto fibers = pack_fibers(specimen, options);
    ASSERT_TRUE(fibers.ok()) << fibers.error().message;
    // 4000 directions tell a mean to 1/sqrt(4000) of the deviation, at most 1/2.
    EXPECT_LT((orientation_of(*fibers) - asked).cwiseAbs().maxCoeff(), 4 * 0.5 / std::sqrt(4000));
  }
  EXPECT_LT((orientation_of(*pack_fibers(specimen, options)) -
             Mat<3>(Vec<3>(0.6, 0.4, 0).asDiagonal()))(2, 2),
            1e-12);
}

TEST(Fibers, DoNotOverlapAndStayInside) {
  const Specimen specimen = cylinder_specimen({0, 0, 0}, {0, 0, 30}, 10);
  FiberOptions options;
  options.fraction = 0.08;
  options.length = 8;
  options.radius = 0.5;
  options.gap = 0.1;
  const auto fibers = pack_fibers(specimen, options);
  ASSERT_TRUE(fibers.ok()) << fibers.error().message;
  const double one = std::numbers::pi * 0.25 * 8;
  EXPECT_NEAR(static_cast<double>(fibers->size()) * one / specimen.volume, 0.08,
              0.5 * one / specimen.volume + 1e-12);
  for (std::size_t i = 0; i < fibers->size(); ++i) {
    const FiberInclusion& f = (*fibers)[i];
    EXPECT_NEAR((f.to - f.from).norm(), 8, 1e-9);
    const auto zone = cylinder_zone(f.from, f.to, f.radius);
    for (std::size_t j = 0; j < i; ++j) {
      // Points on the axis of the other one keep its radius and the gap away.
      const FiberInclusion& g = (*fibers)[j];
      for (int k = 0; k <= 40; ++k)
        ASSERT_GE(zone->distance(g.from + k / 40.0 * (g.to - g.from)), 0.6 - 1e-9) << i << " " << j;
    }
    for (int k = 0; k <= 4; ++k)
      EXPECT_LE(specimen.zone->distance(f.from + k / 4.0 * (f.to - f.from)), -0.6 + 1e-9);
  }
}

TEST(Fibers, WhatCannotBeIsRefusedWithAHint) {
  const Specimen specimen = box_specimen({0, 0, 0}, {10, 10, 10});
  FiberOptions options;
  options.fraction = 0.5;
  options.length = 5;
  const auto full = pack_fibers(specimen, options);
  ASSERT_FALSE(full.ok());
  EXPECT_NE(full.error().message.find("of 127 fibers"), std::string::npos);
  EXPECT_FALSE(full.error().hint.empty());
  options.fraction = 0.01;
  options.length = 30;
  EXPECT_FALSE(pack_fibers(specimen, options).ok());  // longer than the diagonal
  options.length = 5;
  options.orientation = Mat<3>::Identity();
  EXPECT_NE(pack_fibers(specimen, options).error().message.find("trace"), std::string::npos);
}

TEST(Microstructure, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  const Progress progress({}, stop.get_token());
  const Specimen specimen = box_specimen({0, 0, 0}, {10, 10, 10});
  InclusionOptions balls;
  balls.count = 1;
  FiberOptions fibers;
  fibers.count = 1;
  EXPECT_EQ(polycrystal_seeds(specimen, {}, progress).error().code, Code::cancelled);
  EXPECT_EQ(pack_balls(specimen, balls, progress).error().code, Code::cancelled);
  EXPECT_EQ(pack_fibers(specimen, fibers, progress).error().code, Code::cancelled);
}

}  // namespace
}  // namespace lamella
