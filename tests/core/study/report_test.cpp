#include "core/study/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/atomic_file.h"
#include "core/study/join.h"
#include "core/study/study_file.h"
#include "tests/support/box_mesh.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

/// A box of unit cubes in the unit metric, with the books of a run of three iterations.
Outcome some_outcome() {
  auto state = std::make_shared<MeshState>();
  state->mesh = test::box_mesh(6, 5, 4);
  state->mesh.bodies = {"cover <A&B>"};
  const std::size_t n = state->mesh.points.size();
  state->metric.assign(n, Metric<3>::Identity());
  state->thickness.assign(n, 4.0);
  for (std::size_t v = 0; v < n; ++v)
    state->layers.push_back(v % 3 ? 4 + 0.1 * static_cast<double>(v % 9) : std::nan(""));
  Outcome outcome;
  for (int i = 0; i < 3; ++i) {
    IterationRecord r;
    r.iteration = i;
    r.nodes = static_cast<std::size_t>(100 * (i + 1));
    r.layers = {2.0 + i, 1.5 + i, 1.9 + i, 0.5, 80};
    outcome.records.push_back(r);
  }
  MeshState measured = *state;
  outcome.state = state;
  BodyOutcome body;
  body.name = "cover <A&B>";
  body.layers_asked = 4;
  body.first_mesh_by = "algorithm 2.1";
  body.cad_volume = 119.9;
  body.mesh_volume = 120;
  body.boundary_distance = {{0.004, {1, 2, 3}}, {0.003, {4, 5, 6}}};
  body.chord_tolerance = 0.01;
  body.layers = outcome.records.back().layers;
  body.records = outcome.records;
  body.notes = {"unit inch: lengths were converted"};
  outcome.bodies = {body};
  const double c = 1.0 / 3;
  auto filled = std::make_shared<MeshState>(measured);
  filled->quality.assign(filled->mesh.elements.size(), c);
  outcome.state = filled;
  StudyOverlaps overlaps{{"cover <A&B>", "pin"}, {}};
  overlaps.report.overlaps = {{0, 1, 2.5, 0.01, {1, 2, 3}, 0.25, 1}};
  overlaps.report.gaps = {{0, 1, 0.5, 0.02, 0.06, 0.04, {4, 5, 6}}};
  outcome.overlaps = overlaps;
  return outcome;
}

Report some_report() {
  Study study;
  study.name = "tray";
  ReportContext context;
  context.inputs = {{"tray.step", 1234, std::string(64, 'a')}};
  context.command = "lamella-cli mesh tray.step -n 4 -o tray.msh";
  context.exports.push_back(certify("tray.msh", "Gmsh MSH 4.1",
                                    summarize(some_outcome().state->mesh),
                                    summarize(some_outcome().state->mesh)));
  return build_report(study, some_outcome(), context).value();
}

TEST(Report, MeasuresTheMeshItself) {
  const Report report = some_report();
  EXPECT_TRUE(report.validity.valid()) << report.validity.first_finding;
  EXPECT_NEAR(report.validity.volume, 120, 1e-9);
  EXPECT_EQ(report.final_record.nodes, 7u * 6u * 5u);
  EXPECT_EQ(report.final_record.elements, 720u);
  // A Kuhn tetrahedron of the unit cube: longest edge sqrt 3, smallest height 1/sqrt 2.
  EXPECT_NEAR(report.fitness.aspect.max, std::sqrt(1.5) * std::sqrt(3.0) * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(report.fitness.aspect_over_50, 0);
  std::size_t counted = 0;
  for (const std::size_t n : report.quality.counts) counted += n;
  EXPECT_EQ(counted, 720u);
}

TEST(Report, JsonCarriesWhatProgramsNeed) {
  const auto json = nlohmann::json::parse(report_json(some_report()));
  EXPECT_EQ(json["mesh"]["elements"], 720);
  EXPECT_EQ(json["mesh"]["inverted"], 0);
  EXPECT_EQ(json["bodies"][0]["layers_asked"], 4);
  EXPECT_EQ(json["bodies"][0]["layers"]["p5"], 3.5);
  EXPECT_EQ(json["bodies"][0]["first_mesh_by"], "algorithm 2.1");
  EXPECT_EQ(json["inputs"][0]["sha256"], std::string(64, 'a'));
  EXPECT_EQ(json["records"].size(), 3u);
  EXPECT_EQ(json["exports"][0]["agrees"], true);
  EXPECT_EQ(json["study"]["schema"], kStudySchema);
}

TEST(Report, JsonTellsOverlapsAndGaps) {
  const auto json = nlohmann::json::parse(report_json(some_report()))["overlaps"];
  EXPECT_EQ(json["overlaps"][0]["bodies"], (std::vector<std::string>{"cover <A&B>", "pin"}));
  EXPECT_EQ(json["overlaps"][0]["depth"], 0.25);
  EXPECT_EQ(json["overlaps"][0]["inner"], "pin");
  EXPECT_EQ(json["gaps"][0]["least_width"], 0.04);
}

TEST(Report, TheRunCanBeReadFromItAgain) {
  Outcome before = some_outcome();
  before.converged = true;
  before.seconds = 12.5;
  before.bodies[0].below = {{{1, 2, 3}, 2.5, 0.75}};
  const Result<Outcome> back = outcome_from_json(report_json(build_report({}, before, {}).value()));
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_TRUE(back->converged && !back->cancelled && !back->state);
  EXPECT_EQ(back->seconds, 12.5);
  ASSERT_EQ(back->records.size(), 3u);
  EXPECT_EQ(back->records[2].nodes, 300u);
  EXPECT_EQ(back->records[2].layers.p5, 3.5);
  ASSERT_EQ(back->bodies.size(), 1u);
  const BodyOutcome& body = back->bodies[0];
  EXPECT_EQ(body.name, "cover <A&B>");
  EXPECT_EQ(body.boundary_distance.from_surface.place, Vec<3>(4, 5, 6));
  EXPECT_EQ(body.below[0].area, 0.75);
  EXPECT_EQ(body.notes, before.bodies[0].notes);
  EXPECT_EQ(body.records.size(), 3u);
  EXPECT_EQ(outcome_from_json("{}").error().code, Code::bad_input);
  EXPECT_EQ(outcome_from_json("no JSON").error().code, Code::bad_input);
}

TEST(Report, HtmlIsOneSafeSelfContainedPage) {
  const std::string html = report_html(some_report());
  EXPECT_NE(html.find("cover &lt;A&amp;B&gt;"), std::string::npos);
  EXPECT_EQ(html.find("<A&B>"), std::string::npos);
  // Nothing is loaded from elsewhere.
  EXPECT_EQ(html.find("http"), std::string::npos);
  EXPECT_EQ(html.find("<script"), std::string::npos);
  // The layers map and two sections.
  int pictures = 0;
  for (auto at = html.find("data:image/png;base64,iVBORw0KGgo"); at != std::string::npos;
       at = html.find("data:image/png;base64,iVBORw0KGgo", at + 1))
    ++pictures;
  EXPECT_EQ(pictures, 3);
  EXPECT_NE(html.find("pin lies wholly in the other"), std::string::npos);
  EXPECT_NE(html.find("gap between"), std::string::npos);
  EXPECT_NE(html.find(std::string(64, 'a')), std::string::npos);
  EXPECT_NE(html.find("lamella-cli mesh tray.step -n 4 -o tray.msh"), std::string::npos);
  for (const std::string tag : {"svg", "table", "p", "div", "h2", "tr", "td", "main"}) {
    const auto count = [&](const std::string& what) {
      int n = 0;
      for (auto at = html.find(what); at != std::string::npos; at = html.find(what, at + 1)) ++n;
      return n;
    };
    EXPECT_EQ(count("<" + tag + ">") + count("<" + tag + " "), count("</" + tag + ">")) << tag;
  }
}

TEST(Report, FilesAppearTogetherBesideTheMesh) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_report(some_report(), folder / "tray.report").ok());
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"tray.report.html", "tray.report.json"}));
}

TEST(Provenance, NamesBodiesGroupsAndInputs) {
  Study study;
  const Outcome outcome = some_outcome();
  const auto json = nlohmann::json::parse(
      provenance_json(study, outcome.state->mesh, {{"a.stl", 3, std::string(64, 'b')}}));
  EXPECT_EQ(json["bodies"][0]["name"], "cover <A&B>");
  EXPECT_EQ(json["bodies"][0]["layers"], 4);
  EXPECT_EQ(json["groups"][1]["name"], "gate");
  EXPECT_EQ(json["inputs"][0]["sha256"], std::string(64, 'b'));
}

TEST(Inputs, AreNamedByTheirContent) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_file(folder / "a.stl", "abc").ok());
  const Result<InputFile> input = describe_input(folder / "a.stl");
  ASSERT_TRUE(input.ok());
  EXPECT_EQ(input->bytes, 3u);
  EXPECT_EQ(input->sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(HistogramOfReport, CountsEveryValueOnceAndNoNan) {
  Histogram h(0, 1, 4);
  for (const double v : {-1.0, 0.0, 0.24, 0.25, 0.99, 1.0, 7.0, std::nan("")}) h.add(v);
  EXPECT_EQ(h.counts, (std::vector<std::size_t>{3, 1, 0, 3}));
}

}  // namespace
}  // namespace lamella
