#include "core/natural/medial_ball.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

using namespace lamella::testing;

TEST(SmallestInHull, KnownHulls) {
  EXPECT_NEAR((smallest_in_hull({{1, 0, 0}}) - Vec<3>(1, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR(smallest_in_hull({{1, 0, 0}, {-1, 0, 0}}).norm(), 0, 1e-12);
  EXPECT_NEAR(smallest_in_hull({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}).norm(), 1 / std::sqrt(3.0),
              1e-12);
  EXPECT_NEAR(smallest_in_hull({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}).norm(), 0,
              1e-12);
}

TEST(SmallestInHull, NoPointOfTheHullIsNearer) {
  std::mt19937 rng(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 500; ++i) {
    std::vector<Vec<3>> p(1 + i % 9);
    for (auto& q : p) q = Vec<3>(normal(rng) + 0.5, normal(rng), normal(rng)).normalized();
    const Vec<3> g = smallest_in_hull(p);
    // Optimality: the plane through g, normal to g, has every point on its far side.
    for (const auto& q : p) EXPECT_GE(q.dot(g), g.squaredNorm() - 1e-6);
    // Membership, seen from 200 directions.
    for (int k = 0; k < 200; ++k) {
      const Vec<3> u = Vec<3>(normal(rng), normal(rng), normal(rng)).normalized();
      double most = -1e300;
      for (const auto& q : p) most = std::max(most, q.dot(u));
      EXPECT_LE(g.dot(u), most + 1e-9);
    }
  }
}

TEST(MedialBall, IsInsideAndTouches) {
  const auto s = l_surface(0.1);
  const Locator<3> locator(s);
  std::mt19937 rng(2);
  std::uniform_real_distribution<double> u(0, 1);
  for (int i = 0; i < 300; ++i) {
    const Vec<3> x{u(rng), u(rng), 0.1 * u(rng)};
    const MedialBall ball = climb_to_medial_ball(locator, x);
    EXPECT_NEAR(locator.signed_distance(ball.center), -ball.radius, 1e-12);
    // A thinner ball would be a false stop at a convex edge; the inner corner allows .1172 at most.
    EXPECT_GT(2 * ball.radius, 0.09);
    EXPECT_LT(2 * ball.radius, 0.12);
  }
}

/// A plate along x whose end is cut by a cylinder, in strips of `step` radians: thin below.
ReferenceSurface<3> scooped_plate(double step, double length) {
  constexpr double radius = 5.24, height = 4;
  std::vector<Vec<2>> profile{{20, 2.5}, {20, 5}, {radius * std::cos(0.19), 5}};
  for (double angle = 0.19 - step; angle > -std::asin(height / radius); angle -= step)
    profile.emplace_back(radius * std::cos(angle), height + radius * std::sin(angle));
  profile.emplace_back(std::sqrt(radius * radius - height * height), 0);
  profile.emplace_back(20, 0);
  ReferenceSurface<3> s;
  s.faces.resize(1);
  const auto n = static_cast<std::int32_t>(profile.size());
  for (const double x : {0.0, length})
    for (const Vec<2>& p : profile) s.points.emplace_back(x, p[0], p[1]);
  for (std::int32_t i = 0; i < n; ++i) {
    const std::int32_t j = (i + 1) % n;
    s.facets.push_back({i, j, n + j});
    s.facets.push_back({i, n + j, n + i});
    if (i == 0 || j == 0) continue;
    s.facets.push_back({0, j, i});
    s.facets.push_back({n, n + i, n + j});
  }
  s.facet_face.assign(s.facets.size(), 0);
  return s;
}

TEST(MedialBall, IsTheSameAllAlongAPrism) {
  constexpr double length = 40;
  std::mt19937 rng(4);
  std::uniform_real_distribution<double> u(0, 1);
  for (const double step : {0.2, 0.3, 0.45}) {
    const auto s = scooped_plate(step, length);
    const Locator<3> locator(s);
    for (int i = 0; i < 400; ++i) {
      const double angle = -0.86 + u(rng);
      const Vec<3> wall{0, 5.24 * std::cos(angle), 4 + 5.24 * std::sin(angle)};
      const Vec<3> foot = locator.nearest(wall + Vec<3>(length / 2, 0, 0))->point;
      const double radius = climb_to_medial_ball(locator, foot).radius;
      for (int k = 0; k < 4; ++k) {
        const Vec<3> x = foot + Vec<3>(length * (0.5 * u(rng) - 0.25), 0, 0);
        EXPECT_NEAR(climb_to_medial_ball(locator, x).radius, radius, 0.1 * radius);
      }
    }
  }
}

/// A T in (x, z), along y: a plate of thickness `plate` under a rib of thickness `rib`.
ReferenceSurface<3> tee(double plate, double rib) {
  return cell_surface(
      {std::vector{0.0, 0.5 - rib / 2, 0.5 + rib / 2, 1.0}, {0.0, 1.0}, {0.0, plate, 0.5}},
      [](int i, int, int k) { return i == 1 || k == 0; });
}

TEST(MedialBalls, ReentrantEdgesAreJudgedByEachWallThatEndsThere) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(0, 1);
  const double plate = 0.1, rib = 0.04;
  const Mat<3> r = turn(0.7, {1, 2, 3});
  const auto s = moved<3>(tee(plate, rib), r, {3, 4, 5});
  const Locator<3> locator(s);
  for (const double side : {-0.5, 0.5})
    for (int i = 0; i < 40; ++i) {
      // Inside the edge, and its ends, where it meets the plane of the front or the back.
      const double y = i == 0 ? 0 : i == 1 ? 1 : u(rng);
      const Vec<3> x = r * Vec<3>(0.5 + side * rib, y, plate) + Vec<3>(3, 4, 5);
      std::vector<double> thickness;
      for (const MedialBall& ball : medial_balls(locator, x)) thickness.push_back(2 * ball.radius);
      ASSERT_GE(thickness.size(), 2u);
      std::sort(thickness.begin(), thickness.end());
      EXPECT_NEAR(thickness.front(), rib, 0.1 * rib);
      EXPECT_NEAR(thickness.back(), plate, 0.1 * plate);
    }
}

TEST(MedialBalls, ElsewhereItIsTheOneClimbedTo) {
  const auto s = tee(0.1, 0.04);
  const Locator<3> locator(s);
  std::mt19937 rng(4);
  std::uniform_real_distribution<double> u(0, 1);
  // Convex edges and corners, faces, and inside.
  std::vector<Vec<3>> places{{0, 0, 0}, {1, 0, 0.1}, {0.48, 0, 0.5}};
  for (int i = 0; i < 50; ++i) {
    places.push_back({u(rng), 0, 0});
    places.push_back({0.48, u(rng), 0.5});
    places.push_back({u(rng), u(rng), 0});
    places.push_back({u(rng), u(rng), 0.1 * u(rng)});
  }
  for (const Vec<3>& x : places) {
    const auto balls = medial_balls(locator, x);
    ASSERT_EQ(balls.size(), 1u) << x.transpose();
    EXPECT_EQ(balls[0].radius, climb_to_medial_ball(locator, x).radius);
  }
}

TEST(MedialBall, StartsOutsideOnCornersAndOnBladesToo) {
  const auto box = box_surface({1, 1, 0.1});
  const Locator<3> plate(box);
  for (const auto& corner : box.points)
    EXPECT_NEAR(2 * climb_to_medial_ball(plate, corner).radius, 0.1, 0.01);
  EXPECT_NEAR(2 * climb_to_medial_ball(plate, {0.5, 0.5, 3}).radius, 0.1, 1e-9);
  const Locator<3> blade(prism_surface({{0, 0}, {1, 0}, {1, 0.1}}, 1));
  const double tip = climb_to_medial_ball(blade, {0, 0.5, 0}).radius;
  EXPECT_GT(tip, 0);
  EXPECT_LT(tip, 1e-4);
}

TEST(MedialBall, KnifeEdgesOfAChamferAreNoThinWall) {
  // Chamfers of thick bodies end in edges of 45 degrees: the body is as thick there as elsewhere.
  const Locator<3> chamfer(prism_surface({{0, 0}, {1, 0}, {1, 1}}, 2));
  const double inscribed = 2 - std::sqrt(2.0);
  for (const double y : {0.6, 1.0, 1.4})
    EXPECT_NEAR(2 * climb_to_medial_ball(chamfer, {0, y, 0}).radius, inscribed, 0.1 * inscribed);
}

TEST(MedialBall, FineTessellationDoesNotStopTheClimb) {
  const Locator<3> shell(together(sphere_surface(1, 4), sphere_surface(0.9, 4, {0, 0, 0}, true)));
  const Locator<3> ball(sphere_surface(1, 4));
  std::mt19937 rng(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    const Vec<3> u = Vec<3>(normal(rng), normal(rng), normal(rng)).normalized();
    EXPECT_NEAR(2 * climb_to_medial_ball(shell, u).radius, 0.1, 0.003);
    EXPECT_GT(climb_to_medial_ball(ball, u).radius, 0.8);
  }
}

}  // namespace
}  // namespace lamella
