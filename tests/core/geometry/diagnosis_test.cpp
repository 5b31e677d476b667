#include "core/geometry/diagnosis.h"

#include <gtest/gtest.h>

#include "tests/support/soups.h"

namespace lamella {
namespace {

using test::both;
using test::box_soup;
using test::turned;
using test::unit_box;

Diagnosis of(const test::Soup& soup) { return diagnose(merge_exact(soup)); }

TEST(Diagnosis, FindsNothingWrongWithABox) {
  const Diagnosis d = of(box_soup({0, 0, 0}, {4, 2, 1}));
  EXPECT_TRUE(d.sound());
  EXPECT_EQ(d.facets, 12);
  EXPECT_EQ(d.vertices, 8);
  EXPECT_DOUBLE_EQ(d.area, 28);
  EXPECT_NEAR(d.volume, 8, 1e-12);
  EXPECT_EQ(d.shells.size(), 1);
  EXPECT_TRUE(d.shells[0].closed);
  EXPECT_NEAR(d.thinnest, 1, 1e-9);
  EXPECT_EQ(d.thin_walls.count, 0);
}

TEST(Diagnosis, CountsEveryKindAndTellsWhere) {
  test::Soup soup = unit_box();
  std::swap(soup[11][0], soup[11][1]);
  EXPECT_EQ(of(soup).wrong_windings.count, 3);

  soup = unit_box();
  soup.erase(soup.begin());  // the facet (0,0,0) (0,1,0) (1,1,0)
  const Diagnosis open = of(soup);
  ASSERT_EQ(open.open_edges.count, 3);
  for (const Vec<3>& x : open.open_edges.places) EXPECT_DOUBLE_EQ(x[2], 0);
  EXPECT_FALSE(open.shells[0].closed);

  soup = unit_box();
  soup.push_back(soup[4]);
  soup.push_back({soup[0][0], soup[0][0], soup[0][1]});
  const Diagnosis twice = of(soup);
  EXPECT_EQ(twice.duplicate_facets.count, 1);
  EXPECT_EQ(twice.degenerate_facets.count, 1);

  const Diagnosis edge = of(both(unit_box(), box_soup({1, 1, 0}, {2, 2, 1})));
  ASSERT_EQ(edge.non_manifold_edges.count, 1);
  EXPECT_LT((edge.non_manifold_edges.places[0] - Vec<3>(1, 1, .5)).norm(), 1e-12);

  const Diagnosis crossing = of(both(unit_box(), box_soup({-1, .2, .3}, {2, .8, .7})));
  EXPECT_GT(crossing.self_intersections.count, 0);
  EXPECT_EQ(crossing.shells.size(), 2);
}

TEST(Diagnosis, TellsVoidsFromBodies) {
  const test::Soup soup =
      both(both(box_soup({0, 0, 0}, {3, 3, 3}), box_soup({10, 0, 0}, {11, 1, 1})),
           both(turned(box_soup({.5, .5, .5}, {2.5, 2.5, 2.5})), box_soup({1, 1, 1}, {2, 2, 2})));
  const auto bodies = diagnose_bodies(merge_exact(soup));
  ASSERT_EQ(bodies.size(), 3);
  EXPECT_EQ(bodies[0].shells.size(), 2);
  EXPECT_NEAR(bodies[0].volume, 27 - 8, 1e-12);
  EXPECT_NEAR(bodies[1].volume + bodies[2].volume, 2, 1e-12);
  EXPECT_EQ(bodies[0].shells[1].depth, 1);
  EXPECT_EQ(bodies[0].shells[1].around, 0);
}

TEST(Diagnosis, ListsThinWallsAndBoundsTheList) {
  const test::Soup plate = box_soup({0, 0, 0}, {10, 10, .004});
  const Diagnosis d = of(plate);
  EXPECT_NEAR(d.thinnest, .004, 1e-9);
  EXPECT_EQ(d.thin_walls.count, 4);
  DiagnoseParams params;
  params.most_places = 1;
  EXPECT_EQ(diagnose(merge_exact(plate), params).thin_walls.places.size(), 1);
  EXPECT_EQ(diagnose(merge_exact(plate), params).thin_walls.count, 4);
}

TEST(Diagnosis, GuessesUnits) {
  EXPECT_EQ(guess_unit(120), "mm");
  EXPECT_EQ(guess_unit(5.8), "inch");
  EXPECT_EQ(guess_unit(.12), "m");
}

}  // namespace
}  // namespace lamella
