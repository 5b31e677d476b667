#include "core/geometry/self_intersection.h"

#include <gtest/gtest.h>

#include "core/geometry/soup.h"
#include "tests/support/soups.h"

namespace lamella {
namespace {

TEST(SelfIntersection, FindsCrossingAndFoldedFacets) {
  const auto pairs = [](const test::Soup& soup) {
    return find_self_intersections(surface_from_soup(soup).value()).pairs;
  };
  EXPECT_EQ(pairs(test::unit_box()), 0);
  // Apart, inside, touching along a face: nothing crosses.
  EXPECT_EQ(pairs(test::both(test::unit_box(), test::box_soup({2, 0, 0}, {3, 1, 1}))), 0);
  EXPECT_EQ(
      pairs(test::both(test::unit_box(), test::turned(test::box_soup({.2, .2, .2}, {.8, .8, .8})))),
      0);
  EXPECT_EQ(pairs(test::both(test::unit_box(), test::box_soup({1, .2, .2}, {2, .8, .8}))), 0);
  // A bar through the box.
  EXPECT_GE(pairs(test::both(test::unit_box(), test::box_soup({-1, .2, .3}, {2, .8, .7}))), 16);

  ReferenceSurface<3> folded;
  folded.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.9, 0}};
  folded.facets = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_EQ(find_self_intersections(folded).pairs, 1);
}

TEST(SelfIntersection, StopsWhenCancelled) {
  const ReferenceSurface<3> s =
      surface_from_soup(test::both(test::unit_box(), test::box_soup({-1, .2, .3}, {2, .8, .7})))
          .value();
  ASSERT_GT(find_self_intersections(s).pairs, 0);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(find_self_intersections(s, Progress({}, stop.get_token())).pairs, 0);
}

}  // namespace
}  // namespace lamella
