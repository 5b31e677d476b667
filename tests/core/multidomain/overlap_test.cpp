#include "core/multidomain/overlap.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

constexpr double kPi = std::numbers::pi;

/// Of two balls of radius r whose centers are d apart.
double lens(double r, double d) { return kPi * (4 * r + d) * std::pow(2 * r - d, 2) / 12; }

TEST(Overlap, OfTwoBallsIsTheLens) {
  const Partition<3> p({{"a", ball_zone<3>({0, 0, 0}, 1)}, {"b", ball_zone<3>({0.9, 1.2, 0}, 1)}});
  for (const double tolerance : {1e-2, 1e-3}) {
    OverlapOptions options;
    options.tolerance = tolerance;
    const Result<OverlapReport> report = find_overlaps(p, options);
    ASSERT_TRUE(report.ok());
    ASSERT_EQ(report->overlaps.size(), 1u);
    const Overlap& o = report->overlaps[0];
    EXPECT_NEAR(o.volume, lens(1, 1.5), tolerance * lens(1, 1.5));
    EXPECT_LE(std::abs(o.volume - lens(1, 1.5)), o.error);
    EXPECT_NEAR(o.depth, 0.25, 1e-3);
    EXPECT_LT((o.place - Vec<3>(0.45, 0.6, 0)).norm(), 0.05);
    EXPECT_FALSE(o.inner.has_value());
    EXPECT_TRUE(report->gaps.empty());
  }
}

TEST(Overlap, OfFlatBodiesIsExact) {
  const Mat<3> turn = testing::turn(0.6, {1, 2, 3});
  ReferenceSurface<3> a = testing::box_surface({2, 1, 1}), b = a;
  for (Vec<3>& x : a.points) x = turn * x;
  for (Vec<3>& x : b.points) x = turn * (x + Vec<3>(1.999, 0.25, 0));
  const Partition<3> p({{"a", surface_zone<3>(a)}, {"b", surface_zone<3>(b)}});
  OverlapOptions options;
  const Result<OverlapReport> report = find_overlaps(p, options);
  ASSERT_TRUE(report.ok());
  ASSERT_EQ(report->overlaps.size(), 1u);
  EXPECT_NEAR(report->overlaps[0].volume, 0.001 * 0.75, 2e-5);  // a slab much thinner than a cell
  EXPECT_NEAR(report->overlaps[0].depth, 0.0005, 1e-6);
  options.contact = 0.001;
  EXPECT_TRUE(find_overlaps(p, options)->overlaps.empty());
}

TEST(Overlap, BodiesThatTouchDoNotOverlapAndHaveNoGap) {
  std::vector<Region<3>> regions;
  for (int i = 0; i < 12; ++i) {
    const Vec<3> low(i % 3, i / 3 % 2, i / 6);
    regions.push_back({std::to_string(i), box_zone<3>(low, low + Vec<3>::Ones())});
  }
  OverlapOptions options;
  options.gap_width = 0.2;
  const Result<OverlapReport> report = find_overlaps(Partition<3>(regions), options);
  ASSERT_TRUE(report.ok());
  EXPECT_TRUE(report->overlaps.empty());
  EXPECT_TRUE(report->gaps.empty());

  std::vector<Vec<3>> seeds;
  std::mt19937_64 random(4);
  for (int i = 0; i < 60; ++i)
    seeds.push_back(Vec<3>(static_cast<double>(random() % 1000),
                           static_cast<double>(random() % 1000),
                           static_cast<double>(random() % 1000)) /
                    1000);
  std::vector<Region<3>> grains;
  for (std::size_t i = 0; i < seeds.size(); ++i)
    grains.push_back({std::to_string(i), voronoi_zone<3>(seeds, i)});
  EXPECT_EQ(find_overlaps(Partition<3>(grains)).error().code, Code::bad_input);
  OverlapOptions in_box;
  in_box.within = Box<3>{Vec<3>::Zero(), Vec<3>::Ones()};
  const Result<OverlapReport> none = find_overlaps(Partition<3>(grains), in_box);
  ASSERT_TRUE(none.ok());
  EXPECT_TRUE(none->overlaps.empty());
}

TEST(Overlap, NestedBodiesAreTold) {
  const Partition<3> p({{"inner", box_zone<3>({1, 1, 1}, {2, 3, 2})},
                        {"outer", box_zone<3>({0, 1, 0}, {4, 4, 4})},
                        {"ball", ball_zone<3>({2, 2.5, 2}, 1.45)},
                        {"through", box_zone<3>({1, -1, 1}, {2, 5, 2})}});
  const Result<OverlapReport> report = find_overlaps(p);
  ASSERT_TRUE(report.ok());
  const auto inner = [&](int a, int b) {
    for (const Overlap& o : report->overlaps)
      if (o.first == a && o.second == b) return o.inner.value_or(-1);
    return -2;
  };
  EXPECT_EQ(inner(0, 1), 0);
  EXPECT_EQ(inner(1, 2), 2);
  EXPECT_EQ(inner(0, 2), -1);
  EXPECT_EQ(inner(0, 3), 0);
  EXPECT_EQ(inner(1, 3), -1);
  EXPECT_DOUBLE_EQ(report->overlaps[0].volume, 2);
}

TEST(Overlap, TheGapOfTwoPlates) {
  const double g = 0.25;
  const Partition<3> p(
      {{"low", box_zone<3>({0, 0, -1}, {10, 6, 0})}, {"high", box_zone<3>({0, 0, g}, {10, 6, 2})}});
  OverlapOptions options;
  options.gap_width = 0.4;
  options.within = Box<3>{Vec<3>(1, 1, -2), Vec<3>(9, 5, 3)};
  Result<OverlapReport> report = find_overlaps(p, options);
  ASSERT_TRUE(report.ok());
  EXPECT_TRUE(report->overlaps.empty());
  ASSERT_EQ(report->gaps.size(), 1u);
  EXPECT_NEAR(report->gaps[0].volume, 8 * 4 * g, 1e-9);
  EXPECT_NEAR(report->gaps[0].mean_width, g, 1e-12);
  EXPECT_NEAR(report->gaps[0].least_width, g, 1e-12);
  EXPECT_GT(report->gaps[0].place[2], 0);
  EXPECT_LT(report->gaps[0].place[2], g);
  // The rim adds what is nearer to both edges than the gap width, at most half its width around.
  options.within.reset();
  report = find_overlaps(p, options);
  ASSERT_EQ(report->gaps.size(), 1u);
  EXPECT_GE(report->gaps[0].volume, 60 * g * 0.999);
  EXPECT_LE(report->gaps[0].volume, 10.25 * 6.25 * g * 1.001);
  options.gap_width = 0.2;
  EXPECT_TRUE(find_overlaps(p, options)->gaps.empty());
}

TEST(Overlap, TheGapOfABallInItsSocket) {
  const auto socket = intersection_zone<3>(
      {box_zone<3>({-3, -3, -3}, {3, 3, 3}), complement_zone<3>(ball_zone<3>({0, 0, 0}, 1.2))});
  const Partition<3> p({{"socket", socket}, {"ball", ball_zone<3>({0.05, 0, 0}, 1)}});
  OverlapOptions options;
  options.gap_width = 0.5;
  const Result<OverlapReport> report = find_overlaps(p, options);
  ASSERT_TRUE(report.ok());
  EXPECT_TRUE(report->overlaps.empty());
  ASSERT_EQ(report->gaps.size(), 1u);
  EXPECT_NEAR(report->gaps[0].volume, 4 * kPi / 3 * (std::pow(1.2, 3) - 1), 0.01);
  EXPECT_NEAR(report->gaps[0].least_width, 0.15, 1e-3);
  EXPECT_GT(report->gaps[0].place[0], 1);
  EXPECT_NEAR(report->gaps[0].mean_width, 0.2, 0.01);
}

TEST(Overlap, AThirdBodyBetweenLeavesNoGap) {
  const Partition<3> p({{"low", box_zone<3>({0, 0, -1}, {4, 4, 0})},
                        {"foil", box_zone<3>({0, 0, 0.1}, {4, 4, 0.2})},
                        {"high", box_zone<3>({0, 0, 0.3}, {4, 4, 1})}});
  OverlapOptions options;
  options.gap_width = 0.5;
  const Result<OverlapReport> report = find_overlaps(p, options);
  ASSERT_TRUE(report.ok());
  double across = 0;
  for (const Gap& gap : report->gaps)
    if (gap.first == 0 && gap.second == 2)
      across = gap.volume;
    else
      EXPECT_NEAR(gap.mean_width, 0.1, 0.01);
  EXPECT_GE(report->gaps.size(), 2u);
  EXPECT_LT(across, 0.02 * 16 * 0.2);  // around the rim of the foil only
}

TEST(Overlap, NeitherOrderNorThreadsMatterAndManyBodiesAreNoTrouble) {
  std::vector<Region<3>> regions;
  std::mt19937_64 random(11);
  const auto number = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int i = 0; i < 80; ++i)
    regions.push_back(
        {std::to_string(i),
         ball_zone<3>({17 * number(), 17 * number(), 17 * number()}, 0.6 + number())});
  OverlapOptions options;
  options.gap_width = 0.1;
  options.tolerance = 1e-2;
  options.threads = 1;
  const Result<OverlapReport> once = find_overlaps(Partition<3>(regions), options);
  options.threads = 2;
  const Result<OverlapReport> again = find_overlaps(Partition<3>(regions), options);
  std::reverse(regions.begin(), regions.end());
  const Result<OverlapReport> back = find_overlaps(Partition<3>(regions), options);
  ASSERT_TRUE(once.ok() && again.ok() && back.ok());
  ASSERT_GT(once->overlaps.size(), 10u);
  ASSERT_EQ(once->overlaps.size(), again->overlaps.size());
  ASSERT_EQ(once->overlaps.size(), back->overlaps.size());
  ASSERT_EQ(once->gaps.size(), back->gaps.size());
  for (std::size_t i = 0; i < once->overlaps.size(); ++i) {
    const Overlap& o = once->overlaps[i];
    EXPECT_EQ(o.volume, again->overlaps[i].volume);
    EXPECT_EQ(o.place, again->overlaps[i].place);
    const auto same = std::find_if(
        back->overlaps.begin(), back->overlaps.end(),
        [&](const auto& b) { return b.first == 79 - o.second && b.second == 79 - o.first; });
    ASSERT_NE(same, back->overlaps.end());
    EXPECT_NEAR(same->volume, o.volume, 1e-9);
    EXPECT_NEAR(same->depth, o.depth, 1e-3);
  }
}

TEST(Overlap, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  const Partition<3> p({{"a", ball_zone<3>({0, 0, 0}, 1)}, {"b", ball_zone<3>({1, 0, 0}, 1)}});
  const Result<OverlapReport> report = find_overlaps(p, {}, Progress({}, stop.get_token()));
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().code, Code::cancelled);
}

}  // namespace
}  // namespace lamella
