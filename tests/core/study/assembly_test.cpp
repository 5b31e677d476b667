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

TEST(Assembly, ExactInterfacesKeepTheSizeAcross) {
  const double h = 0.05;
  Study study = halves(Interfaces::exact);
  study.bodies[0].interface_size = h;
  const Result<Outcome> outcome = mesh(study);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_EQ(outcome->bodies[0].interface_size, h);
  // How high the elements on the interface are above it.
  const SimplexMesh<3>& made = outcome->state->mesh;
  const Vec<3> n = Vec<3>(0.2, 0, 1).normalized();
  std::vector<double> heights;
  for (const auto& e : made.elements) {
    std::vector<double> above;
    for (const Vec<3>& p : made.corners(e)) above.push_back(std::abs(n.dot(p) - 1.1 * n[2]));
    if (std::count_if(above.begin(), above.end(), [](double d) { return d < 1e-9; }) == 3)
      heights.push_back(*std::max_element(above.begin(), above.end()));
  }
  ASSERT_GT(heights.size(), 10u);
  std::nth_element(heights.begin(), heights.begin() + heights.size() / 2, heights.end());
  EXPECT_LT(heights[heights.size() / 2], 1.5 * h);
  EXPECT_GT(heights[heights.size() / 2], 0.4 * h);
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

TEST(Assembly, WallsAreThoseThatAnInsertLeaves) {
  // 3 mm of plastic, 1 mm of it over the insert.
  Study study;
  study.zones = {{"plastic", ZoneBox{{0, 0, 0}, {12, 12, 3}}},
                 {"insert", ZoneBox{{2, 2, -1}, {10, 10, 2}}}};
  study.bodies = {{"plastic", 2}, {"insert", 2}};
  study.bodies[0].role = BodyRole::cavity;
  study.bodies[1].role = BodyRole::insert;
  study.domain = StudyDomain{ZoneBox{{-3, -3, -3}, {15, 15, 6}}};
  study.options.iterations = 4;
  const Result<Outcome> outcome = mesh(study);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  const MeshState& state = *outcome->state;
  int above = 0;
  for (NodeId n = 1; n < static_cast<NodeId>(state.mesh.points.size()); ++n) {
    const Vec<3>& x = state.mesh.points[n];
    if ((x - Vec<3>(6, 6, 2.5)).cwiseAbs().maxCoeff() > 2.5 || x[2] < 2.01 || x[2] > 2.99) continue;
    EXPECT_NEAR(state.thickness[n], 1, 0.05) << x.transpose();
    ++above;
  }
  EXPECT_GT(above, 3);
  for (const BodyOutcome& body : outcome->bodies) {
    EXPECT_LE(body.boundary_distance.largest(), body.chord_tolerance) << body.name;
    EXPECT_NEAR(body.mesh_volume / body.cad_volume, 1, 1e-4) << body.name;
    EXPECT_GE(body.layers.mean, body.name == "plastic" ? 2 : 0) << body.name;
  }
}

TEST(Assembly, WhereTwoBodiesTouchNothingIsMissedOfWhatIsAroundThem) {
  Study study;
  study.zones = {{"left", ZoneBox{{0, 0, 0}, {4, 6, 2}}}, {"right", ZoneBox{{4, 0, 0}, {8, 6, 2}}}};
  study.domain = StudyDomain{ZoneBox{{-2, -2, -2}, {10, 8, 4}}};
  study.options.iterations = 1;
  const Result<Outcome> outcome = mesh(study);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  ASSERT_EQ(outcome->bodies.size(), 3u);
  for (const BodyOutcome& body : outcome->bodies)
    EXPECT_LE(body.boundary_distance.largest(), body.chord_tolerance) << body.name;
}

TEST(Assembly, ABorderThatReachesTheWallAsksForNoSmallerSizesThere) {
  const Result<Outcome> outcome = mesh(halves(Interfaces::exact));
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  // Both halves are 0.7 to 1.3 mm thick and get two layers.
  for (std::size_t n = 1; n < outcome->state->metric.size(); ++n)
    EXPECT_GT(sizes<3>(outcome->state->metric[n])[0], 0.1)
        << outcome->state->mesh.points[n].transpose();
}

TEST(Assembly, CellsLeaveNothingBetweenThem) {
  Study study;
  const std::vector<Vec<3>> seeds{{1, 1, 1}, {3, 1.5, 1}, {1.5, 3, 1.2}, {2.8, 2.9, 2.8}};
  for (std::size_t s = 0; s < seeds.size(); ++s) {
    study.zones.push_back({"grain " + std::to_string(s + 1), ZoneCell{seeds[s], "grains"}});
    study.bodies.push_back({study.zones.back().name, 2});
  }
  study.domain = StudyDomain{ZoneBox{{0, 0, 0}, {4, 4, 4}}};
  study.options.iterations = 3;
  for (const Interfaces interfaces : {Interfaces::fuzzy, Interfaces::exact}) {
    study.options.interfaces = interfaces;
    const Result<Outcome> outcome = mesh(study);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    const SimplexMesh<3>& made = outcome->state->mesh;
    EXPECT_EQ(made.bodies.size(), seeds.size());
    ASSERT_EQ(outcome->bodies.size(), seeds.size());
    double volume = 0;
    for (const BodyOutcome& grain : outcome->bodies) {
      volume += grain.mesh_volume;
      EXPECT_NEAR(grain.mesh_volume / grain.cad_volume, 1, 0.01) << grain.name;
    }
    EXPECT_NEAR(volume, 64, 1e-6);
    if (interfaces == Interfaces::fuzzy) continue;
    // Each element is where its grain is, but for the tolerance.
    const double off = outcome->bodies[0].chord_tolerance;
    for (std::size_t e = 0; e < made.elements.size(); ++e) {
      const auto p = made.corners(made.elements[e]);
      const Vec<3> center = (p[0] + p[1] + p[2] + p[3]) / 4;
      const Vec<3>& own = seeds[made.element_body[e]];
      for (const Vec<3>& seed : seeds) {
        if (seed == own) continue;
        const double beyond = (center - own).squaredNorm() - (center - seed).squaredNorm();
        EXPECT_LE(beyond / (2 * (seed - own).norm()), off);
      }
    }
  }
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
