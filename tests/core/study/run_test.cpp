#include "core/study/run.h"

#include <gtest/gtest.h>

#include "core/geometry/soup.h"
#include "core/mesh/sample_meshes.h"
#include "core/mesh/validate.h"
#include "core/study/measure.h"
#include "core/study/request.h"
#include "tests/support/plate_part.h"
#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

class GivesUp : public VolumeMesher {
 public:
  std::string name() const override { return "the one that gives up"; }
  Result<SimplexMesh<3>> generate(const ReferenceSurface<3>&, const Progress&) const override {
    return Error{Code::failed, "It was too hard.", ""};
  }
};

using Meshers = std::vector<std::shared_ptr<const VolumeMesher>>;
Meshers real() { return {std::shared_ptr<const VolumeMesher>(topological_mesher())}; }

TEST(Run, APlateGetsItsLayersAndKeepsItsVolume) {
  Study study;
  study.bodies = {{"plate", 3}};
  std::vector<int> told;
  const Result<Outcome> outcome =
      run(study, {plate("plate")}, real(), {}, [&](const IterationRecord& r, const auto& state) {
        told.push_back(r.iteration);
        EXPECT_EQ(state->mesh.element_count(), r.elements);
      });
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_TRUE(outcome->converged);
  EXPECT_FALSE(outcome->cancelled);
  EXPECT_TRUE(validate<3>(outcome->state->mesh).ok());
  const BodyOutcome& body = outcome->bodies.at(0);
  EXPECT_NEAR(body.mesh_volume, 64, 1e-9);
  EXPECT_LE(body.boundary_distance.largest(), 1e-9);
  EXPECT_GE(body.layers.mean, 3);
  EXPECT_GE(body.layers.p5, 0.8 * 3);
  EXPECT_EQ(outcome->state->mesh.groups, std::vector<std::string>{"walls"});
  EXPECT_EQ(told.size(), outcome->records.size());
  EXPECT_EQ(told.front(), 0);
}

TEST(Run, DetailsInAWallHaveGoodElementsToo) {
  // A groove as wide as a third of the wall, which is 20 times as long as thick.
  Part part;
  part.name = "grooved";
  part.surface = testing::cell_surface({{{0, 9.3, 9.6, 20}, {0, 12}, {0, 0.85, 1}}},
                                       [](int i, int, int k) { return i != 1 || k == 0; });
  find_features(part.surface, 0.5);
  part.cad_volume = 20 * 12 - 0.3 * 12 * 0.15;
  Study study;
  study.bodies = {{"grooved", 4}};
  const Result<Outcome> outcome = run(study, {part}, real());
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_GE(outcome->records.back().quality_min, 0.2);
  EXPECT_NEAR(outcome->bodies.at(0).mesh_volume, part.cad_volume, 1e-9);
}

TEST(Run, TheNeighborhoodDetectorRefinesAcrossThePlate) {
  Study study;
  study.bodies = {{"plate", 3}};
  study.options.detector = Detector::neighborhood;
  study.options.iterations = 2;
  const Result<Outcome> outcome = run(study, {plate("plate")}, real());
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_TRUE(validate<3>(outcome->state->mesh).ok());
  EXPECT_NEAR(outcome->bodies.at(0).mesh_volume, 64, 1e-9);
  EXPECT_GE(outcome->bodies.at(0).layers.p5, 2);
  // Another mesh than the default one: the setting is heard.
  study.options.detector = Detector::geometric;
  const Result<Outcome> other = run(study, {plate("plate")}, real());
  ASSERT_TRUE(other.ok());
  EXPECT_NE(outcome->records.back().nodes, other->records.back().nodes);
}

TEST(Run, AProgressiveRunAsksForMoreLayersEachTime) {
  Study study;
  study.bodies = {{"plate", 6}};
  study.options.iterations = 6;
  const Result<Outcome> at_once = run(study, {plate("plate")}, real());
  study.options.progressive = true;
  const Result<Outcome> outcome = run(study, {plate("plate")}, real());
  ASSERT_TRUE(outcome.ok() && at_once.ok());
  const std::vector<IterationRecord>& records = outcome->records;
  ASSERT_GE(records.size(), 4u);
  EXPECT_LT(records[1].layers.mean, 4);
  EXPECT_GT(records[3].layers.mean, records[1].layers.mean);
  EXPECT_GE(outcome->bodies[0].layers.mean, 6) << "n is reached in the end";
  EXPECT_LT(records[1].nodes, at_once->records[1].nodes);
}

TEST(Run, GoesOnWhenAskedNotToEndByItself) {
  Study study;
  study.bodies = {{"plate", 2}};
  study.options.iterations = 5;
  const Result<Outcome> by_itself = run(study, {plate("plate")}, real());
  study.options.until_settled = false;
  const Result<Outcome> all = run(study, {plate("plate")}, real());
  ASSERT_TRUE(by_itself.ok() && all.ok());
  const std::size_t made = by_itself->records.size();
  ASSERT_LT(made, 6u);
  ASSERT_EQ(all->records.size(), 6u);
  for (std::size_t i = 0; i < made; ++i)
    EXPECT_EQ(all->records[i].nodes, by_itself->records[i].nodes);
}

TEST(Run, PlacesBelowNAreListedAndNCountedAsTheThesisDoes) {
  Study study;
  study.bodies = {{"plate", 4}};
  study.options.iterations = 1;
  const Result<Outcome> outcome = run(study, {plate("plate")}, real());
  ASSERT_TRUE(outcome.ok());
  const BodyOutcome& body = outcome->bodies[0];
  double area = 0;
  for (const PlaceBelow& place : body.below) {
    EXPECT_LT(place.layers, 4);
    area += place.area;
  }
  // Both sides of the plate, 8 x 8.
  EXPECT_NEAR(area, (1 - body.layers.share_reached) * 2 * 64, 0.02 * 2 * 64);
  EXPECT_EQ(outcome->state->below.size(), body.below.size());
  EXPECT_GT(body.records.back().layers_by_nodes, 1);
}

Study with_gate(const SizingShape& shape, double size, const std::string& body = "") {
  Study study;
  study.bodies = {{"plate", 2}};
  SizeCorrection c;
  c.size = size;
  study.sizing = {{"gate", body, shape, c}};
  return study;
}

TEST(Run, AGateIsRefinedAndTheThicknessStays) {
  const Vec<3> gate(4, 4, 1);
  Study study = with_gate(SphereShape{gate, 0.8}, 0.15);
  study.options.iterations = 2;
  const Result<Outcome> outcome = run(study, {plate("plate")}, real());
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  const MeshState& state = *outcome->state;
  const NaturalDetector detector(plate("plate").surface);
  const NaturalParams natural = natural_params(study, plate("plate"));
  double sum = 0;
  int edges = 0;
  for (const auto& e : state.mesh.elements) {
    const auto p = state.mesh.corners(e);
    if ((0.25 * (p[0] + p[1] + p[2] + p[3]) - gate).norm() > 0.7) continue;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j, ++edges) sum += (p[i] - p[j]).norm();
  }
  ASSERT_GT(edges, 0);
  EXPECT_NEAR(sum / edges, 0.15, 0.03);
  for (std::size_t n = 1; n < state.mesh.points.size(); ++n) {
    const Vec<3>& x = state.mesh.points[n];
    if ((x - gate).norm() < 0.79) {
      EXPECT_NEAR(sizes<3>(state.metric[n])[2], 0.15, 1e-9);
    }
    EXPECT_EQ(state.thickness[n], detector.at(x, natural).thickness);
  }
}

TEST(Run, ACoarserZoneNeedsNotTheLayers) {
  Study study;
  study.bodies = {{"plate", 8}};
  study.options.iterations = 4;
  AnalyticZone zone;
  zone.sizes = {1, 1, 0.5};
  zone.replace = true;
  study.sizing = {{"zone", "plate", WholeBody{}, zone}};
  const Result<Outcome> outcome = run(study, {plate("plate")}, real());
  ASSERT_TRUE(outcome.ok());
  EXPECT_TRUE(outcome->converged);
  EXPECT_NEAR(outcome->bodies[0].layers.mean, 2, 0.6);
}

TEST(Run, TheNextMesherIsAskedAndTheNotesSaySo) {
  Meshers meshers = real();
  meshers.insert(meshers.begin(), std::make_shared<GivesUp>());
  Study study;
  study.bodies = {{"plate", 1}};
  study.options.iterations = 1;
  const Result<Outcome> outcome = run(study, {plate("plate")}, meshers);
  ASSERT_TRUE(outcome.ok());
  EXPECT_EQ(outcome->bodies[0].first_mesh_by, meshers[1]->name());
  EXPECT_NE(outcome->bodies[0].notes.at(0).find("the one that gives up"), std::string::npos);
  const Result<Outcome> none = run(study, {plate("plate")}, {std::make_shared<GivesUp>()});
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().code, Code::failed);
}

TEST(Run, TwoBodiesKeepTheirNamesAndWalls) {
  Study study;
  study.bodies = {{"a", 1}, {"b", 1}};
  study.options.iterations = 1;
  const Result<Outcome> outcome = run(study, {plate("a"), plate("b")}, real());
  ASSERT_TRUE(outcome.ok());
  EXPECT_EQ(outcome->state->mesh.bodies, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(outcome->state->mesh.groups, (std::vector<std::string>{"a walls", "b walls"}));
  EXPECT_EQ(outcome->bodies.size(), 2u);
}

TEST(Run, CancelGivesTheBestSoFarOrAnErrorBeforeTheFirstMesh) {
  Study study;
  study.bodies = {{"plate", 2}};
  std::stop_source stop;
  const Result<Outcome> outcome =
      run(study, {plate("plate")}, real(), Progress({}, stop.get_token()),
          [&](const IterationRecord& r, const auto&) {
            if (r.iteration == 1) stop.request_stop();
          });
  ASSERT_TRUE(outcome.ok());
  EXPECT_TRUE(outcome->cancelled);
  EXPECT_FALSE(outcome->converged);
  EXPECT_EQ(outcome->records.size(), 2u);
  EXPECT_TRUE(validate<3>(outcome->state->mesh).ok());

  const Result<Outcome> early =
      run(study, {plate("plate")}, real(), Progress({}, stop.get_token()));
  ASSERT_FALSE(early.ok());
  EXPECT_EQ(early.error().code, Code::cancelled);
}

TEST(Run, WhatWillNotFitIsRefusedBeforeItIsTried) {
  Study study;
  IterationRecord first;
  const auto outcome =
      run(study, {plate("plate")}, real(), {}, [&](const IterationRecord& r, const auto&) {
        if (r.iteration == 0) first = r;
      });
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_GT(first.forecast_memory, 0);
  EXPECT_NEAR(first.forecast_nodes / static_cast<double>(outcome->records.back().nodes), 1, 0.4);

  study.options.memory = 0.5 * first.forecast_memory;
  const auto refused = run(study, {plate("plate")}, real());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::memory);
  study.options.memory = 3 * first.forecast_memory;
  EXPECT_TRUE(run(study, {plate("plate")}, real()));
}

TEST(Run, RequestsWithoutSenseAreRefused) {
  Study study;
  EXPECT_EQ(run(study, {}, real()).error().code, Code::usage);
  study.bodies = {{"plate", 0}};
  EXPECT_EQ(run(study, {plate("plate")}, real()).error().code, Code::usage);
  study.bodies = {{"plate", 2, 1, 0.5, 0.1}};
  EXPECT_EQ(run(study, {plate("plate")}, real()).error().code, Code::usage);
  study.bodies = {{"plate", 2}};
  study.bodies[0].layers2 = 3;
  EXPECT_EQ(run(study, {plate("plate")}, real()).error().code, Code::usage) << "without alpha2";
  study.bodies[0].layers2.reset();
  study.bodies[0].layers3 = 0;
  EXPECT_EQ(run(study, {plate("plate")}, real()).error().code, Code::usage);
  FacesShape face, no_face;
  face.ids = {0};
  no_face.ids = {99};
  EXPECT_EQ(run(with_gate(no_face, 1), {plate("plate")}, real()).error().code, Code::usage);
  EXPECT_EQ(run(with_gate(SphereShape{}, 1), {plate("plate")}, real()).error().code, Code::usage);
  const Error lost = run(with_gate(face, 1, "lid"), {plate("plate")}, real()).error();
  EXPECT_EQ(lost.code, Code::usage);
  EXPECT_NE(lost.message.find("\"lid\""), std::string::npos);
  EXPECT_NE(lost.hint.find("\"plate\""), std::string::npos);
  const Error whose = run(with_gate(face, 1), {plate("a"), plate("b")}, real()).error();
  EXPECT_EQ(whose.code, Code::usage);
}

}  // namespace
}  // namespace lamella
