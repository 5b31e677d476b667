#include "core/study/zone_entry.h"

#include <gtest/gtest.h>

namespace lamella {
namespace {

TEST(StudyZone, MakesTheZoneOfItsShape) {
  const std::vector<StudyZone> all = {{"ball", ZoneBall{{1, 0, 0}, 2}},
                                      {"box", ZoneBox{{0, 0, 0}, {1, 2, 3}}},
                                      {"pin", ZoneCylinder{{0, 0, 0}, {0, 0, 4}, 1}},
                                      {"low", ZoneHalfSpace{{0, 0, 2}, 1}}};
  EXPECT_DOUBLE_EQ(make_zone(all[0], all)->distance({1, 3, 0}), 1);
  EXPECT_DOUBLE_EQ(make_zone(all[1], all)->distance({0.5, 1, 1.25}), -0.5);
  EXPECT_DOUBLE_EQ(make_zone(all[2], all)->distance({0, 0, 6}), 2);
  EXPECT_DOUBLE_EQ(make_zone(all[3], all)->distance({7, 7, 1}), 0.5);
}

TEST(StudyZone, CellsOfOneSetDivideSpaceAndDoNotSeeOtherSets) {
  const std::vector<StudyZone> all = {{"ball", ZoneBall{{0.1, 0, 0}, 2}},
                                      {"a", ZoneCell{{0, 0, 0}, "s"}},
                                      {"b", ZoneCell{{2, 0, 0}, "s"}},
                                      {"c", ZoneCell{{0, 0, 0}, "t"}},
                                      {"d", ZoneCell{{0.5, 0, 0}, "t"}}};
  EXPECT_DOUBLE_EQ(make_zone(all[1], all)->distance({0.75, 3, 1}), -0.25);
  EXPECT_DOUBLE_EQ(make_zone(all[2], all)->distance({0.75, 3, 1}), 0.25);
  EXPECT_DOUBLE_EQ(make_zone(all[3], all)->distance({0.75, 3, 1}), 0.5);
}

}  // namespace
}  // namespace lamella
