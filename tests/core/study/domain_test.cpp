#include "core/study/domain.h"

#include <gtest/gtest.h>

#include "core/study/zone_surface.h"

namespace lamella {
namespace {

Part box_part(const std::string& name, const Vec<3>& low, const Vec<3>& high) {
  const StudyZone box{name, ZoneBox{low, high}};
  Part part;
  part.name = name;
  part.surface = *zone_surface(box, {box}, box, 0.1);
  return part;
}

TEST(StudyDomain, BackgroundHasSettingsUnlessABodyIsTheDomain) {
  const std::vector<Part> parts{box_part("a", {0, 0, 0}, {1, 1, 1})};
  Study study;
  study.zones = {{"z", ZoneBall{{0, 0, 0}, 1}}};
  study.bodies = {{"gone"}, {"z", 7}};
  arrange_bodies(study, parts);
  ASSERT_EQ(study.bodies.size(), 2u);
  EXPECT_EQ(study.bodies[0].name, "a");
  EXPECT_EQ(study.bodies[1].layers, 7);
  study.domain = StudyDomain{DomainMargin{}};
  arrange_bodies(study, parts);
  ASSERT_EQ(study.bodies.size(), 3u);
  EXPECT_EQ(study.bodies[2].layers, 2);
  study.bodies[2].layers = 5;
  arrange_bodies(study, parts);
  EXPECT_EQ(study.bodies[2].layers, 5) << "what is asked stays";
  study.domain = StudyDomain{DomainBody{"a"}};
  arrange_bodies(study, parts);
  EXPECT_EQ(study.bodies.size(), 2u);
}

TEST(StudyDomain, HullHoldsPartsAndZonesThatEnd) {
  const std::vector<Part> parts{box_part("a", {0, 0, 0}, {1, 1, 1})};
  Study study;
  study.zones = {{"ball", ZoneBall{{3, 0, 0}, 1}}, {"half", ZoneHalfSpace{{0, 0, 1}, 0}}};
  EXPECT_FALSE(domain_hull(study, parts)) << "there is no domain";
  study.domain = StudyDomain{DomainMargin{0.5}};
  const Result<StudyZone> hull = domain_hull(study, parts);
  ASSERT_TRUE(hull);
  const auto box = std::get<ZoneBox>(hull->shape);
  const double grow = 0.5 * Vec<3>(4, 2, 2).norm();
  EXPECT_NEAR((box.low - Vec<3>(-grow, -1 - grow, -1 - grow)).norm(), 0, 1e-12);
  EXPECT_NEAR((box.high - Vec<3>(4 + grow, 1 + grow, 1 + grow)).norm(), 0, 1e-12);
  study.domain = StudyDomain{DomainBody{"a"}};
  EXPECT_EQ(std::get<ZoneBox>(domain_hull(study, parts)->shape).high, Vec<3>(1, 1, 1));
  study.domain = StudyDomain{DomainBody{"b"}};
  EXPECT_FALSE(domain_hull(study, parts));
}

TEST(StudyDomain, InsertsComeBeforeCavitiesAndTheseBeforeTheMold) {
  const std::vector<Part> parts{box_part("mold", {0, 0, 0}, {1, 1, 1}),
                                box_part("part", {0, 0, 0}, {1, 1, 1}),
                                box_part("plain", {0, 0, 0}, {1, 1, 1})};
  Study study;
  study.zones = {{"pin", ZoneBall{{0, 0, 0}, 1}}, {"runner", ZoneBall{{0, 0, 0}, 1}}};
  const auto order = [&] {
    std::vector<std::string> names;
    for (const RankedBody& body : by_rank(study, parts))
      names.push_back(body.part ? body.part->name : body.zone->name);
    return names;
  };
  EXPECT_EQ(order(), (std::vector<std::string>{"mold", "part", "plain", "pin", "runner"}));
  arrange_bodies(study, parts);
  study.bodies[0].role = BodyRole::mold;
  study.bodies[1].role = BodyRole::cavity;
  study.bodies[3].role = BodyRole::insert;
  study.bodies[4].role = BodyRole::channel;
  EXPECT_EQ(order(), (std::vector<std::string>{"pin", "part", "plain", "runner", "mold"}));
}

TEST(StudyDomain, OverlapsAreOfPartsAndZonesButNotOfTheDomain) {
  const std::vector<Part> parts{box_part("a", {0, 0, 0}, {2, 2, 2}),
                                box_part("mold", {-5, -5, -5}, {5, 5, 5})};
  Study study;
  study.zones = {{"half", ZoneHalfSpace{{0, 0, 1}, 0.5}}};
  study.domain = StudyDomain{DomainBody{"mold"}};
  const Result<StudyOverlaps> found = study_overlaps(study, parts);
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found->report.overlaps.size(), 1u);
  const Overlap& one = found->report.overlaps[0];
  EXPECT_EQ(found->names[static_cast<std::size_t>(one.first)], "a");
  EXPECT_EQ(found->names[static_cast<std::size_t>(one.second)], "half");
  EXPECT_NEAR(one.volume, 2, 0.02);  // 2 x 2 x 0.5
  study.domain.reset();
  EXPECT_FALSE(study_overlaps(study, parts)) << "the half space has no end";
}

}  // namespace
}  // namespace lamella
