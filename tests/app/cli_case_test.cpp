#include "core/study/study_file.h"
#include "tests/support/cli_fixture.h"

namespace lamella {
namespace {

class CliCase : public Cli {
 protected:
  Study study_of(const std::string& file) {
    Result<Study> study = read_study(folder / file);
    EXPECT_TRUE(study.ok()) << study.error().message;
    return study.ok() ? *study : Study{};
  }
};

TEST_F(CliCase, EveryCaseIsAStudyOfZonesInADomain) {
  for (const std::string name :
       {"polycrystal", "inclusions", "fibers", "two-balls", "tilted-plate"}) {
    ASSERT_EQ(run("case " + name), 0) << err;
    const Study study = study_of(name + ".json");
    EXPECT_EQ(study.name, name);
    EXPECT_GE(study.zones.size(), 2u);
    EXPECT_TRUE(study.inputs.empty());
    ASSERT_TRUE(study.domain.has_value());
    ASSERT_EQ(study.bodies.size(), study.zones.size());
    for (std::size_t z = 0; z < study.zones.size(); ++z)
      EXPECT_EQ(study.bodies[z].name, study.zones[z].name);
  }
}

TEST_F(CliCase, OptionsAreFollowed) {
  ASSERT_TRUE(std::filesystem::create_directory(folder / "out"));
  ASSERT_EQ(run("case polycrystal --grains 10 --relaxations 2 -n 3 --seed 5 -o out"), 0) << err;
  Study study = study_of("out/polycrystal.json");
  ASSERT_EQ(study.zones.size(), 10u);
  EXPECT_EQ(study.zones[9].name, "grain 10");
  EXPECT_EQ(study.bodies[9].layers, 3);
  EXPECT_EQ(study.options.seed, 5u);
  EXPECT_TRUE(std::holds_alternative<ZoneCylinder>(study.domain->shape));
  ASSERT_EQ(run("case polycrystal --grains 3 --size 1,2,3 -o p.json"), 0) << err;
  EXPECT_EQ(std::get<ZoneBox>(study_of("p.json").domain->shape).high, Vec<3>(1, 2, 3));

  ASSERT_EQ(run("case inclusions --count 7 --radius 0.5,0.75 -o i.json"), 0) << err;
  study = study_of("i.json");
  ASSERT_EQ(study.zones.size(), 7u);
  for (const StudyZone& zone : study.zones) {
    const double radius = std::get<ZoneBall>(zone.shape).radius;
    EXPECT_TRUE(radius >= 0.5 && radius <= 0.75);
  }
  ASSERT_EQ(run("case fibers --count 5 --orientation 1,0,0 --length 2 --radius 0.1 -o f.json"), 0)
      << err;
  study = study_of("f.json");
  ASSERT_EQ(study.zones.size(), 5u);
  for (const StudyZone& zone : study.zones) {
    const auto& fiber = std::get<ZoneCylinder>(zone.shape);
    EXPECT_NEAR(std::abs(fiber.to[0] - fiber.from[0]), 2, 1e-9);
    EXPECT_EQ(fiber.radius, 0.1);
  }
  ASSERT_EQ(run("case tilted-plate --angle 0 -o t.json"), 0) << err;
  EXPECT_EQ(std::get<ZoneHalfSpace>(study_of("t.json").zones[1].shape).normal, Vec<3>(1, 0, 0));
}

TEST_F(CliCase, TheSeedAloneDecides) {
  ASSERT_EQ(run("case fibers --seed 3 -o a.json"), 0);
  ASSERT_EQ(run("case fibers --seed 3 -o b.json"), 0);
  ASSERT_EQ(run("case fibers --seed 4 -o c.json"), 0);
  EXPECT_EQ(study_of("a.json").zones, study_of("b.json").zones);
  EXPECT_NE(study_of("a.json").zones, study_of("c.json").zones);
}

TEST_F(CliCase, WhatCannotBePackedIsStatus3AndWritesNothing) {
  EXPECT_EQ(run("case inclusions --fraction 0.8"), 3);
  EXPECT_NE(err.find("80 %"), std::string::npos) << err;
  EXPECT_EQ(run("case fibers --length 40"), 3);
  EXPECT_EQ(run("case fibers --orientation 0.5,0.1,0.1"), 3);
  EXPECT_EQ(folder.names(), Names{});
}

}  // namespace
}  // namespace lamella
