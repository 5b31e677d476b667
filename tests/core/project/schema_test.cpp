#include <gtest/gtest.h>

#include "core/base/atomic_file.h"
#include "core/base/sha256.h"
#include "core/study/study_file.h"
#include "tests/support/json_schema.h"

namespace lamella {
namespace {

using nlohmann::json;

struct PublishedSchema : testing::Test {
  const json schema = json::parse(
      read_file(std::string(LAMELLA_SOURCE_DIR) + "/resources/docs/project.schema.json").value());
  std::string fault(const json& study) { return test::schema_fault(study, schema, schema); }
  bool reads(const json& study) { return study_from_json(study.dump(), "s").ok(); }
};

/// A study that has everything a study can have.
Study full_study() {
  Study study;
  study.name = "all";
  study.inputs = {{"a.step"}, {"b.stl", 25.4, sha256("b"), 1, "inputs/2-b.stl"}};
  study.embed_inputs = true;
  study.left_out = {"pin"};
  BodySettings body{"a", 6, 0.5, 0.1, 2.0};
  body.layers2 = 3;
  body.alpha2 = 2;
  body.layers3 = 2;
  body.color = {0, 0.5, 1};
  body.interface_size = 0.1;
  study.bodies = {body};
  study.zones = {{"ball", ZoneBall{{0, 0, 0}, 1}},
                 {"box", ZoneBox{{0, 0, 0}, {1, 1, 1}}},
                 {"rod", ZoneCylinder{{0, 0, 0}, {1, 0, 0}, 1}},
                 {"below", ZoneHalfSpace{{0, 0, 1}, -2}},
                 {"grain", ZoneCell{{1, 2, 3}, "grains"}}};
  study.domain = StudyDomain{DomainMargin{0.2}};
  study.dropped = {"ball"};
  study.options.chord_tolerance = 0.1;
  study.options.memory = 100;
  SizeCorrection size, factor;
  size.size = 0.1;
  factor.factor = 2;
  AnalyticZone zone;
  zone.frame = CylindricalFrame{};
  zone.sizes = {1, 1, 1};
  zone.progression = {RadialProgression::Kind::geometric, 0, 2, {1, 1, 1}};
  AnalyticZone flat;
  flat.sizes = {1, 2, 3};
  FacesShape faces;
  faces.ids = {1};
  faces.names = {"top"};
  faces.others = true;
  study.sizing = {{"1", "a", SphereShape{{0, 0, 0}, 1}, size},
                  {"2", "", BoxShape{{0, 0, 0}, {1, 1, 1}}, factor},
                  {"3", "", CylinderShape{{0, 0, 0}, {1, 0, 0}, 1}, zone},
                  {"4", "", WholeBody{}, flat},
                  {"5", "a", faces, BoundaryLayer{0.5, 3}}};
  study.groups = {{"gate", GroupKind::gate, "a", {1}, {"top"}, {{{1, 2, 3}, 0.3}}}};
  study.flow.emplace();
  study.flow->method = FlowMethod::field;
  study.flow->h_min = 0.1;
  study.flow->field = StudyField{{"r.vtu", 1000, sha256("r"), 1, "inputs/3-r.vtu"}, "T"};
  study.cuts = {{"cut"}};
  return study;
}

TEST_F(PublishedSchema, OurOwnFilesSatisfyIt) {
  EXPECT_EQ(fault(json::parse(study_to_json(Study{}))), "");
  Study study = full_study();
  EXPECT_EQ(fault(json::parse(study_to_json(study))), "");
  for (const auto& shape : {decltype(StudyDomain::shape){DomainBodies{}},
                            decltype(StudyDomain::shape){ZoneBox{{0, 0, 0}, {1, 1, 1}}},
                            decltype(StudyDomain::shape){ZoneCylinder{{0, 0, 0}, {1, 0, 0}, 1}},
                            decltype(StudyDomain::shape){DomainBody{"a"}}}) {
    study.domain = StudyDomain{shape};
    EXPECT_EQ(fault(json::parse(study_to_json(study))), "");
  }
  ASSERT_TRUE(reads(json::parse(study_to_json(full_study()))));
}

TEST_F(PublishedSchema, WhatItRefusesWeRefuseToo) {
  const json good = json::parse(study_to_json(full_study()));
  const std::vector<std::pair<std::string, json>> changes = {{"/schema", 3},
                                                             {"/unit", "inch"},
                                                             {"/inputs/1/sha256", "abc"},
                                                             {"/inputs/1/bytes", -1},
                                                             {"/inputs/1/file", ""},
                                                             {"/embed_inputs", 1},
                                                             {"/bodies/0/layers", 0},
                                                             {"/bodies/0/h_min", 0},
                                                             {"/bodies/0/color", {0, 0, 2}},
                                                             {"/zones/0/shape", "egg"},
                                                             {"/zones/0/radius", -1},
                                                             {"/domain/share", 0},
                                                             {"/options/iterations", 2.5},
                                                             {"/options/detector", "radar"},
                                                             {"/sizing/0/gradation", 1},
                                                             {"/sizing/2/zone/sizes", {1, 1}},
                                                             {"/groups/0/kind", "door"},
                                                             {"/flow/method", "guess"},
                                                             {"/flow/h_min", 0},
                                                             {"/flow/field/file", ""},
                                                             {"/flow/field/name", ""},
                                                             {"/flow/field/unit", -1},
                                                             {"/cuts/0/origin", "here"},
                                                             {"/unknown", 1}};
  for (const auto& [path, value] : changes) {
    json bad = good;
    bad[json::json_pointer(path)] = value;
    EXPECT_NE(fault(bad), "") << path;
    EXPECT_FALSE(reads(bad)) << path;
  }
  // Every member that we know is in the schema: none of them may be left without a place.
  for (const auto& [name, value] : good.items()) {
    json missing = schema;
    missing["properties"].erase(name);
    EXPECT_NE(test::schema_fault(good, missing, missing), "") << name;
  }
}

}  // namespace
}  // namespace lamella
