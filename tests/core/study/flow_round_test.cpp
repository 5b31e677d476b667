#include "core/study/flow_round.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/study/request.h"
#include "core/study/run.h"
#include "tests/support/plate_part.h"

namespace lamella {
namespace {

using Meshers = std::vector<std::shared_ptr<const VolumeMesher>>;
Meshers real() { return {std::shared_ptr<const VolumeMesher>(topological_mesher())}; }

/// Along x through the plate of 8 x 8 x 1, walls at the other four sides.
Study through_the_plate(int layers, FlowMethod method) {
  Study study;
  study.bodies = {{"plate", layers}};
  study.groups = {{"in", GroupKind::gate}, {"out", GroupKind::vent}};
  study.groups[0].floods = {{{0, 4, 0.5}, 0.3}};
  study.groups[1].floods = {{{8, 4, 0.5}, 0.3}};
  study.flow.emplace();
  study.flow->method = method;
  return study;
}

/// Of a rectangular duct at a pressure of 1 and a viscosity of 1, by its series.
double rate_of_the_plate() {
  const double a = 8, b = 1, length = 8;
  double sum = 0;
  for (int n = 1; n < 40; n += 2)
    sum += std::tanh(n * std::numbers::pi * a / (2 * b)) / std::pow(n, 5);
  return a * b * b * b / (12 * length) * (1 - 192 * b / (std::pow(std::numbers::pi, 5) * a) * sum);
}

TEST(FlowRound, TheCaseIsThatOfTheGroups) {
  Study study = through_the_plate(2, FlowMethod::velocity);
  study.groups.push_back({"middle", GroupKind::symmetry, "other"});
  study.groups[0].rate = 7;
  study.flow->viscosity = 3;
  const FlowCase<3> flow = flow_case_of(study, "plate");
  ASSERT_EQ(flow.gates.size(), 1u);
  EXPECT_EQ(flow.gates[0].rate, 7);
  EXPECT_FALSE(flow.gates[0].pressure.has_value());
  EXPECT_EQ(flow.vents, std::vector<std::string>{"out"});
  EXPECT_TRUE(flow.symmetries.empty());
  EXPECT_EQ(flow.viscosity, 3);
  study.groups[0].rate.reset();
  EXPECT_EQ(flow_case_of(study, "plate").gates[0].pressure, 1);
  EXPECT_TRUE(has_flow(study, "plate"));
  study.bodies[0].flow = false;
  EXPECT_FALSE(has_flow(study, "plate"));
}

TEST(FlowRound, ARefusalNamesGateAndBody) {
  Study study = through_the_plate(2, FlowMethod::velocity);
  study.groups[0].pressure = 1;
  study.groups[0].rate = 7;
  const auto both = check_request(study, {plate("plate")});
  ASSERT_FALSE(both.ok());
  EXPECT_EQ(both.error().message, "Gate \"in\" has a pressure and a rate.");
  study.groups[0].rate.reset();
  study.groups[1].kind = GroupKind::walls;
  const auto closed = check_request(study, {plate("plate")});
  ASSERT_FALSE(closed.ok());
  EXPECT_NE(closed.error().message.find("\"plate\""), std::string::npos) << closed.error().message;
}

TEST(FlowRound, WhatCannotFlowIsRefusedBeforeTheRun) {
  Study study = through_the_plate(2, FlowMethod::velocity);
  EXPECT_TRUE(check_request(study, {plate("plate")}).ok());
  study.groups[1].kind = GroupKind::walls;
  EXPECT_EQ(check_request(study, {plate("plate")}).error().code, Code::usage);
  study = through_the_plate(2, FlowMethod::velocity);
  study.bodies[0].flow = false;
  EXPECT_EQ(check_request(study, {plate("plate")}).error().code, Code::usage);
  study = through_the_plate(2, FlowMethod::velocity);
  study.groups[0].pressure = 1;
  study.groups[0].rate = 1;
  EXPECT_EQ(check_request(study, {plate("plate")}).error().code, Code::usage);
}

TEST(FlowRound, TheLoopCorrectsTheMeshAndTheRateComesNearer) {
  for (const FlowMethod method : {FlowMethod::velocity, FlowMethod::directional}) {
    Study study = through_the_plate(3, method);
    study.flow->beta = 0.5;
    study.options.iterations = 3;
    const Result<Outcome> outcome = run(study, {plate("plate")}, real());
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    const BodyOutcome& body = outcome->bodies.at(0);
    ASSERT_GE(body.records.size(), 3u);
    const IterationRecord& after = body.records.back();
    const IterationRecord& before = body.records[body.records.size() - 2];
    ASSERT_GT(before.flow_rate, 0);
    const double exact = rate_of_the_plate();
    EXPECT_LT(std::abs(after.flow_rate - exact), std::abs(before.flow_rate - exact));
    EXPECT_NEAR(after.flow_rate, exact, 0.15 * exact);
    EXPECT_EQ(after.flow_pressure, 1);
    EXPECT_GT(after.elements, before.elements);
    EXPECT_LT(after.elements, 2 * before.elements) << "the budget is 1.5";
    EXPECT_GE(body.layers.mean, 3) << "layers stay";
    ASSERT_TRUE(outcome->state->flow);
    const FlowFields& flow = *outcome->state->flow;
    EXPECT_EQ(flow.velocity.size(), outcome->state->mesh.points.size());
    EXPECT_EQ(flow.indicator.size(), outcome->state->mesh.elements.size());
    EXPECT_LT(flow.imbalance, 1e-6);
  }
}

TEST(FlowRound, NoRoundSolvesTheFlowAndLeavesTheMesh) {
  Study study = through_the_plate(2, FlowMethod::acceleration);
  study.flow->rounds = 0;
  study.options.iterations = 2;
  const Result<Outcome> flowing = run(study, {plate("plate")}, real());
  study.flow.reset();
  const Result<Outcome> resting = run(study, {plate("plate")}, real());
  ASSERT_TRUE(flowing.ok() && resting.ok());
  EXPECT_EQ(flowing->state->mesh.points, resting->state->mesh.points);
  EXPECT_TRUE(flowing->state->flow);
  EXPECT_FALSE(resting->state->flow);
  EXPECT_GT(flowing->records.back().flow_rate, 0);
}

TEST(FlowRound, OneBodyOfTwoFlows) {
  Study study = through_the_plate(2, FlowMethod::velocity);
  study.options.iterations = 2;
  Part other = plate("other");
  for (Vec<3>& x : other.surface.points) x[2] += 3;
  for (BoundaryGroup& group : study.groups) group.body = "plate";
  const Result<Outcome> outcome = run(study, {plate("plate"), other}, real());
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  ASSERT_TRUE(outcome->state->flow);
  const FlowFields& flow = *outcome->state->flow;
  const SimplexMesh<3>& mesh = outcome->state->mesh;
  ASSERT_EQ(flow.velocity.size(), mesh.points.size());
  double fastest[2] = {0, 0};
  for (std::size_t n = 1; n < mesh.points.size(); ++n) {
    double& most = fastest[mesh.points[n][2] > 2];
    most = std::max(most, flow.velocity[n].norm());
  }
  EXPECT_GT(fastest[0], 0);
  EXPECT_EQ(fastest[1], 0);
  EXPECT_GT(outcome->bodies[0].records.size(), outcome->bodies[1].records.size());
}

TEST(FlowRound, ACancelInTheFlowKeepsTheNaturalMesh) {
  Study study = through_the_plate(2, FlowMethod::velocity);
  study.options.iterations = 1;
  std::stop_source stop;
  const Progress progress({}, stop.get_token());
  const Result<Outcome> outcome =
      run(study, {plate("plate")}, real(), progress, [&](const IterationRecord& r, const auto&) {
        if (r.iteration == 1) stop.request_stop();
      });
  ASSERT_TRUE(outcome.ok());
  EXPECT_TRUE(outcome->cancelled);
  EXPECT_EQ(outcome->records.size(), 2u);
  EXPECT_GT(outcome->state->mesh.elements.size(), 0u);
}

}  // namespace
}  // namespace lamella
