#include "core/study/forecast.h"

#include <gtest/gtest.h>

#include "core/geometry/soup.h"
#include "core/mesh/sample_meshes.h"
#include "core/study/measure.h"
#include "core/study/run.h"
#include "tests/support/plate_part.h"

namespace lamella {
namespace {

std::vector<std::shared_ptr<const VolumeMesher>> meshers() {
  return {std::shared_ptr<const VolumeMesher>(topological_mesher())};
}

TEST(ForecastStudy, TellsWhatTheRunWillMake) {
  Study study;
  study.bodies = {{"plate", 3}};
  SizeCorrection size;
  size.size = 0.15;
  study.sizing = {{"gate", "plate", SphereShape{{4, 4, 1}, 0.8}, size}};
  const auto forecast = forecast_study(study, {plate("plate")}, meshers());
  ASSERT_TRUE(forecast.ok()) << forecast.error().message;
  ASSERT_EQ(forecast->size(), 1u);
  EXPECT_EQ(forecast->at(0).name, "plate");
  const SizingForecast& told = forecast->at(0).mesh;
  for (const bool with : {false, true}) {
    if (!with) study.sizing.clear();
    if (with) study.sizing = {{"gate", "plate", SphereShape{{4, 4, 1}, 0.8}, size}};
    const Result<Outcome> outcome = run(study, {plate("plate")}, meshers());
    ASSERT_TRUE(outcome.ok());
    const auto nodes = static_cast<double>(outcome->state->mesh.node_count());
    EXPECT_NEAR(with ? told.corrected.nodes : told.natural.nodes, nodes, 0.25 * nodes) << with;
  }
}

TEST(ForecastStudy, EachBodyHasItsOwn) {
  Study study;
  study.bodies = {{"a", 1}, {"b", 4}};
  SizeCorrection size;
  size.size = 0.1;
  study.sizing = {{"gate", "a", SphereShape{{4, 4, 1}, 0.5}, size}};
  const auto forecast = forecast_study(study, {plate("a"), plate("b")}, meshers());
  ASSERT_TRUE(forecast.ok());
  const SizingForecast &a = forecast->at(0).mesh, &b = forecast->at(1).mesh;
  EXPECT_GT(a.corrected.nodes, 2 * a.natural.nodes);
  EXPECT_EQ(b.corrected.nodes, b.natural.nodes);
  EXPECT_GT(b.natural.nodes, a.natural.nodes);
}

TEST(ForecastStudy, RoundsOfTheFlowCountWithTheirBudget) {
  Study study;
  study.bodies = {{"a", 2}, {"b", 2}};
  study.groups = {{"gate", GroupKind::gate}, {"vent", GroupKind::vent}};
  study.groups[0].floods = {{{0, 4, 0.5}, 0.3}};
  study.groups[1].floods = {{{8, 4, 0.5}, 0.3}};
  for (BoundaryGroup& group : study.groups) group.body = "a";
  study.flow.emplace();
  study.flow->rounds = 2;
  study.flow->growth = 1.5;
  const MeshForecast mesh{6000, 1000, 1.3};
  const auto flow = forecast_flow(study, "a", mesh);
  ASSERT_TRUE(flow.has_value());
  EXPECT_EQ(flow->solves, 3);
  EXPECT_DOUBLE_EQ(flow->mesh.nodes, 1500);
  EXPECT_DOUBLE_EQ(flow->mesh.elements, 9000);
  EXPECT_GT(flow->mesh.memory, 1.5 * mesh.memory);  // the solver needs more than the adaption
  EXPECT_FALSE(forecast_flow(study, "b", mesh).has_value());  // it has no gate
  study.flow->rounds = 0;
  EXPECT_EQ(forecast_flow(study, "a", mesh)->solves, 1);
  EXPECT_DOUBLE_EQ(forecast_flow(study, "a", mesh)->mesh.nodes, 1000);

  const auto bodies = forecast_study(study, {plate("a"), plate("b")}, meshers());
  ASSERT_TRUE(bodies.ok()) << bodies.error().message;
  ASSERT_TRUE(bodies->at(0).flow.has_value());
  EXPECT_DOUBLE_EQ(bodies->at(0).flow->mesh.nodes, bodies->at(0).mesh.corrected.nodes);
  EXPECT_FALSE(bodies->at(1).flow.has_value());
}

TEST(ForecastStudy, RefusesWhatRunRefuses) {
  Study study;
  EXPECT_EQ(forecast_study(study, {}, meshers()).error().code, Code::usage);
  study.sizing = {{"gate", "lid", SphereShape{{4, 4, 1}, 0.5}, SizeCorrection{}}};
  EXPECT_EQ(forecast_study(study, {plate("plate")}, meshers()).error().code, Code::usage);
  EXPECT_EQ(forecast_study({}, {plate("plate")}, {}).error().code, Code::failed);
}

}  // namespace
}  // namespace lamella
