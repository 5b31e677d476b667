#include "core/geometry/locator.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

using namespace lamella::testing;

template <int D>
Vec<D> random_point(std::mt19937& rng, double half) {
  std::uniform_real_distribution<double> u(-half, half);
  Vec<D> x;
  for (int a = 0; a < D; ++a) x[a] = u(rng);
  return x;
}

/// Distance to the triangle by minimizing over a fine set is too coarse; the exact distance is the
/// plane's if the projection is inside, else the nearest edge's.
double brute_distance(const ReferenceSurface<3>& s, std::size_t f, const Vec<3>& x) {
  std::array<Vec<3>, 3> p;
  for (int k = 0; k < 3; ++k) p[k] = s.points[s.facets[f][k]];
  const Vec<3> n = facet_normal<3>(p);
  bool inside = true;
  double edge = 1e300;
  for (int k = 0; k < 3; ++k) {
    const Vec<3> a = p[k], e = p[(k + 1) % 3] - a;
    if (n.cross(e).dot(x - a) < 0) inside = false;
    const double t = std::clamp(e.dot(x - a) / e.squaredNorm(), 0.0, 1.0);
    edge = std::min(edge, (x - a - t * e).norm());
  }
  return inside ? std::abs(n.dot(x - p[0])) / n.norm() : edge;
}

double volume(const ReferenceSurface<3>& s) {
  double v = 0;
  for (const auto& [a, b, c] : s.facets) v += s.points[a].dot(s.points[b].cross(s.points[c])) / 6;
  return v;
}

TEST(Locator, SampleSurfacesAreOutward) {
  EXPECT_NEAR(volume(box_surface({1, 2, 3}, {2, 1, 3})), 6, 1e-12);
  EXPECT_NEAR(volume(l_surface(0.1)), 0.19, 1e-12);
  EXPECT_NEAR(volume(sphere_surface(1, 4)), 4.18879, 0.02);
  EXPECT_NEAR(volume(tube_surface(1, 2, 3, 400, 5)), 9 * std::numbers::pi, 0.01);
  EXPECT_NEAR(volume(prism_surface({{0, 0}, {2, 0}, {2, 1}}, 3)), 3, 1e-12);
}

TEST(Locator, NearestAgreesWithEveryFacetTried) {
  std::mt19937 rng(1);
  ReferenceSurface<3> soup;  // not a surface at all: the search must not care
  for (int f = 0; f < 600; ++f) {
    const Vec<3> c = random_point<3>(rng, 1);
    for (int k = 0; k < 3; ++k) soup.points.push_back(c + random_point<3>(rng, f % 7 ? 0.05 : 0.6));
    soup.facets.push_back({3 * f, 3 * f + 1, 3 * f + 2});
    soup.facet_face.push_back(f % 11);
  }
  soup = with_faces(soup);
  const Locator<3> locator(soup);
  for (int i = 0; i < 400; ++i) {
    const Vec<3> x = random_point<3>(rng, i % 5 ? 1.5 : 200);
    double best = 1e300, on_face = 1e300;
    for (std::size_t f = 0; f < soup.facets.size(); ++f) {
      const double d = brute_distance(soup, f, x);
      best = std::min(best, d);
      if (soup.facet_face[f] == i % 11) on_face = std::min(on_face, d);
    }
    const auto found = locator.nearest(x);
    ASSERT_TRUE(found);
    EXPECT_NEAR(std::sqrt(found->distance2), best, 1e-12 * (1 + best));
    EXPECT_NEAR((found->point - x).norm(), best, 1e-12 * (1 + best));
    EXPECT_NEAR(brute_distance(soup, found->facet, found->point), 0, 1e-12);
    const auto face = locator.nearest_on_face(x, i % 11);
    ASSERT_TRUE(face);
    EXPECT_EQ(soup.facet_face[face->facet], i % 11);
    EXPECT_NEAR(std::sqrt(face->distance2), on_face, 1e-12 * (1 + on_face));
    EXPECT_FALSE(locator.nearest(x, 0.999 * best));
    EXPECT_TRUE(locator.nearest(x, 1.001 * best));

    std::vector<Nearest<3>> within;
    locator.all_within(x, 1.3 * best, within);
    std::size_t expected = 0;
    for (std::size_t f = 0; f < soup.facets.size(); ++f)
      if (brute_distance(soup, f, x) <= 1.3 * best) ++expected;
    EXPECT_EQ(within.size(), expected);
    ASSERT_FALSE(within.empty());
    EXPECT_EQ(within[0].distance2, found->distance2);
  }
  EXPECT_FALSE(locator.nearest_on_face({0, 0, 0}, 11));
  EXPECT_FALSE(locator.nearest_on_face({0, 0, 0}, -1));
}

TEST(Locator, ExitAgreesWithEveryFacetTried) {
  std::mt19937 rng(2);
  const auto s = together(tube_surface(0.6, 0.9, 1.4, 23, 4), sphere_surface(0.5, 2));
  const Locator<3> locator(s);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec<3> x = random_point<3>(rng, 1.2), u = random_point<3>(rng, 1).normalized();
    double best = 1e300;
    for (const auto& f : s.facets) {
      const Vec<3> a = s.points[f[0]], b = s.points[f[1]], c = s.points[f[2]];
      const Vec<3> n = (b - a).cross(c - a);
      if (n.dot(u) <= 0) continue;
      Mat<3> m;
      m << b - a, c - a, -u;
      const Vec<3> lambda = m.inverse() * (x - a);
      if (lambda[0] >= 0 && lambda[1] >= 0 && lambda[0] + lambda[1] <= 1 && lambda[2] > 0)
        best = std::min(best, lambda[2]);
    }
    const auto hit = locator.exit(x, u);
    ASSERT_EQ(hit.has_value(), best < 1e300);
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(hit->t, best, 1e-9);
    EXPECT_GT(locator.normal(hit->facet).dot(u), 0);
    EXPECT_FALSE(locator.exit(x, u, 0, 0.999 * best));
    const auto beyond = locator.exit(x, u, 1.001 * best);
    EXPECT_TRUE(!beyond || beyond->t > 1.001 * best);
  }
  EXPECT_GT(hits, 500);
}

TEST(Locator, RaysAimedAtVerticesAndEdgesNeverLeak) {
  std::mt19937 rng(3);
  auto s = moved<3>(sphere_surface(1, 3), turn(0.3, {1, 2, 3}), {100, -40, 7});
  const Locator<3> locator(s);
  const Vec<3> c{100, -40, 7};
  for (int i = 0; i < 5; ++i) {
    const Vec<3> x = c + random_point<3>(rng, 0.4);
    for (const auto& f : s.facets) {
      const Vec<3> middle = 0.5 * (s.points[f[0]] + s.points[f[1]]);
      for (const Vec<3>& target : {s.points[f[0]], middle}) {
        const auto hit = locator.exit(x, (target - x).normalized());
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->t, (target - x).norm(), 1e-9);
      }
    }
  }
  // Axis-parallel rays in the very planes of a grid.
  const auto box = box_surface({1, 1, 1}, {4, 4, 4});
  const Locator<3> cube(box);
  for (const double y : {0.25, 0.5, 0.75})
    for (const double z : {0.25, 0.5, 0.3}) {
      const auto hit = cube.exit({0.5, y, z}, {-1, 0, 0});
      ASSERT_TRUE(hit);
      EXPECT_NEAR(hit->t, 0.5, 1e-12);
    }
}

TEST(Locator, SignedDistanceOfABoxIsExactEverywhere) {
  std::mt19937 rng(4);
  const Mat<3> r = turn(0.7, {1, -2, 0.5});
  const Vec<3> shift{5, 6, -7}, half{1, 0.5, 0.05};
  const auto s = moved<3>(box_surface(2 * half, {3, 2, 1}), r, r * -half + shift);
  const Locator<3> locator(s);
  for (int i = 0; i < 3000; ++i) {
    const Vec<3> local =
        random_point<3>(rng, 1).cwiseProduct(i % 2 ? Vec<3>(half * 1.2) : Vec<3>(2, 2, 2));
    const Vec<3> out = local.cwiseAbs() - half;
    const double exact = out.cwiseMax(0.0).norm() + std::min(out.maxCoeff(), 0.0);
    EXPECT_NEAR(locator.signed_distance(r * local + shift), exact, 1e-12);
  }
  const auto corner = locator.signed_nearest(r * Vec<3>(2, 2, 2) + shift);
  EXPECT_NEAR(corner.pseudo_normal.dot(r * Vec<3>(1, 1, 1).normalized()), 1, 1e-9);
}

TEST(Locator, SignIsRightAroundConcaveEdgesAndSharpBlades) {
  std::mt19937 rng(5);
  const double t = 0.1;
  const Locator<3> l(l_surface(t));
  // A blade of 6 degrees, and a star-like notch: seen from outside near the tip the plane of one
  // face alone would say "inside".
  const std::vector<Vec<2>> blade{{0, 0}, {1, 0}, {1, 0.1}};
  const Locator<3> b(prism_surface(blade, 1));
  for (int i = 0; i < 3000; ++i) {
    const Vec<3> x = random_point<3>(rng, 0.8) + Vec<3>(0.5, 0.5, 0.5);
    const bool in_box = x.minCoeff() > 0 && x.maxCoeff() < 1;
    EXPECT_EQ(l.inside(x), in_box && (x[0] < t || x[2] < t));
    const Vec<3> y{x[0], x[1], 0.2 * (x[2] - 0.3)};
    EXPECT_EQ(b.inside(y), y[1] > 0 && y[1] < 1 && y[0] < 1 && y[2] > 0 && y[2] < 0.1 * y[0]);
  }
}

TEST(Locator, SphereDistanceWithinItsChord) {
  std::mt19937 rng(6);
  const auto s = sphere_surface(2, 4, {1, 1, 1});
  const Locator<3> locator(s);
  for (int i = 0; i < 500; ++i) {
    const Vec<3> x = Vec<3>(1, 1, 1) + random_point<3>(rng, 3);
    EXPECT_NEAR(locator.signed_distance(x), (x - Vec<3>(1, 1, 1)).norm() - 2, 0.006);
  }
}

TEST(Locator, PlaneCurvesWorkTheSame) {
  std::mt19937 rng(7);
  const auto s = polygon_surface(1, 500);
  const Locator<2> locator(s);
  for (int i = 0; i < 1000; ++i) {
    const Vec<2> x = random_point<2>(rng, 1.5);
    EXPECT_NEAR(locator.signed_distance(x), x.norm() - 1, 3e-5);
    double face = 1e300;
    for (std::size_t f = 0; f < s.facets.size(); ++f) {
      if (s.facet_face[f] != 1) continue;
      const Vec<2> a = s.points[s.facets[f][0]], e = s.points[s.facets[f][1]] - a;
      face =
          std::min(face, (x - a - std::clamp(e.dot(x - a) / e.squaredNorm(), 0., 1.) * e).norm());
    }
    EXPECT_NEAR(std::sqrt(locator.nearest_on_face(x, 1)->distance2), face, 1e-12);
    const Vec<2> u = random_point<2>(rng, 1).normalized();
    const auto hit = locator.exit(x, u);
    if (x.norm() < 0.999) {
      ASSERT_TRUE(hit);
      EXPECT_NEAR((x + hit->t * u).norm(), 1, 3e-5);
    }
  }
  for (const auto& p : s.points)
    EXPECT_TRUE(locator.exit({0.1, 0.2}, (p - Vec<2>(0.1, 0.2)).normalized()));
}

TEST(Locator, EmptyAndDegenerateSurfacesAnswer) {
  const Locator<3> nothing(ReferenceSurface<3>{});
  EXPECT_FALSE(nothing.nearest({0, 0, 0}));
  EXPECT_FALSE(nothing.exit({0, 0, 0}, {1, 0, 0}));
  EXPECT_EQ(nothing.signed_distance({0, 0, 0}), std::numeric_limits<double>::infinity());

  ReferenceSurface<3> flat;  // a needle, a point, and many facets with one center
  flat.points = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
  flat.facets = {{0, 1, 2}, {1, 1, 1}};
  for (int i = 0; i < 50; ++i) flat.facets.push_back({0, 1, 2});
  const Locator<3> needle(with_faces(flat));
  EXPECT_NEAR(needle.nearest({2.5, 1, 0})->distance2, 1, 1e-12);
  EXPECT_FALSE(needle.exit({2.5, 1, 0}, {0, -1, 0}));
}

}  // namespace
}  // namespace lamella
