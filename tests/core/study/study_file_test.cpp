#include "core/study/study_file.h"

#include <gtest/gtest.h>

#include "core/base/atomic_file.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

Study full_study() {
  Study study;
  study.name = "Tr\u00e4ger \"A\"";
  study.inputs = {{"parts/a.step"}, {"/abs/b.stl", 25.4}};
  study.left_out = {"pin (2)"};
  study.bodies = {{"cover", 6, 0.5, 0.01, 3.5, false}, {"lid"}};
  study.bodies[1].layers2 = 5;
  study.bodies[1].alpha2 = 9.5;
  study.bodies[1].layers3 = 2;
  study.bodies[1].color = {0.1, 0.2, 1};
  study.groups = {{"inlet", GroupKind::gate, "cover", {3, 1}, {"top \"1\""}, {{{1, 2, 3}, 0.5}}},
                  {"rest"}};
  study.groups[1].faces = {0};
  study.groups[0].rate = 1500;
  study.groups[1].pressure = 20;
  study.bodies[1].flow = false;
  study.flow = StudyFlow{FlowMethod::residual, 2, 0.5, 1.25, 3, 100};
  study.cuts = {{"middle", {1, 2, 3.25}, {0, 0.6, -0.8}, false}};
  study.options = {0.02, 12.5,  0.2, 9, 3, 12345678901234567890u, Detector::neighborhood,
                   true, false, 512};
  return study;
}

TEST(StudyFile, ReadsBackWhatItWrote) {
  const test::TemporaryFolder folder;
  Study study = full_study();
  study.bodies[0].role = BodyRole::insert;
  ASSERT_TRUE(write_study(study, folder / "s.json").ok());
  const Result<Study> back = read_study(folder / "s.json");
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->name, study.name);
  EXPECT_EQ(back->inputs, study.inputs);
  EXPECT_EQ(back->left_out, study.left_out);
  EXPECT_EQ(back->bodies.at(1).color, study.bodies[1].color);
  EXPECT_FALSE(back->bodies.at(0).color.has_value());
  ASSERT_EQ(back->groups.size(), 2u);
  EXPECT_EQ(back->groups[0].name, "inlet");
  EXPECT_EQ(back->groups[0].kind, GroupKind::gate);
  EXPECT_EQ(back->groups[0].body, "cover");
  EXPECT_EQ(back->groups[0].faces, study.groups[0].faces);
  EXPECT_EQ(back->groups[0].face_names, study.groups[0].face_names);
  ASSERT_EQ(back->groups[0].floods.size(), 1u);
  EXPECT_EQ(back->groups[0].floods[0].point, Vec<3>(1, 2, 3));
  EXPECT_EQ(back->groups[0].floods[0].angle, 0.5);
  EXPECT_EQ(back->groups[0].rate, 1500);
  EXPECT_FALSE(back->groups[0].pressure.has_value());
  EXPECT_EQ(back->groups[1].pressure, 20);
  EXPECT_TRUE(back->bodies.at(0).flow);
  EXPECT_FALSE(back->bodies.at(1).flow);
  EXPECT_EQ(back->flow, study.flow);
  ASSERT_EQ(back->cuts.size(), 1u);
  EXPECT_EQ(back->cuts[0].name, "middle");
  EXPECT_EQ(back->cuts[0].origin, study.cuts[0].origin);
  EXPECT_LT((back->cuts[0].normal - study.cuts[0].normal).norm(), 1e-15);
  EXPECT_FALSE(back->cuts[0].on);
  ASSERT_EQ(back->bodies.size(), 2u);
  EXPECT_EQ(back->bodies[0].name, "cover");
  EXPECT_EQ(back->bodies[0].layers, 6);
  EXPECT_EQ(back->bodies[0].alpha, 0.5);
  EXPECT_EQ(back->bodies[0].h_min, 0.01);
  EXPECT_EQ(back->bodies[0].h_max, 3.5);
  EXPECT_FALSE(back->bodies[0].visible);
  EXPECT_EQ(back->bodies[0].role, BodyRole::insert);
  EXPECT_EQ(back->bodies[1].role, BodyRole::none);
  EXPECT_FALSE(back->bodies[1].h_min.has_value());
  EXPECT_FALSE(back->bodies[0].layers2.has_value());
  EXPECT_EQ(back->bodies[1].layers2, 5);
  EXPECT_EQ(back->bodies[1].alpha2, 9.5);
  EXPECT_EQ(back->bodies[1].layers3, 2);
  EXPECT_EQ(back->options.chord_tolerance, 0.02);
  EXPECT_EQ(back->options.angle_tolerance, 0.2);
  EXPECT_EQ(back->options.iterations, 9);
  EXPECT_EQ(back->options.threads, 3);
  EXPECT_EQ(back->options.seed, 12345678901234567890u);
  EXPECT_EQ(back->options.detector, Detector::neighborhood);
  EXPECT_EQ(back->options.max_anisotropy, 12.5);
  EXPECT_TRUE(back->options.progressive);
  EXPECT_EQ(back->options.memory, study.options.memory);
  EXPECT_FALSE(back->options.until_settled);
  EXPECT_EQ(study_to_json(*back), study_to_json(study));
}

TEST(StudyFile, SavingKeepsWhatWasThereAsABackup) {
  const test::TemporaryFolder folder;
  Study study = full_study();
  ASSERT_TRUE(save_study(study, folder / "s.lamella"));
  EXPECT_FALSE(std::filesystem::exists(folder / "s.lamella.bak"));
  const std::string first = study_to_json(study);
  study.options.iterations = 2;
  ASSERT_TRUE(save_study(study, folder / "s.lamella"));
  EXPECT_EQ(*read_file(folder / "s.lamella.bak"), first);
  EXPECT_EQ(*read_file(folder / "s.lamella"), study_to_json(study));
  EXPECT_FALSE(save_study(study, folder / "nowhere" / "s.lamella"));
}

/// One object of each shape and each thing to ask.
Study sized_study() {
  Study study;
  BoxShape box{{1, 2, 3}, {4, 5, 6.5}, {0, 1, 0}, {0, 0, -2}};
  FacesShape faces;
  faces.ids = {3, 0};
  faces.names = {"gate \"1\""};
  faces.depth = 0.25;
  SizeCorrection size, factor;
  size.size = 0.1;
  size.gradation = 1.7;
  factor.factor = 2.5;
  factor.keep_directions = true;
  AnalyticZone flat, tube, ball;
  flat.frame = CartesianFrame{{0, 1, 0}, {0, 0, 1}};
  flat.sizes = tube.sizes = ball.sizes = {0.1, 0.2, 0.4};
  tube.frame = CylindricalFrame{{1, 0, 0}, {1, 1, 0}};
  tube.progression = {RadialProgression::Kind::geometric, 0.5, 3, {1, 2, 3}};
  tube.replace = true;
  ball.frame = SphericalFrame{{0, 7, 0}, {1, 0, 0}};
  ball.progression = {RadialProgression::Kind::linear, 0, 2, {1, 2, 3}};
  study.sizing = {{"gate", "cover", SphereShape{{0.1, -2, 1e-7}, 0.5}, size},
                  {"all", "", WholeBody{}, factor},
                  {"plate", "", box, flat},
                  {"tube", "lid", CylinderShape{{0, 0, 0}, {0, 0, 9}, 2}, tube},
                  {"skin", "lid", faces, ball}};
  return study;
}

TEST(StudyFile, SizingObjectsReadBackAsWritten) {
  const Study study = sized_study();
  const Result<Study> back = study_from_json(study_to_json(study), "s");
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(study_to_json(*back), study_to_json(study));
  ASSERT_EQ(back->sizing.size(), 5u);
  EXPECT_EQ(back->sizing[0].body, "cover");
  EXPECT_EQ(std::get<SphereShape>(back->sizing[0].shape).center, Vec<3>(0.1, -2, 1e-7));
  EXPECT_EQ(std::get<SizeCorrection>(back->sizing[0].asks).gradation, 1.7);
  EXPECT_TRUE(std::holds_alternative<WholeBody>(back->sizing[1].shape));
  EXPECT_EQ(std::get<SizeCorrection>(back->sizing[1].asks).factor, 2.5);
  EXPECT_FALSE(std::get<SizeCorrection>(back->sizing[1].asks).size.has_value());
  EXPECT_TRUE(std::get<SizeCorrection>(back->sizing[1].asks).keep_directions);
  EXPECT_EQ(std::get<BoxShape>(back->sizing[2].shape).y_axis, Vec<3>(0, 0, -2));
  const auto& tube = std::get<AnalyticZone>(back->sizing[3].asks);
  EXPECT_EQ(std::get<CylindricalFrame>(tube.frame).axis, Vec<3>(1, 1, 0));
  EXPECT_TRUE(tube.replace);
  EXPECT_EQ(tube.progression.kind, RadialProgression::Kind::geometric);
  EXPECT_EQ(tube.progression.sizes, Vec<3>(1, 2, 3));
  const auto& faces = std::get<FacesShape>(back->sizing[4].shape);
  EXPECT_EQ(faces.ids, (std::vector<std::int32_t>{3, 0}));
  EXPECT_EQ(faces.names, std::vector<std::string>{"gate \"1\""});
  EXPECT_EQ(faces.depth, 0.25);
  EXPECT_EQ(sizing_of(*back, "lid").size(), 4u);
  EXPECT_EQ(sizing_of(*back, "cover").size(), 3u);
}

TEST(StudyFile, EveryMistakeOfASizingObjectIsNamed) {
  const std::string sphere = R"("shape": {"kind": "sphere", "center": [0, 0, 0], "radius": 1})";
  const std::string tube = R"("frame": "cylindrical", "origin": [0, 0, 0], "sizes": [1, 1, 1])";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"("size": 1)", "sizing[0].shape"},
      {sphere, "sizing[0]"},
      {sphere + R"(, "size": 1, "factor": 1)", "sizing[0]"},
      {sphere + R"(, "size": 0)", "sizing[0].size"},
      {sphere + R"(, "size": 1, "gradation": 0.9)", "sizing[0].gradation"},
      {sphere + R"(, "size": 1, "sise": 1)", "sizing[0].sise"},
      {sphere + R"(, "zone": {)" + tube + R"(}, "size": 1)", "sizing[0].size"},
      {R"("size": 1, "shape": {"kind": "ball"})", "sizing[0].shape.kind"},
      {R"("size": 1, "shape": {"kind": "sphere", "radius": 1})", "sizing[0].shape.center"},
      {R"("size": 1, "shape": {"kind": "sphere", "center": [0, 0, 0]})", "sizing[0].shape.radius"},
      {R"("size": 1, "shape": {"kind": "sphere", "center": [0, 0], "radius": 1})",
       "sizing[0].shape.center"},
      {R"("size": 1, "shape": {"kind": "box", "center": [0, 0, 0], "size": [1, 0, 1]})",
       "sizing[0].shape.size"},
      {R"("size": 1, "shape": {"kind": "faces"})", "sizing[0].shape"},
      {R"("size": 1, "shape": {"kind": "faces", "ids": [0.5]})", "sizing[0].shape.ids"},
      {R"("size": 1, "shape": {"kind": "faces", "ids": [5000000000]})", "sizing[0].shape.ids"},
      {R"("size": 1, "shape": {"kind": "faces", "names": [1]})", "sizing[0].shape.names"},
      {sphere + R"(, "zone": {"frame": "conical", "sizes": [1, 1, 1]})", "sizing[0].zone.frame"},
      {sphere + R"(, "zone": {"frame": "cartesian"})", "sizing[0].zone.sizes"},
      {sphere + R"(, "zone": {"frame": "cylindrical", "sizes": [1, 1, 1]})",
       "sizing[0].zone.origin"},
      {sphere + R"(, "zone": {)" + tube + R"(, "progression": {"kind": "cubic"}})",
       "sizing[0].zone.progression.kind"},
      {sphere + R"(, "zone": {)" + tube + R"(, "progression": {"kind": "linear", "to": 1}})",
       "sizing[0].zone.progression.sizes"}};
  for (const auto& [text, named] : cases) {
    const Result<Study> study =
        study_from_json(R"({"schema": 1, "sizing": [{)" + text + "}]}", "bad.json");
    ASSERT_FALSE(study.ok()) << text;
    EXPECT_EQ(study.error().code, Code::bad_input);
    EXPECT_NE(study.error().message.find("\"" + named + "\""), std::string::npos)
        << study.error().message;
  }
  EXPECT_FALSE(study_from_json(R"({"schema": 1, "sizing": 3})", "bad.json").ok());
}

Study zoned_study() {
  Study study;
  study.zones = {
      {"ball \"a\"", ZoneBall{{0.1, -2, 1e-7}, 0.5}}, {"mold", ZoneBox{{-1, -2, -3}, {1, 2, 3.5}}},
      {"pin", ZoneCylinder{{0, 0, 0}, {0, 3, 9}, 2}}, {"below", ZoneHalfSpace{{0, 1, -2}, -0.25}},
      {"grain 1", ZoneCell{{1, 2, 3}, ""}},           {"grain 2", ZoneCell{{3, 2, 3}, ""}},
      {"other 1", ZoneCell{{1, 2, 3}, "others"}}};
  study.bodies = {{"pin", 7}};
  return study;
}

TEST(StudyFile, ZonesAndDomainsReadBackAsWritten) {
  Study study = zoned_study();
  EXPECT_FALSE(study_from_json(study_to_json(study), "s")->domain.has_value());
  for (const StudyDomain& domain :
       {StudyDomain{DomainBodies{}}, StudyDomain{ZoneBox{{0, 1, 2}, {3, 4, 5}}},
        StudyDomain{ZoneCylinder{{0, 0, 1}, {0, 0, 9}, 3}}, StudyDomain{DomainMargin{0.25}},
        StudyDomain{DomainBody{"mold"}}}) {
    study.domain = domain;
    const Result<Study> back = study_from_json(study_to_json(study), "s");
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(back->zones, study.zones);
    EXPECT_EQ(back->domain, study.domain);
    EXPECT_EQ(study_to_json(*back), study_to_json(study));
  }
  EXPECT_EQ(settings_of(study, study.zones[2].name).layers, 7);
}

TEST(StudyFile, EveryMistakeOfAZoneIsNamed) {
  const std::string ball = R"({"name": "b", "shape": "ball", "center": [0, 0, 0], "radius": 1})";
  const std::string cell = R"("shape": "voronoi", "seed": [1, 2, 3]})";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"("zones": {})", "zones"},
      {R"("zones": [3])", "zones[0]"},
      {R"("zones": [{"shape": "ball", "center": [0, 0, 0], "radius": 1}])", "zones[0].name"},
      {R"("zones": [{"name": "b"}])", "zones[0].shape"},
      {R"("zones": [{"name": "b", "shape": "sphere"}])", "zones[0].shape"},
      {R"("zones": [{"name": "b", "shape": "ball", "radius": 1}])", "zones[0].center"},
      {R"("zones": [{"name": "b", "shape": "ball", "center": [0, 0, 0]}])", "zones[0].radius"},
      {R"("zones": [{"name": "b", "shape": "ball", "center": [0, 0], "radius": 1}])",
       "zones[0].center"},
      {R"("zones": [{"name": "b", "shape": "ball", "center": [0, 0, 0], "radius": 0}])",
       "zones[0].radius"},
      {R"("zones": [{"name": "b", "shape": "box", "low": [0, 0, 0], "high": [1, 0, 1]}])",
       "zones[0].high"},
      {R"("zones": [{"name": "b", "shape": "cylinder", "from": [1, 0, 0], "to": [1, 0, 0],
                     "radius": 1}])",
       "zones[0].to"},
      {R"("zones": [{"name": "b", "shape": "half_space", "normal": [0, 0, 0], "offset": 1}])",
       "zones[0].normal"},
      {R"("zones": [{"name": "b", "shape": "half_space", "normal": [1, 0, 0]}])",
       "zones[0].offset"},
      {R"("zones": [{"name": "b", "shape": "half_space", "normal": [1, 0, 0], "offset": "0"}])",
       "zones[0].offset"},
      {R"("zones": [{"name": "b", "shape": "voronoi"}])", "zones[0].seed"},
      {R"("zones": [{"name": "b", "shape": "voronoi", "seed": [1, 2, 3], "set": 1}])",
       "zones[0].set"},
      {R"("zones": [{"name": "b", "shape": "voronoi", "seed": [1, 2, 3], "radius": 1}])",
       "zones[0].radius"},
      {"\"zones\": [" + ball + ", " + ball + "]", "zones[1]"},
      {R"("zones": [{"name": "a", )" + cell + R"(, {"name": "b", )" + cell + "]", "zones[1]"},
      {R"("domain": "box")", "domain"},
      {R"("domain": {"shape": "ball"})", "domain.shape"},
      {R"("domain": {"shape": "box", "low": [0, 0, 0]})", "domain.high"},
      {R"("domain": {"shape": "cylinder", "from": [0, 0, 0], "to": [0, 0, 1], "radius": -1})",
       "domain.radius"},
      {R"("domain": {"shape": "margin", "share": 0})", "domain.share"},
      {R"("domain": {"shape": "body"})", "domain.body"},
      {R"("domain": {"shape": "none", "share": 1})", "domain.share"}};
  for (const auto& [text, named] : cases) {
    const Result<Study> study = study_from_json(R"({"schema": 1, )" + text + "}", "bad.json");
    ASSERT_FALSE(study.ok()) << text;
    EXPECT_EQ(study.error().code, Code::bad_input);
    EXPECT_NE(study.error().message.find("\"" + named + "\""), std::string::npos)
        << study.error().message;
  }
}

TEST(StudyFile, AFieldOfAnotherSolverReadsBackAsWritten) {
  Study study;
  StudyFlow flow;
  flow.method = FlowMethod::indicator;
  flow.h_min = 0.25;
  flow.field = StudyField{{"solved.vtu", 1000, std::string(64, 'a'), 12}, "T \"K\""};
  study.flow = flow;
  const std::string text = study_to_json(study);
  const Result<Study> back = study_from_json(text, "s");
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->flow, study.flow);
  // Another place of the same file is the same mesh, another field or unit is not.
  Study other = study;
  other.flow->field->source.file = "/elsewhere/solved.vtu";
  EXPECT_EQ(mesh_key(other), mesh_key(study));
  other.flow->field->name = "p";
  EXPECT_NE(mesh_key(other), mesh_key(study));
  // A flow as it was written before there were fields.
  const Result<Study> old = study_from_json(
      R"({"schema": 2, "flow": {"method": "strain", "strength": 2, "viscosity": 3}})", "s");
  ASSERT_TRUE(old.ok()) << old.error().message;
  EXPECT_EQ(old->flow->method, FlowMethod::strain);
  EXPECT_FALSE(old->flow->field.has_value());
  study.flow->field.reset();
  study.flow->h_min.reset();
  study.flow->method = FlowMethod::strain;
  EXPECT_EQ(study_to_json(study).find("field"), std::string::npos)
      << "what older versions do not know is not written without need";
}

TEST(StudyFile, EveryMistakeOfAFieldIsNamed) {
  const auto complaint = [](const std::string& flow) {
    const Result<Study> read = study_from_json(R"({"schema": 2, "flow": )" + flow + "}", "s");
    return read ? std::string() : read.error().message;
  };
  const std::string file = R"("file": "a.vtu")", name = R"("name": "T")";
  EXPECT_EQ(complaint(R"({"field": {)" + file + ", " + name + "}}"), "");
  for (const auto& [flow, member] : std::vector<std::pair<std::string, std::string>>{
           {R"({"field": {)" + name + "}}", "flow.field.file"},
           {R"({"field": {)" + file + "}}", "flow.field.name"},
           {R"({"field": {"unit": 0, )" + file + ", " + name + "}}", "flow.field.unit"},
           {R"({"field": {"x": 0, )" + file + ", " + name + "}}", "flow.field.x"},
           {R"({"field": "a.vtu"})", "flow.field"},
           {R"({"method": "residual", "field": {)" + file + ", " + name + "}}", "flow.method"},
           {R"({"method": "field"})", "flow.method"},
           {R"({"h_min": 0})", "flow.h_min"}})
    EXPECT_NE(complaint(flow).find(member), std::string::npos) << flow << complaint(flow);
}

TEST(StudyFile, LeftOutMeansDefault) {
  const Result<Study> study = study_from_json(R"({"schema": 1, "bodies": [{"name": "a"}]})", "s");
  ASSERT_TRUE(study.ok());
  EXPECT_EQ(study->bodies.at(0).layers, BodySettings{}.layers);
  EXPECT_EQ(study->options.iterations, StudyOptions{}.iterations);
  EXPECT_EQ(study->options.detector, Detector::geometric);
}

TEST(StudyFile, EveryMistakeIsNamed) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "JSON"},
      {"{\"schema\": 1", "JSON"},
      {"[]", "schema"},
      {R"({"schema": 3})", "newer"},
      {R"({"schema": 4294967297})", "newer"},
      {R"({"schema": 18446744073709551615})", "newer"},
      {R"({"schema": 0})", "no schema 0"},
      {R"({"schema": -1})", "no schema -1"},
      {R"({"schema": 2, "inputs": [{"file": "a.stl", "sha256": "abc"}]})", "inputs[0].sha256"},
      {R"({"schema": 1, "bodys": []})", "bodys"},
      {R"({"schema": 1, "inputs": [1]})", "inputs"},
      {R"({"schema": 1, "bodies": [{"layers": 4}]})", "bodies[0].name"},
      {R"({"schema": 1, "bodies": [{"name": "a", "layers": 0}]})", "bodies[0].layers"},
      {R"({"schema": 1, "bodies": [{"name": "a", "layers": 2.5}]})", "bodies[0].layers"},
      {R"({"schema": 1, "bodies": [{"name": "a", "h_min": -1}]})", "bodies[0].h_min"},
      {R"({"schema": 1, "bodies": [{"name": "a", "role": "screw"}]})", "bodies[0].role"},
      {R"({"schema": 1, "options": {"iterations": "six"}})", "options.iterations"},
      {R"({"schema": 1, "options": {"detector": "radar"}})", "options.detector"},
      {R"({"schema": 1, "options": {"tolerance": 1}})", "options.tolerance"},
      {R"({"schema": 1, "unit": "inch"})", "unit"}};
  for (const auto& [text, named] : cases) {
    const Result<Study> study = study_from_json(text, "bad.json");
    ASSERT_FALSE(study.ok()) << text;
    EXPECT_EQ(study.error().code, Code::bad_input);
    EXPECT_NE(study.error().message.find(named), std::string::npos) << study.error().message;
    EXPECT_NE(study.error().message.find("bad.json"), std::string::npos);
  }
}

TEST(Settings, APartWithoutAnEntryGetsTheDefaults) {
  const Study study = full_study();
  EXPECT_EQ(settings_of(study, "cover").layers, 6);
  EXPECT_EQ(settings_of(study, "other").layers, BodySettings{}.layers);
  EXPECT_EQ(settings_of(study, "other").name, "other");
}

}  // namespace
}  // namespace lamella
