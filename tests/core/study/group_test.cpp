#include "core/study/group.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/geometry/soup.h"
#include "core/io/export_certificate.h"
#include "core/mesh/sample_meshes.h"
#include "core/mesh/validate.h"
#include "core/study/measure.h"
#include "core/study/request.h"
#include "core/study/run.h"
#include "core/study/study.h"
#include "tests/support/plate_part.h"

namespace lamella {
namespace {

using Meshers = std::vector<std::shared_ptr<const VolumeMesher>>;
Meshers real() { return {std::shared_ptr<const VolumeMesher>(topological_mesher())}; }

double area_of(const ReferenceSurface<3>& s, std::int32_t facet) {
  const auto& f = s.facets[static_cast<std::size_t>(facet)];
  return 0.5 * (s.points[f[1]] - s.points[f[0]]).cross(s.points[f[2]] - s.points[f[0]]).norm();
}

double area_of(const ReferenceSurface<3>& s, const std::vector<std::int32_t>& facets) {
  double area = 0;
  for (const std::int32_t f : facets) area += area_of(s, f);
  return area;
}

/// The face of the plate whose center is nearest to x.
std::int32_t face_at(const Part& part, const Vec<3>& x) {
  std::map<std::int32_t, std::pair<Vec<3>, double>> centers;
  for (std::size_t f = 0; f < part.surface.facets.size(); ++f) {
    Vec<3> middle = Vec<3>::Zero();
    for (const std::int32_t v : part.surface.facets[f]) middle += part.surface.points[v] / 3;
    auto& [sum, weight] =
        centers.try_emplace(part.surface.facet_face[f], Vec<3>::Zero(), 0.0).first->second;
    const double area = area_of(part.surface, static_cast<std::int32_t>(f));
    sum += area * middle;
    weight += area;
  }
  std::int32_t best = -1;
  double distance = 1e300;
  for (const auto& [face, center] : centers) {
    const double d = (center.first / center.second - x).norm();
    if (d < distance) {
      distance = d;
      best = face;
    }
  }
  return best;
}

TEST(Group, AFloodStopsAtEdgesThatTurnMoreThanItsAngle) {
  const Part part = plate("plate");
  BoundaryGroup group{"top", GroupKind::gate};
  group.floods = {{Vec<3>(4, 4, 1), 0.35}};
  const auto top = facets_of(group, part.surface);
  ASSERT_TRUE(top) << top.error().message;
  EXPECT_NEAR(area_of(part.surface, *top), 64, 1e-12);
  // The edges of a plate turn by a right angle: past that the flood takes everything.
  group.floods[0].angle = 1.6;
  EXPECT_EQ(facets_of(group, part.surface)->size(), part.surface.facets.size());
}

TEST(Group, WhatCannotBeMeantIsRefused) {
  const Part part = plate("plate");
  BoundaryGroup group{"gate", GroupKind::gate};
  EXPECT_FALSE(facets_of(group, part.surface));
  group.faces = {static_cast<std::int32_t>(part.surface.faces.size())};
  EXPECT_FALSE(facets_of(group, part.surface));
  group.faces = {};
  group.face_names = {"nowhere"};
  EXPECT_FALSE(facets_of(group, part.surface));
  group = {"", GroupKind::gate};
  group.faces = {0};
  EXPECT_FALSE(group_faces({group}, part.surface));
  // Nothing is left for the second group on one face.
  BoundaryGroup first{"first"}, second{"second"};
  first.faces = second.faces = {0};
  EXPECT_FALSE(group_faces({first, second}, part.surface));
  Study study;
  study.groups = {first};
  study.groups[0].body = "lid";
  EXPECT_FALSE(check_request(study, {part}));
  study.groups[0].body = "plate";
  EXPECT_TRUE(check_request(study, {part}));
}

TEST(Group, BordersThroughAFaceBecomeFeaturesAndItsPiecesNewFaces) {
  // All CAD faces of the plate in one: a flood over its top divides it.
  Part part = plate("plate");
  for (std::int32_t& face : part.surface.facet_face) face = 0;
  part.surface.faces.resize(1);
  part.surface.feature_edges.clear();
  part.surface.corners.clear();
  BoundaryGroup group{"top"};
  group.floods = {{Vec<3>(1, 1, 1), 0.35}};
  const auto grouped = group_faces({group}, part.surface);
  ASSERT_TRUE(grouped) << grouped.error().message;
  EXPECT_EQ(grouped->surface.faces.size(), 2u);
  EXPECT_EQ(grouped->groups.cad_face, (std::vector<std::int32_t>{0, 0}));
  double border = 0;
  for (const auto& [a, b] : grouped->surface.feature_edges)
    border += (grouped->surface.points[a] - grouped->surface.points[b]).norm();
  EXPECT_NEAR(border, 32, 1e-12);
  EXPECT_EQ(grouped->surface.corners.size(), 4u);
  double top = 0;
  for (std::size_t f = 0; f < grouped->surface.facets.size(); ++f)
    if (grouped->groups.face_group[grouped->surface.facet_face[f]] == 0)
      top += area_of(grouped->surface, static_cast<std::int32_t>(f));
  EXPECT_NEAR(top, 64, 1e-12);
}

TEST(Group, AreasOnPlanesAndCadFacesSurviveTheRun) {
  const Part part = plate("plate");
  Study study;
  study.bodies = {{"plate", 2}};
  study.options.iterations = 2;
  BoundaryGroup gate{"gate", GroupKind::gate, "plate"}, side{"symmetry plane"};
  gate.faces = {face_at(part, Vec<3>(4, 4, 1))};
  side.floods = {{Vec<3>(0, 4, 0.5), 0.35}};
  study.groups = {gate, side};
  const Result<Outcome> outcome = run(study, {part}, real());
  ASSERT_TRUE(outcome) << outcome.error().message;
  const SimplexMesh<3>& mesh = outcome->state->mesh;
  EXPECT_TRUE(validate<3>(mesh));
  std::map<std::string, double> area;
  for (const NamedMeasure& group : summarize(mesh).groups) area[group.name] = group.measure;
  ASSERT_EQ(area.size(), 3u);
  EXPECT_NEAR(area["gate"], 64, 64e-9);
  EXPECT_NEAR(area["symmetry plane"], 8, 8e-9);
  EXPECT_NEAR(area["walls"], 64 + 3 * 8, 88e-9);
  // Facets keep the numbers of the part's CAD faces.
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const bool in_gate = mesh.groups[static_cast<std::size_t>(mesh.facet_group[f])] == "gate";
    EXPECT_EQ(mesh.facet_face[f] == gate.faces[0], in_gate);
  }
}

TEST(Group, ABorderInsideAPlaneSurvivesTheRun) {
  // Two CAD faces that lie in one plane: nothing but the group keeps their border.
  Part part = plate("plate");
  const std::int32_t top = face_at(part, Vec<3>(4, 4, 1));
  const auto half = static_cast<std::int32_t>(part.surface.faces.size());
  part.surface.faces.emplace_back();
  for (std::size_t f = 0; f < part.surface.facets.size(); ++f) {
    double x = 0;
    for (const std::int32_t v : part.surface.facets[f]) x += part.surface.points[v][0] / 3;
    if (part.surface.facet_face[f] == top && x < 4) part.surface.facet_face[f] = half;
  }
  Study study;
  study.bodies = {{"plate", 2}};
  study.options.iterations = 2;
  study.groups = {{"vent", GroupKind::vent}};
  study.groups[0].faces = {half};
  const Result<Outcome> outcome = run(study, {part}, real());
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_TRUE(validate<3>(outcome->state->mesh));
  double vent = 0;
  for (const NamedMeasure& group : summarize(outcome->state->mesh).groups)
    if (group.name == "vent") vent = group.measure;
  EXPECT_NEAR(vent, 32, 32e-9);
}

TEST(StudyParts, NamesThatWereTakenGetANumberAndWhatIsLeftOutGoes) {
  std::vector<Part> parts = {plate("a"), plate("a"), plate("b"), plate("a")};
  const std::vector<Part> named = study_parts(parts, {"a (2)"});
  ASSERT_EQ(named.size(), 3u);
  EXPECT_EQ(named[0].name, "a");
  EXPECT_EQ(named[1].name, "b");
  EXPECT_EQ(named[2].name, "a (3)");
}

}  // namespace
}  // namespace lamella
