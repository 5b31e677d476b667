#include "core/study/assembly.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/mesh/validate.h"
#include "core/study/run.h"
#include "tests/support/plate_part.h"

namespace lamella {
namespace {

/// A block of two halves, split at z = 0 by a tilted plane.
Study halves(Interfaces interfaces) {
  Study study;
  study.zones = {{"low", ZoneHalfSpace{{0.2, 0, 1}, 1.1}}};
  study.domain = StudyDomain{ZoneBox{{0, 0, 0}, {2, 2, 2}}};
  study.options.interfaces = interfaces;
  study.options.iterations = 4;
  study.bodies = {{"low", 2}, {"background", 2}};
  return study;
}
// Of the block of 8 mm^3 that is below z = 1.1 - x / 5.
constexpr double kLow = 4 * (1.1 - 0.2);

Result<Outcome> mesh(const Study& study, const std::vector<Part>& parts = {}) {
  return run(study, parts, {std::shared_ptr<const VolumeMesher>(topological_mesher())});
}

TEST(Assembly, FuzzyInterfacesAreWithinThinElements) {
  const Result<Outcome> outcome = mesh(halves(Interfaces::fuzzy));
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  const MeshState& state = *outcome->state;
  EXPECT_TRUE(validate<3>(state.mesh).ok());
  EXPECT_EQ(state.mesh.bodies, (std::vector<std::string>{"low", "background"}));
  ASSERT_TRUE(state.filling);
  EXPECT_GT(outcome->records.back().mixed, 0u);
  EXPECT_LT(outcome->records.back().interface_error, outcome->records[0].interface_error);
  EXPECT_NEAR(outcome->bodies[0].mesh_volume, kLow, 1e-5);
  EXPECT_NEAR(outcome->bodies[1].mesh_volume, 8 - kLow, 1e-5);
  // The error is bounded by what mixed elements fill: |cut| times their thickness.
  const double cut = 4 * std::sqrt(1.04), h = outcome->bodies[0].interface_size;
  EXPECT_LT(outcome->bodies[0].interface_error, std::sqrt(cut * 2 * h / 4 / kLow));
  EXPECT_GE(outcome->bodies[0].layers.mean, 2);
}

TEST(Assembly, ExactInterfacesAreFacesOfTheMesh) {
  const Result<Outcome> outcome = mesh(halves(Interfaces::exact));
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  const SimplexMesh<3>& made = outcome->state->mesh;
  EXPECT_TRUE(validate<3>(made).ok());
  EXPECT_FALSE(outcome->state->filling);
  EXPECT_EQ(outcome->records.back().mixed, 0u);
  EXPECT_NEAR(outcome->bodies[0].mesh_volume, kLow, 1e-6);
  EXPECT_NEAR(outcome->bodies[1].mesh_volume, 8 - kLow, 1e-6);
  EXPECT_EQ(std::count(made.groups.begin(), made.groups.end(), "low|background"), 1);
  double area = 0;
  for (std::size_t f = 0; f < made.facets.size(); ++f)
    if (made.groups[made.facet_group[f]] == "low|background")
      area += 0.5 * facet_normal<3>(made.corners(made.facets[f])).norm();
  EXPECT_NEAR(area, 4 * std::sqrt(1.04), 1e-6);
}

TEST(Assembly, ADroppedBodyLeavesTheOtherWithItsWalls) {
  Study study = halves(Interfaces::exact);
  study.dropped = {"background"};
  const Result<Outcome> outcome = mesh(study);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  const SimplexMesh<3>& made = outcome->state->mesh;
  EXPECT_TRUE(validate<3>(made).ok());
  EXPECT_EQ(made.bodies, std::vector<std::string>{"low"});
  ASSERT_EQ(outcome->bodies.size(), 1u);
  EXPECT_NEAR(outcome->bodies[0].mesh_volume, kLow, 1e-6);
  EXPECT_EQ(std::count(made.groups.begin(), made.groups.end(), "low walls"), 1);
  study.dropped = {"nobody"};
  EXPECT_EQ(mesh(study).error().code, Code::usage);
  study.dropped = {"background"};
  study.options.interfaces = Interfaces::fuzzy;
  EXPECT_EQ(mesh(study).error().code, Code::usage);
}

TEST(Assembly, APartInABlockKeepsVolumeAndName) {
  Study study;
  study.domain = StudyDomain{DomainMargin{0.2}};
  study.options.iterations = 3;
  study.bodies = {{"plate", 2}};
  const Result<Outcome> outcome = mesh(study, {plate("plate")});
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_TRUE(validate<3>(outcome->state->mesh).ok());
  EXPECT_EQ(outcome->state->mesh.bodies, (std::vector<std::string>{"plate", "background"}));
  EXPECT_NEAR(outcome->bodies[0].mesh_volume, 64, 64e-6);
  EXPECT_GE(outcome->bodies[0].layers.mean, 2);
}

TEST(Assembly, TellsOverlapsAndGivesThemToTheFirst) {
  Study study;
  study.zones = {{"a", ZoneBall{{1, 1, 1}, 0.5}}, {"b", ZoneBall{{1.6, 1, 1}, 0.4}}};
  study.domain = StudyDomain{ZoneBox{{0, 0, 0}, {2.4, 2, 2}}};
  study.options.interfaces = Interfaces::fuzzy;
  study.options.iterations = 1;
  const Result<Outcome> outcome = mesh(study);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  const auto& notes = outcome->bodies[1].notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.find("Overlaps \"a\"") != std::string::npos;
  }));
  EXPECT_LT(outcome->bodies[1].cad_volume, 4 * std::numbers::pi / 3 * 0.064);
}

TEST(Assembly, AnInsertKeepsWhatItSharesWithAMold) {
  Study study;
  study.zones = {{"a", ZoneBall{{1, 1, 1}, 0.5}}, {"b", ZoneBall{{1.6, 1, 1}, 0.4}}};
  study.domain = StudyDomain{ZoneBox{{0, 0, 0}, {2.4, 2, 2}}};
  study.bodies = {{"a"}, {"b"}};
  study.bodies[0].role = BodyRole::mold;
  study.bodies[1].role = BodyRole::insert;
  study.options.interfaces = Interfaces::fuzzy;
  study.options.iterations = 1;
  const Result<Outcome> outcome = mesh(study);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_EQ(outcome->bodies[0].name, "b");
  EXPECT_NEAR(outcome->bodies[0].cad_volume, 4 * std::numbers::pi / 3 * 0.064, 1e-3);
  EXPECT_LT(outcome->bodies[1].cad_volume, 4 * std::numbers::pi / 3 * 0.125);
}

TEST(Assembly, RefusesWhatCannotBe) {
  Study study = halves(Interfaces::exact);
  study.domain = StudyDomain{DomainBody{"nobody"}};
  EXPECT_EQ(mesh(study).error().code, Code::usage);
  study = halves(Interfaces::exact);
  study.options.detector = Detector::neighborhood;
  EXPECT_EQ(mesh(study).error().code, Code::usage);
  study = halves(Interfaces::exact);
  study.bodies[0].interface_size = -1;
  EXPECT_EQ(mesh(study).error().code, Code::usage);
  study = halves(Interfaces::exact);
  EXPECT_EQ(mesh(study, {plate("low")}).error().code, Code::usage);
}

TEST(Assembly, DoesNotDependOnThreads) {
  Study study = halves(Interfaces::exact);
  study.options.iterations = 2;
  study.options.threads = 1;
  const Result<Outcome> one = mesh(study);
  study.options.threads = 2;
  const Result<Outcome> two = mesh(study);
  ASSERT_TRUE(one.ok() && two.ok());
  EXPECT_EQ(one->state->mesh.points, two->state->mesh.points);
  EXPECT_EQ(one->state->mesh.elements, two->state->mesh.elements);
}

}  // namespace
}  // namespace lamella
