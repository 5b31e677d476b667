#include "core/geometry/improve_triangles.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/geometry/self_intersection.h"
#include "core/geometry/soup.h"
#include "tests/support/soups.h"

namespace lamella {
namespace {

double worst_aspect(const ReferenceSurface<3>& s) {
  double worst = 0;
  for (const auto& f : s.facets) {
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      longest = std::max(longest, (s.points[f[k]] - s.points[f[(k + 1) % 3]]).norm());
    }
    const Vec<3> n = facet_normal<3>({s.points[f[0]], s.points[f[1]], s.points[f[2]]});
    worst = std::max(worst, longest * longest / n.norm());
  }
  return worst;
}

double area(const ReferenceSurface<3>& s) {
  double sum = 0;
  for (const auto& f : s.facets) {
    sum += facet_normal<3>({s.points[f[0]], s.points[f[1]], s.points[f[2]]}).norm() / 2;
  }
  return sum;
}

/// Length of the feature edges.
double feature_length(const ReferenceSurface<3>& s) {
  double sum = 0;
  for (const auto& e : s.feature_edges) sum += (s.points[e[0]] - s.points[e[1]]).norm();
  return sum;
}

ReferenceSurface<3> closed(const test::Soup& soup) {
  auto surface = surface_from_soup(soup);
  EXPECT_TRUE(surface.ok());
  return surface.ok() ? *surface : ReferenceSurface<3>{};
}

/// A bar along z whose section is a regular polygon of n sides.
test::Soup bar(int n, double length) {
  test::Soup soup;
  const auto ring = [&](int i, double z) {
    const double a = 2 * std::numbers::pi * (i % n) / n;
    return Vec<3>{std::cos(a), std::sin(a), z};
  };
  for (int i = 0; i < n; ++i) {
    soup.push_back({ring(i, 0), ring(i + 1, 0), ring(i + 1, length)});
    soup.push_back({ring(i, 0), ring(i + 1, length), ring(i, length)});
    soup.push_back({Vec<3>{0, 0, length}, ring(i, length), ring(i + 1, length)});
    soup.push_back({Vec<3>{0, 0, 0}, ring(i + 1, 0), ring(i, 0)});
  }
  return soup;
}

TEST(ImproveTriangles, SplitsNeedlesAndMovesNothing) {
  for (const test::Soup& soup : {test::box_soup({0, 0, 0}, {400, 3, 1}), bar(24, 100)}) {
    const ReferenceSurface<3> before = closed(soup);
    ReferenceSurface<3> s = before;
    ImproveParams params;
    params.tolerance = 1e-9;  // rounding of the points put on the edges
    improve_triangles(s, params);
    EXPECT_GT(worst_aspect(before), 50);
    EXPECT_LE(worst_aspect(s), 15 * (1 + 1e-9));
    EXPECT_TRUE(check_closed(s).ok());
    EXPECT_EQ(find_self_intersections(s).pairs, 0);
    EXPECT_NEAR(enclosed_measure(s), enclosed_measure(before), 1e-9 * enclosed_measure(before));
    EXPECT_NEAR(area(s), area(before), 1e-9 * area(before));
    EXPECT_NEAR(feature_length(s), feature_length(before), 1e-9 * feature_length(before));
    EXPECT_EQ(s.corners, before.corners);
    EXPECT_EQ(s.facet_face.size(), s.facets.size());
  }
}

TEST(ImproveTriangles, LeavesGoodTrianglesAlone) {
  const ReferenceSurface<3> before = closed(test::unit_box());
  ReferenceSurface<3> s = before;
  improve_triangles(s, {});
  EXPECT_EQ(s.facets, before.facets);
  EXPECT_EQ(s.feature_edges, before.feature_edges);
}

TEST(ImproveTriangles, LetsSliversVanish) {
  // One edge of the box is cut on one side only, and a flat triangle fills the gap.
  test::Soup soup = test::unit_box();
  const auto edge = std::pair{soup[0][0], soup[0][1]};
  const Vec<3> middle = 0.5 * (edge.first + edge.second);
  const Vec<3> tip = soup[0][2];
  soup[0] = {edge.first, middle, tip};
  soup.push_back({middle, edge.second, tip});
  soup.push_back({edge.first, edge.second, middle});
  const ReferenceSurface<3> before = closed(soup);
  ASSERT_GT(worst_aspect(before), 1e9);
  ReferenceSurface<3> s = before;
  ImproveParams params;
  params.tolerance = 1e-6;
  improve_triangles(s, params);
  EXPECT_LT(worst_aspect(s), 15);
  EXPECT_TRUE(check_closed(s).ok());
  EXPECT_NEAR(enclosed_measure(s), 1, 1e-12);
  find_features(s, 0.6);  // the sliver had no normal
  EXPECT_NEAR(feature_length(s), 12, 1e-12);
}

TEST(ImproveTriangles, StopsAtItsLimits) {
  const ReferenceSurface<3> before = closed(test::box_soup({0, 0, 0}, {1000, 1, 0.01}));
  ReferenceSurface<3> s = before;
  ImproveParams params;
  params.shortest_edge = 500;
  improve_triangles(s, params);
  EXPECT_LT(s.facets.size(), 100);
  params.shortest_edge = 0;
  s = before;
  improve_triangles(s, params);
  EXPECT_LE(s.facets.size(), 4 * 12 + 2000);
  EXPECT_TRUE(check_closed(s).ok());
}

TEST(ImproveTriangles, StopsSoundWhenCancelled) {
  const ReferenceSurface<3> before = closed(test::box_soup({0, 0, 0}, {400, 3, 1}));
  ReferenceSurface<3> s = before;
  std::stop_source stop;
  stop.request_stop();
  improve_triangles(s, {}, Progress({}, stop.get_token()));
  EXPECT_EQ(s.facets, before.facets);
  EXPECT_EQ(s.feature_edges, before.feature_edges);
}

}  // namespace
}  // namespace lamella
