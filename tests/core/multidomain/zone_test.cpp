#include "core/multidomain/zone.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

using Contains = std::function<bool(const Vec<3>&)>;

struct Points {
  std::mt19937_64 random{7};
  Vec<3> in(double low, double high) {
    std::uniform_real_distribution<double> u(low, high);
    return {u(random), u(random), u(random)};
  }
  Vec<3> direction() {
    Vec<3> d;
    do d = in(-1, 1);
    while (d.norm() > 1 || d.norm() < 0.1);
    return d.normalized();
  }
};

/// The sign tells inside, the ball of radius |d| around a point meets no border, and the normal is
/// a unit vector.
void expect_lower_bound(const Zone<3>& zone, const Contains& contains, double tolerance = 1e-9) {
  Points points;
  for (int i = 0; i < 400; ++i) {
    const Vec<3> x = points.in(-3, 3);
    const ZoneDistance<3> at = zone.at(x);
    if (std::abs(at.distance) < 1e-6) continue;
    ASSERT_EQ(at.distance < 0, contains(x)) << x.transpose();
    EXPECT_NEAR(at.normal.norm(), 1, 1e-12);
    for (int k = 0; k < 20; ++k) {
      const double r = std::abs(at.distance) * (1 - 1e-9) - tolerance;
      const Vec<3> y = x + r * points.direction();
      ASSERT_EQ(contains(y), contains(x)) << x.transpose() << " and " << y.transpose();
      EXPECT_LE(std::abs(zone.distance(y) - at.distance), (y - x).norm() + tolerance);
    }
  }
}

/// Besides, the border is met at the distance told, along the normal, on which the distance falls
/// as the way does. With the above no other distance can be true.
void expect_exact(const Zone<3>& zone, const Contains& contains, bool outside_too = true) {
  expect_lower_bound(zone, contains);
  Points points;
  int seen = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec<3> x = points.in(-3, 3);
    const ZoneDistance<3> at = zone.at(x);
    if (!(std::abs(at.distance) > 1e-3) || (at.distance > 0 && !outside_too)) continue;
    ++seen;
    const auto foot = [&](double share) { return Vec<3>(x - share * at.distance * at.normal); };
    EXPECT_NEAR(zone.distance(foot(0.5)), at.distance / 2, 1e-9);
    EXPECT_NEAR(zone.distance(foot(1)), 0, 1e-9);
    // A corner may be met at a grazing angle from outside, but never a step before.
    EXPECT_EQ(contains(foot(1 - 1e-6)), contains(x));
  }
  EXPECT_GT(seen, 10);
}

/// Both ways of differences agree with the normal wherever they agree with each other.
void expect_gradient(const Zone<3>& zone) {
  Points points;
  int seen = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec<3> x = points.in(-3, 3);
    const double h = 1e-6, d = zone.distance(x);
    Vec<3> forward, backward;
    for (int k = 0; k < 3; ++k) {
      forward[k] = (zone.distance(x + h * Vec<3>::Unit(k)) - d) / h;
      backward[k] = (d - zone.distance(x - h * Vec<3>::Unit(k))) / h;
    }
    if ((forward - backward).norm() > 1e-4) continue;  // on the medial axis
    ++seen;
    EXPECT_LT((zone.at(x).normal - (forward + backward) / 2).norm(), 1e-4) << x.transpose();
  }
  EXPECT_GT(seen, 200);
}

void expect_in_box(const Zone<3>& zone) {
  const Box<3> box = zone.box();
  Points points;
  for (int i = 0; i < 2000; ++i) {
    const Vec<3> x = points.in(-3, 3);
    if (zone.distance(x) < 0) {
      EXPECT_TRUE((x - box.lo).minCoeff() >= -1e-12 && (box.hi - x).minCoeff() >= -1e-12)
          << x.transpose();
    }
  }
}

TEST(Zone, BallBoxAndHalfSpaceAreExact) {
  const Vec<3> c(0.3, -0.2, 0.5), low(-1, -2, -0.25), high(1, 0.5, 2), n(1, 2, -2);
  const auto ball = ball_zone<3>(c, 1.5);
  expect_exact(*ball, [&](const Vec<3>& x) { return (x - c).norm() < 1.5; });
  const auto box = box_zone<3>(low, high);
  expect_exact(
      *box, [&](const Vec<3>& x) { return (x - low).minCoeff() > 0 && (high - x).minCoeff() > 0; });
  const auto half = half_space_zone<3>(n, 1.5);
  expect_exact(*half, [&](const Vec<3>& x) { return n.dot(x) < 1.5; });
  for (const auto& zone : {ball, box, half}) {
    expect_gradient(*zone);
    expect_in_box(*zone);
  }
}

TEST(Zone, CylinderIsExactInAnyDirectionAndItsBoxTouchesIt) {
  for (const auto& [from, to] : {std::pair<Vec<3>, Vec<3>>{{0, 0, -1}, {0, 0, 2}},
                                 {{-1, 0.5, 0}, {1.5, -1, 1}},
                                 {{0, 0, 0}, {0.1, 0, 0.1}}}) {
    const double r = 0.8, length = (to - from).norm();
    const Vec<3> axis = (to - from) / length, start = from;
    const auto zone = cylinder_zone(from, to, r);
    expect_exact(*zone, [&](const Vec<3>& x) {
      const double along = axis.dot(x - start);
      return along > 0 && along < length && (x - start - along * axis).norm() < r;
    });
    expect_gradient(*zone);
    expect_in_box(*zone);
    // The extreme points of the rims lie on the sides of the box.
    Box<3> rims;
    for (int k = 0; k < 3; ++k)
      for (const Vec<3>& end : {from, to})
        for (const double sign : {-1.0, 1.0}) {
          const Vec<3> across = Vec<3>::Unit(k) - axis[k] * axis;
          rims.add(across.norm() > 1e-9 ? Vec<3>(end + sign * r * across.normalized()) : end);
        }
    EXPECT_LT((rims.lo - zone->box().lo).norm() + (rims.hi - zone->box().hi).norm(), 1e-9);
  }
}

TEST(Zone, VoronoiCellsDivideSpaceAndAreExactInside) {
  Points points;
  std::vector<Vec<3>> seeds;
  for (int i = 0; i < 60; ++i) seeds.push_back(points.in(-3, 3));
  for (const std::size_t cell : {0u, 17u, 59u}) {
    const auto zone = voronoi_zone<3>(seeds, cell);
    const auto contains = [&](const Vec<3>& x) {
      for (std::size_t s = 0; s < seeds.size(); ++s)
        if (s != cell && (x - seeds[s]).norm() <= (x - seeds[cell]).norm()) return false;
      return true;
    };
    expect_lower_bound(*zone, contains);
    expect_gradient(*zone);
    // Inside of convex cells the nearest plane is the distance.
    for (int i = 0; i < 200; ++i) {
      const Vec<3> x = seeds[cell] + 0.5 * points.in(-1, 1);
      if (!contains(x)) continue;
      double nearest = 1e300;
      for (std::size_t s = 0; s < seeds.size(); ++s)
        if (s != cell)
          nearest = std::min(
              nearest, (seeds[s] - seeds[cell]).normalized().dot((seeds[s] + seeds[cell]) / 2 - x));
      EXPECT_NEAR(zone->distance(x), -nearest, 1e-12);
    }
  }
  EXPECT_EQ(voronoi_zone<3>({Vec<3>::Zero()}, 0)->distance({1, 2, 3}),
            -std::numeric_limits<double>::infinity());
}

TEST(Zone, PlaneZonesAreExactToo) {
  const auto ball = ball_zone<2>({1, 0}, 2);
  const auto box = box_zone<2>({0, 0}, {2, 1});
  EXPECT_DOUBLE_EQ(ball->distance({1, 5}), 3);
  EXPECT_DOUBLE_EQ(box->distance({5, 5}), 5);
  EXPECT_DOUBLE_EQ(box->distance({0.75, 0.5}), -0.5);
  EXPECT_DOUBLE_EQ(voronoi_zone<2>({{0, 0}, {4, 0}}, 1)->distance({1, 7}), 1);
  ReferenceSurface<2> polygon = testing::polygon_surface(2, 200);
  const auto zone = surface_zone<2>(polygon);
  EXPECT_NEAR(zone->distance({3, 0}), 1, 1e-3);
  EXPECT_NEAR(zone->distance({0, -1}), -1, 1e-3);
}

TEST(Zone, SurfacesAreExactWhicheverWayTellsInside) {
  const double t = 0.3;
  const ReferenceSurface<3> ell = testing::l_surface(t);
  const auto contains = [&](const Vec<3>& x) {
    if (x.minCoeff() <= 0 || x.maxCoeff() >= 1) return false;
    return x[0] < t || x[2] < t;
  };
  for (const Inside inside : {Inside::normals, Inside::winding}) {
    const auto zone = surface_zone<3>(ell, inside);
    expect_exact(*zone, contains);
    expect_gradient(*zone);
    expect_in_box(*zone);
  }
}

TEST(Zone, ADoubledSurfaceHasTheZoneOfTheSingleOne) {
  const ReferenceSurface<3> once = testing::sphere_surface(2, 2);
  ReferenceSurface<3> twice = once;
  twice.facets.insert(twice.facets.end(), once.facets.begin(), once.facets.end());
  twice.facet_face.resize(twice.facets.size());
  const auto a = surface_zone<3>(once), b = surface_zone<3>(twice, Inside::winding);
  Points points;
  for (int i = 0; i < 500; ++i) {
    const Vec<3> x = points.in(-3, 3);
    EXPECT_NEAR(a->distance(x), b->distance(x), 1e-12);
  }
}

TEST(Zone, AcrossAHoleTheDistanceHasNoJump) {
  ReferenceSurface<3> open = testing::box_surface({2, 2, 2}, {4, 4, 4});
  const auto in_lid = [&](const std::array<std::int32_t, 3>& f, double width) {
    const Vec<3> c = (open.points[f[0]] + open.points[f[1]] + open.points[f[2]]) / 3;
    return c[2] > 1.999 && std::abs(c[0] - 1) < width && std::abs(c[1] - 1) < width;
  };
  const ReferenceSurface<3> closed = open;
  std::erase_if(open.facets, [&](const auto& f) { return in_lid(f, 0.5); });
  open.facet_face.resize(open.facets.size());
  ASSERT_LT(open.facets.size(), closed.facets.size());
  const auto zone = surface_zone<3>(open, Inside::winding), whole = surface_zone<3>(closed);

  // Up through the hole the sign changes once, near its plane, and the distance passes zero.
  double last = zone->distance({1.1, 0.9, 0.5});
  EXPECT_LT(last, 0);
  int changes = 0;
  for (double z = 0.5; z < 3.5; z += 0.01) {
    const ZoneDistance<3> at = zone->at({1.1, 0.9, z});
    EXPECT_LE(std::abs(at.distance - last), 0.04) << z;
    if ((at.distance < 0) != (last < 0)) {
      ++changes;
      EXPECT_NEAR(z, 2, 0.1);
      EXPECT_GT(at.normal[2], 0.9);
    }
    last = at.distance;
  }
  EXPECT_EQ(changes, 1);
  // Far from the hole nothing is lost at the walls.
  for (const Vec<3>& x : {Vec<3>(1, 1, 0.02), Vec<3>(-0.02, 1, 0.5), Vec<3>(1.98, 1, 0.25)})
    EXPECT_DOUBLE_EQ(zone->distance(x), whole->distance(x));
  // The ball that is promised to be on one side is on one side.
  Points points;
  for (int i = 0; i < 300; ++i) {
    const Vec<3> x = Vec<3>::Constant(1) + points.in(-1.5, 1.5);
    const double d = zone->distance(x);
    for (int k = 0; k < 20; ++k) {
      const Vec<3> y = x + 0.99 * std::abs(d) * points.direction();
      const double there = zone->distance(y);
      if (std::abs(there) > 1e-2) {
        EXPECT_EQ(there < 0, d < 0) << x.transpose();
      }
    }
  }
}

TEST(Zone, ADoubledOpenSurfaceEndsWithItsBox) {
  ReferenceSurface<3> open = testing::box_surface({2, 2, 2}, {2, 2, 2});
  std::erase_if(open.facets, [&](const auto& f) {
    return open.points[f[0]][2] + open.points[f[1]][2] + open.points[f[2]][2] > 5.99;
  });
  const auto once = surface_zone<3>(open, Inside::winding);
  const auto facets = open.facets;
  for (const auto& f : facets) open.facets.push_back({f[1], f[2], f[0]});
  open.facet_face.resize(open.facets.size());
  const auto twice = surface_zone<3>(open, Inside::winding);
  expect_in_box(*twice);
  Points points;
  for (int i = 0; i < 300; ++i) {
    const Vec<3> x = points.in(-1, 3);
    EXPECT_EQ(once->distance(x), twice->distance(x));
  }
}

TEST(Zone, UnweldedFacetsAreNoHoles) {
  const ReferenceSurface<3> box = testing::box_surface({2, 2, 2});
  ReferenceSurface<3> soup = box;
  soup.points.clear();
  for (auto& f : soup.facets)
    for (std::int32_t& v : f) {
      soup.points.push_back(box.points[v]);
      v = static_cast<std::int32_t>(soup.points.size()) - 1;
    }
  const auto a = surface_zone<3>(box), b = surface_zone<3>(soup, Inside::winding);
  Points points;
  for (int i = 0; i < 300; ++i) {
    const Vec<3> x = points.in(-1, 3);
    EXPECT_NEAR(a->distance(x), b->distance(x), 1e-12);
  }
}

TEST(Zone, NothingIsFarFromEverything) {
  const auto zone = surface_zone<3>({}, Inside::winding);
  EXPECT_EQ(zone->distance({1, 2, 3}), std::numeric_limits<double>::infinity());
}

TEST(Zone, MadeOfOthersItKeepsSignsAndBounds) {
  const Vec<3> c(0.5, 0, 0);
  const auto ball = ball_zone<3>(c, 1.5);
  const auto box = box_zone<3>({-2, -1, -1}, {1, 1, 1});
  const auto in_ball = [&](const Vec<3>& x) { return (x - c).norm() < 1.5; };
  const auto in_box = [](const Vec<3>& x) {
    return x[0] > -2 && x[0] < 1 && x.tail<2>().cwiseAbs().maxCoeff() < 1;
  };
  const auto both = intersection_zone<3>({ball, box}), any = union_zone<3>({ball, box}),
             rest = intersection_zone<3>({box, complement_zone<3>(ball)});
  expect_lower_bound(*both, [&](const Vec<3>& x) { return in_ball(x) && in_box(x); });
  expect_lower_bound(*any, [&](const Vec<3>& x) { return in_ball(x) || in_box(x); });
  expect_lower_bound(*rest, [&](const Vec<3>& x) { return in_box(x) && !in_ball(x); });
  for (const auto& zone : {both, any, rest}) {
    expect_gradient(*zone);
    expect_in_box(*zone);
  }
  EXPECT_EQ(both->box().lo, Vec<3>(-1, -1, -1));
  EXPECT_EQ(any->box().hi, Vec<3>(2, 1.5, 1.5));
}

}  // namespace
}  // namespace lamella
