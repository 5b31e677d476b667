#include "core/geometry/wrap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/geometry/self_intersection.h"
#include "core/geometry/winding.h"
#include "tests/support/soups.h"

namespace lamella {
namespace {

using test::both;
using test::box_soup;
using test::Soup;
using test::turned;

double volume_of(const Triangles& t) {
  double six = 0;
  for (std::size_t f = 0; f < t.facets.size(); ++f) {
    const auto p = t.corners(f);
    six += p[0].dot(p[1].cross(p[2]));
  }
  return six / 6;
}

/// Every wrap must be closed, manifold and free of self-intersections.
Wrapped wrap_of(const Soup& soup, double spacing) {
  WrapParams params;
  params.spacing = spacing;
  auto wrapped = wrap(merge_exact(soup), params);
  EXPECT_TRUE(wrapped.ok()) << wrapped.error().message;
  if (!wrapped.ok()) return {};
  const EdgeDefects d = find_edge_defects(wrapped->surface);
  EXPECT_EQ(d.open, 0);
  EXPECT_EQ(d.non_manifold, 0);
  EXPECT_TRUE(self_intersecting_pairs(wrapped->surface.points, wrapped->surface.facets).empty());
  return *std::move(wrapped);
}

Soup rotated(Soup soup) {
  const Mat<3> r = Eigen::AngleAxisd(0.7, Vec<3>(1, 2, -.5).normalized()).toRotationMatrix();
  for (auto& f : soup)
    for (Vec<3>& p : f) p = r * p;
  return soup;
}

/// Facets of a unit sphere that share no vertex: each a little apart, one in fifty missing.
Soup loose_sphere(int n) {
  Soup soup;
  const auto at = [&](int i, int j) {
    const double a = std::numbers::pi * i / n, b = std::numbers::pi * j / n;
    return Vec<3>(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
  };
  std::mt19937 random(3);
  std::uniform_real_distribution<double> jitter(-1e-4, 1e-4);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      if (i > 0) soup.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + 1 < n) soup.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  Soup loose;
  for (std::size_t k = 0; k < soup.size(); ++k) {
    if (k % 50 == 49) continue;
    for (Vec<3>& p : soup[k]) p += Vec<3>(jitter(random), jitter(random), jitter(random));
    loose.push_back(soup[k]);
  }
  return loose;
}

TEST(WindingNumber, IsOneInsideAndZeroOutside) {
  const Triangles t = merge_exact(rotated(box_soup({-1, -1, -1}, {1, 1, 1})));
  const WindingNumber w(t.points, t.facets);
  EXPECT_NEAR(w(Vec<3>(.1, .2, -.3)), 1, 1e-9);
  EXPECT_NEAR(w(Vec<3>(4, 0, 0)), 0, 1e-3);
  const Triangles s = merge_exact(loose_sphere(40));
  const WindingNumber v(s.points, s.facets);
  EXPECT_NEAR(v(Vec<3>(.1, .2, -.3)), .98, 1e-2);
  EXPECT_NEAR(v(Vec<3>(0, 1.5, 0)), 0, 1e-2);
}

TEST(Wrap, KeepsTheEdgesAndCornersOfABox) {
  for (const bool turn : {false, true}) {
    const Soup box = box_soup({0, 0, 0}, {4, 2, 1});
    const Wrapped w = wrap_of(turn ? rotated(box) : box, .15);
    // An edge that leaves a cell where it came in is not seen: only where it lies aslant.
    const double share = turn ? .87 : .1;
    EXPECT_NEAR(volume_of(w.surface), 8, share * 1e-2 * 8);
    EXPECT_LT(w.to_file.distance, share * .15);
    EXPECT_LT(w.from_file.distance, share * .15);
    EXPECT_EQ(w.bridged_area, 0);
  }
}

TEST(Wrap, UnitesBodiesThatCross) {
  const Soup soup = rotated(both(box_soup({0, 0, 0}, {2, 2, 2}), box_soup({1, 1, 1}, {3, 3, 3})));
  EXPECT_NEAR(volume_of(wrap_of(soup, .1).surface), 15, 5e-3 * 15);
}

TEST(Wrap, ConvergesOnASoupOfASphere) {
  const Soup soup = loose_sphere(48);
  double before = 0;
  for (const double h : {.2, .1}) {
    const Wrapped w = wrap_of(soup, h);
    const double off = std::abs(volume_of(w.surface) / (4 * std::numbers::pi / 3) - 1);
    EXPECT_LT(off, .25 * h);
    EXPECT_LT(w.to_file.distance, .3 * h);
    if (before > 0) {
      EXPECT_LT(off, .7 * before);
    }
    before = off;
  }
}

TEST(Wrap, ClosesAHole) {
  Soup soup = box_soup({0, 0, 0}, {2, 2, 2});
  Soup fine;  // one side in small squares, the middle of it missing
  std::erase_if(soup, [](const auto& f) { return f[0][2] == 2 && f[1][2] == 2 && f[2][2] == 2; });
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j) {
      if (i > 2 && i < 7 && j > 2 && j < 7) continue;
      const Vec<3> p(.2 * i, .2 * j, 2), x(.2, 0, 0), y(0, .2, 0);
      soup.push_back({p, p + x, p + x + y});
      soup.push_back({p, p + x + y, p + y});
    }
  const Wrapped w = wrap_of(soup, .1);
  EXPECT_GT(w.bridged_area, .3);
  EXPECT_NEAR(volume_of(w.surface), 8, .15);
}

TEST(Wrap, KeepsVoidsAndTurnsShells) {
  const Soup hollow = both(box_soup({0, 0, 0}, {3, 3, 3}), turned(box_soup({1, 1, 1}, {2, 2, 2})));
  EXPECT_NEAR(volume_of(wrap_of(hollow, .15).surface), 26, .1);
  EXPECT_NEAR(volume_of(wrap_of(turned(box_soup({0, 0, 0}, {3, 3, 3})), .2).surface), 27, .1);
}

TEST(Wrap, BoundsItsMemory) {
  WrapParams params;
  params.spacing = 1e-4;
  params.memory = 1;
  const auto w = wrap(merge_exact(test::unit_box()), params);
  ASSERT_TRUE(w.ok());
  EXPECT_GT(w->spacing, .05);
}

TEST(Wrap, RefusesWhatEnclosesNothing) {
  EXPECT_FALSE(wrap({}).ok());
  EXPECT_FALSE(wrap(merge_exact({{Vec<3>(0, 0, 0), Vec<3>(1, 0, 0), Vec<3>(0, 1, 0)}})).ok());
}

TEST(Wrap, CancelReturnsCancelled) {
  std::stop_source stop;
  stop.request_stop();
  const auto w = wrap(merge_exact(test::unit_box()), {}, Progress({}, stop.get_token()));
  ASSERT_FALSE(w.ok());
  EXPECT_EQ(w.error().code, Code::cancelled);
}

}  // namespace
}  // namespace lamella
