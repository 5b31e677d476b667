#include "core/multidomain/feature_chains.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/geometry/foot.h"
#include "core/geometry/soup.h"
#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

double length(const std::vector<Vec<3>>& chain) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) sum += (chain[i + 1] - chain[i]).norm();
  return sum;
}

TEST(FeatureChains, ABoxHasTwelveStraightOnes) {
  auto s = testing::box_surface({1, 2, 3}, {2, 3, 4});
  find_features(s, 0.6);
  const auto chains = feature_chains(s, 1e-6);
  ASSERT_EQ(chains.size(), 12u);
  double sum = 0;
  for (const auto& chain : chains) {
    EXPECT_EQ(chain.size(), 2u);
    sum += length(chain);
  }
  EXPECT_NEAR(sum, 4 * (1 + 2 + 3), 1e-12);
}

TEST(FeatureChains, ACircleIsThinnedWithinTheTolerance) {
  const double radius = 0.5, tolerance = 0.01;
  std::vector<Vec<2>> circle;
  for (int i = 0; i < 200; ++i) {
    const double phi = 2 * std::numbers::pi * i / 200;
    circle.push_back({radius * std::cos(phi), radius * std::sin(phi)});
  }
  auto s = testing::prism_surface(circle, 1);
  find_features(s, 0.6);
  const auto chains = feature_chains(s, tolerance);
  ASSERT_EQ(chains.size(), 2u);
  for (const auto& chain : chains) {
    EXPECT_EQ(chain.front(), chain.back());
    EXPECT_LT(chain.size(), 40u);
    for (const auto& e : s.feature_edges) {
      const Vec<3>& x = s.points[e[0]];
      if (x[1] != chain[0][1]) continue;
      double near = 1;
      for (std::size_t i = 0; i + 1 < chain.size(); ++i)
        near = std::min(near, (foot_on_segment<3>(chain[i], chain[i + 1], x).point - x).norm());
      EXPECT_LE(near, tolerance);
    }
  }
}

TEST(Creases, AreWhatChordsWouldMiss) {
  // A gable of 20 degrees on each side; a fan of 10 degrees a facet around a cylinder.
  const double rise = std::tan(std::numbers::pi / 9), tolerance = 0.01;
  auto gable = testing::prism_surface({{-1, 0}, {1, 0}, {1, 1}, {0, 1 + rise}, {-1, 1}}, 1);
  find_features(gable, 0.75);
  const auto ridge_among = [](const ReferenceSurface<3>& s) {
    return std::count_if(s.feature_edges.begin(), s.feature_edges.end(), [&](const auto& e) {
      return s.points[e[0]][2] > 1.1 && s.points[e[1]][2] > 1.1;
    });
  };
  ASSERT_EQ(ridge_among(gable), 0);
  EXPECT_EQ(ridge_among(with_creases(gable, tolerance)), 1);
  EXPECT_EQ(ridge_among(with_creases(gable, 1)), 0);  // no deeper than allowed
  EXPECT_EQ(with_creases(gable, 1).feature_edges, gable.feature_edges);

  const double radius = 0.5;
  auto tube = testing::tube_surface(0.5 * radius, radius, 1, 36, 1);
  find_features(tube, 0.6);
  EXPECT_EQ(with_creases(tube, tolerance).feature_edges, tube.feature_edges);
}

}  // namespace
}  // namespace lamella
