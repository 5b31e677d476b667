#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/study/flow_of_mesh.h"
#include "core/study/flow_round.h"
#include "core/study/request.h"
#include "core/study/run.h"
#include "core/study/study_field.h"
#include "tests/support/plate_part.h"

namespace lamella {
namespace {

using Meshers = std::vector<std::shared_ptr<const VolumeMesher>>;
Meshers real() { return {std::shared_ptr<const VolumeMesher>(topological_mesher())}; }

/// A front across the plate at x = 3: no wall says that the mesh must be fine there.
double front(const Vec<3>& x) { return std::tanh((x[0] - 3) / 0.4); }

/// What another solver has found on a plate of `low` to `high`, on cubes of its own.
std::shared_ptr<const SolverField> found_on(const Vec<3>& low, const Vec<3>& high, double unit = 1,
                                            const std::string& name = "T") {
  auto field = std::make_shared<SolverField>();
  field->mesh = box_mesh<3>({60, 10, 2}, low, high);
  field->field = {name, name == "U" ? 3 : 1, {}};
  for (const Vec<3>& x : field->mesh.points) {
    field->field.values.push_back(front(x));
    if (name == "U") field->field.values.insert(field->field.values.end(), {0.0, 1.0});
  }
  for (Vec<3>& x : field->mesh.points) x *= unit;
  return field;
}
std::shared_ptr<const SolverField> found() { return found_on(Vec<3>::Zero(), Vec<3>(8, 8, 1)); }

Study by_the_field(FlowMethod method, const std::string& name = "T") {
  Study study;
  study.bodies = {{"plate", 2}};
  study.options.iterations = 2;
  study.flow.emplace();
  study.flow->method = method;
  study.flow->growth = 3;
  study.flow->beta = 0.25;
  study.flow->field = StudyField{{"solved.vtu"}, name};
  return study;
}

/// Mean over the volume of what linear elements miss of the front.
double interpolation_error(const SimplexMesh<3>& mesh) {
  double error = 0, volume = 0;
  for (const auto& e : mesh.elements) {
    const double v = signed_measure<3>(mesh.corners(e));
    Vec<3> center = Vec<3>::Zero();
    double mean = 0;
    for (const NodeId n : e) {
      center += mesh.points[n] / 4;
      mean += front(mesh.points[n]) / 4;
    }
    error += v * std::abs(front(center) - mean);
    volume += v;
  }
  return error / volume;
}

double finest_at(const SimplexMesh<3>& mesh, double x) {
  double least = 1e9;
  for (const auto& e : mesh.elements)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b) {
        const Vec<3> edge = mesh.points[e[a]] - mesh.points[e[b]];
        const double at = (mesh.points[e[a]] + mesh.points[e[b]])[0] / 2;
        if (std::abs(at - x) < 0.5) least = std::min(least, edge.norm());
      }
  return least;
}

TEST(FieldRound, AFrontThatNoWallTellsOfIsResolved) {
  for (const FlowMethod method : {FlowMethod::field, FlowMethod::indicator}) {
    SCOPED_TRACE(flow_method_name(method));
    Study study = by_the_field(method, method == FlowMethod::field ? "T" : "I");
    auto field = found();
    if (method == FlowMethod::indicator) {
      auto positive = std::make_shared<SolverField>(*field);
      positive->field.name = "I";
      for (double& v : positive->field.values) v = 1 - v * v;  // what the front's slope is
      field = positive;
    }
    std::map<int, std::shared_ptr<const MeshState>> states;
    const Result<Outcome> outcome = run(
        study, {plate("plate")}, real(), {},
        [&](const IterationRecord& r, const auto& state) { states[r.iteration] = state; }, field);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    ASSERT_GE(outcome->records.size(), 3u);
    // The last of the records is the round.
    const auto before = states[static_cast<int>(outcome->records.size()) - 2];
    ASSERT_TRUE(before && outcome->state);
    const SimplexMesh<3>& after = outcome->state->mesh;
    EXPECT_LT(after.elements.size(), 3.6 * double(before->mesh.elements.size())) << "the budget";
    // An indicator knows no direction: all sizes get smaller.
    const double share = method == FlowMethod::field ? 0.5 : 0.8;
    EXPECT_LT(interpolation_error(after), share * interpolation_error(before->mesh));
    EXPECT_GE(outcome->bodies[0].layers.mean, 1.9) << "layers stay";
    // The mesh carries the field, and the note says what became of it.
    ASSERT_TRUE(outcome->state->flow);
    EXPECT_EQ(outcome->state->flow->field, study.flow->field->name);
    for (std::size_t n = 1; method == FlowMethod::field && n < after.points.size(); n += 7)
      EXPECT_NEAR(outcome->state->flow->number[n], front(after.points[n]), 0.05);
    bool told = false;
    for (const std::string& note : outcome->bodies[0].notes)
      told = told || note.find("Corrected by the field \"" + study.flow->field->name) == 0;
    EXPECT_TRUE(told);
  }
}

TEST(FieldRound, SizesOfTheCorrectionAreBounded) {
  Study study = by_the_field(FlowMethod::field);
  study.flow->strength = 3;
  const Result<Outcome> free = run(study, {plate("plate")}, real(), {}, {}, found());
  study.flow->h_min = 0.5;
  const Result<Outcome> bounded = run(study, {plate("plate")}, real(), {}, {}, found());
  ASSERT_TRUE(free.ok() && bounded.ok());
  EXPECT_LT(finest_at(free->state->mesh, 3), 0.7 * finest_at(bounded->state->mesh, 3));
}

TEST(FieldRound, ABodyThatIsLeftOutKeepsItsNaturalMesh) {
  Study study = by_the_field(FlowMethod::field);
  Part other = plate("other");
  for (Vec<3>& x : other.surface.points) x[2] += 3;
  study.bodies.push_back({"other", 2});
  study.bodies[1].flow = false;
  const auto field = found_on(Vec<3>::Zero(), Vec<3>(8, 8, 4));
  const Result<Outcome> outcome = run(study, {plate("plate"), other}, real(), {}, {}, field);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_GT(outcome->bodies[0].records.size(), outcome->bodies[1].records.size());
  // On a body that the field does not reach the mesh is the natural one, and that is told.
  study.bodies[1].flow = true;
  const Result<Outcome> partly = run(study, {plate("plate"), other}, real(), {}, {}, found());
  ASSERT_TRUE(partly.ok()) << partly.error().message;
  bool told = false;
  for (const std::string& note : partly->bodies[1].notes)
    told = told || note.find("does not lie") != std::string::npos;
  EXPECT_TRUE(told);
  EXPECT_EQ(partly->bodies[1].records.size(), outcome->bodies[1].records.size());
}

TEST(FieldRound, WhatCannotCorrectIsRefusedBeforeTheFirstMesh) {
  const auto refusal = [](const Study& study, const std::shared_ptr<const SolverField>& field) {
    int meshes = 0;
    const Result<Outcome> outcome = run(
        study, {plate("plate")}, real(), {}, [&](const auto&, const auto&) { ++meshes; }, field);
    EXPECT_EQ(meshes, 0);
    EXPECT_FALSE(outcome.ok());
    if (outcome) return Error{};
    EXPECT_FALSE(outcome.error().hint.empty());
    return outcome.error();
  };
  const Study study = by_the_field(FlowMethod::field);
  EXPECT_EQ(refusal(study, nullptr).code, Code::usage);
  const Vec<3> size(8, 8, 1);
  EXPECT_EQ(refusal(study, found_on(Vec<3>::Zero(), size, 1e-3)).code, Code::bad_input);
  EXPECT_EQ(refusal(study, found_on(Vec<3>(7, 0, 0), size + Vec<3>(7, 0, 0))).code,
            Code::bad_input);
  EXPECT_EQ(refusal(by_the_field(FlowMethod::strain), found()).code, Code::usage);
  EXPECT_EQ(refusal(by_the_field(FlowMethod::residual), found()).code, Code::usage);
  EXPECT_EQ(
      refusal(by_the_field(FlowMethod::indicator, "U"), found_on(Vec<3>::Zero(), size, 1, "U"))
          .code,
      Code::usage);
  Study none = by_the_field(FlowMethod::field);
  none.bodies[0].flow = false;
  EXPECT_EQ(refusal(none, found()).code, Code::usage);
  none = by_the_field(FlowMethod::field);
  none.flow->field.reset();
  EXPECT_EQ(refusal(none, nullptr).code, Code::usage) << "a method of fields without one";
}

TEST(FieldRound, AVectorCorrectsAsAVelocityDoes) {
  const auto velocity = found_on(Vec<3>::Zero(), Vec<3>(8, 8, 1), 1, "U");
  for (const FlowMethod method : {FlowMethod::field, FlowMethod::acceleration, FlowMethod::strain,
                                  FlowMethod::combined, FlowMethod::direction}) {
    SCOPED_TRACE(flow_method_name(method));
    const auto mesh = box_mesh<3>({16, 4, 2}, Vec<3>::Zero(), Vec<3>(8, 8, 1));
    const Result<FlowFields> found = field_on(mesh, *velocity, method, 11.4);
    ASSERT_TRUE(found.ok()) << found.error().message;
    EXPECT_EQ(found->components, 3);
    // The indicator is largest where the velocity changes.
    std::size_t most = 0;
    for (std::size_t e = 0; e < mesh.elements.size(); ++e)
      if (found->indicator[e] > found->indicator[most]) most = e;
    double at = 0;
    for (const NodeId n : mesh.elements[most]) at += mesh.points[n][0] / 4;
    EXPECT_NEAR(at, 3, 0.8);
  }
}

TEST(FieldRound, OneMeshOfAllBodiesIsCorrectedToo) {
  Study study = by_the_field(FlowMethod::field);
  study.options.iterations = 4;
  study.domain = StudyDomain{};
  study.domain->shape = DomainBodies{};
  const Result<Outcome> outcome = run(study, {plate("plate")}, real(), {}, {}, found());
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  ASSERT_TRUE(outcome->state->flow);
  EXPECT_EQ(outcome->state->flow->field, "T");
  const auto& records = outcome->records;
  EXPECT_GT(records.back().elements, 1.3 * double(records[records.size() - 2].elements));
}

TEST(FieldRound, ThePreviewSaysWhatTheNextRoundAsksFor) {
  Study study = by_the_field(FlowMethod::field);
  study.flow->rounds = 0;
  const Result<Outcome> resting = run(study, {plate("plate")}, real(), {}, {}, found());
  ASSERT_TRUE(resting.ok()) << resting.error().message;
  ASSERT_TRUE(resting->state->flow);
  const Result<FlowPreview> preview = preview_flow(*resting->state, study);
  ASSERT_TRUE(preview.ok()) << preview.error().message;
  EXPECT_GT(preview->nodes_after, 1.5 * preview->nodes_before);
  EXPECT_LE(preview->elements_after, 3.01 * preview->elements_before);
  Study weaker = study;
  weaker.flow->strength = 0.05;
  EXPECT_LT(preview_flow(*resting->state, weaker)->nodes_after, preview->nodes_after);
  // Of another field nothing is known.
  study.flow->field->name = "p";
  EXPECT_FALSE(preview_flow(*resting->state, study).ok());
}

TEST(FieldRound, AMissingFileIsReadFromItsCopyOrMissed) {
  Study study = by_the_field(FlowMethod::field);
  study.flow->field->source.file = "/nowhere/solved.vtu";
  study.flow->field->source.sha256 = std::string(64, 'a');
  bool asked = false;
  const ResultReader never = [&](const std::filesystem::path&,
                                 const Progress&) -> Result<MeshContent> {
    asked = true;
    return MeshContent{};
  };
  const auto missing = load_field(study, {}, never);
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, Code::bad_input);
  EXPECT_NE(missing.error().message.find("solved.vtu"), std::string::npos);
  EXPECT_FALSE(missing.error().hint.empty());
  EXPECT_EQ(*find_result(*study.flow->field, {{std::string(64, 'a'), "/tmp/copy"}}), "/tmp/copy");
  study.flow.reset();
  EXPECT_EQ(*load_field(study, {}, never), nullptr);
  EXPECT_FALSE(asked) << "there is nothing to read";
}

}  // namespace
}  // namespace lamella
