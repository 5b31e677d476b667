#include <signal.h>

#include <map>

#include "core/io/export_certificate.h"
#include "core/io/medit.h"
#include "core/io/msh.h"
#include "core/mesh/sample_meshes.h"
#include "core/mesh/validate.h"
#include "tests/support/cli_fixture.h"

namespace lamella {
namespace {

TEST_F(Cli, HelpAndVersionAreNoErrors) {
  EXPECT_EQ(run("--help"), 0);
  for (const std::string name : {"mesh", "adapt", "generate", "check", "info", "sample", "case",
                                 "box", "slice", "flow", "130"})
    EXPECT_NE(out.find(name), std::string::npos) << name;
  EXPECT_EQ(run("mesh --help"), 0);
  EXPECT_NE(out.find("--chord-tolerance"), std::string::npos);
  EXPECT_EQ(run("--version"), 0);
  EXPECT_NE(out.find("Lamella "), std::string::npos);
}

TEST_F(Cli, WrongUsageIsStatus2AndWritesNothing) {
  for (const std::string arguments :
       {"",
        "frobnicate",
        "mesh",
        "mesh a.step",
        "mesh a.step -n 0 -o b.msh",
        "mesh a.step -n four -o b.msh",
        "mesh a.step --no-such-option -o b.msh",
        "mesh a.step -o b.xyz",
        "mesh a.step -o no/such/folder/b.msh",
        "mesh a.step -o",
        "mesh a.step --unit furlong -o b.msh",
        "mesh a.step --detector radar -o b.msh",
        "mesh a.step --layers2 0 -o b.msh",
        "mesh a.step --alpha2 -1 -o b.msh",
        "mesh a.step --layers3 none -o b.msh",
        "mesh a.step --forecast -o b.msh",
        "mesh a.step --size-sphere 0,0,0,1 -o b.msh",
        "mesh a.step --size-sphere 0,0,zero,1,1 -o b.msh",
        "mesh a.step --size-box 0,0,0,1,1,1 -o b.msh",
        "mesh a.step --size-cylinder 0,0,0,0,0,1,1,1y -o b.msh",
        "mesh a.step --size-face 3 -o b.msh",
        "mesh a.step --size-face box:3,x -o b.msh",
        "adapt a.mesh --field size --metric uniform -o b.mesh",
        "adapt a.mesh --sol a.sol --metric uniform -o b.mesh",
        "adapt a.mesh --metric uniform --background -o b.mesh",
        "adapt a.mesh --metric uniform --mean median -o b.mesh",
        "adapt a.mesh --metric uniform --gradation-kind isotropic -o b.mesh",
        "adapt a.mesh --metric uniform --max-anisotropy 0.5 -o b.mesh",
        "adapt a.mesh --metric uniform --memory -1 -o b.mesh",
        "sample no_such_part",
        "check a.mesh --layers 0",
        "case marbles",
        "case inclusions --fraction 0.1 --count 3",
        "case inclusions --grains 3",
        "case inclusions --radius 1,2,3",
        "case fibers --orientation 1,0",
        "case two-balls --size 1,1,1",
        "case polycrystal --size 1,1",
        "case tilted-plate --angle steep",
        "box -o a.mesh",
        "box --cells 0 -o a.mesh",
        "box --cells 2,2 -o a.mesh",
        "box --dimension 5 --cells 1 -o a.mesh",
        "box --cells 1 --low 1 -o a.mesh",
        "box --cells 1000 -o a.mesh",
        "box --cells 2 -o a.xyz",
        "box --dimension 4 --cells 2 -o a.vtu",
        "slice a.mesh -o b.vtu",
        "slice a.mesh --times x -o b.vtu"}) {
    EXPECT_EQ(run(arguments), 2) << arguments << "\n" << err;
    EXPECT_FALSE(err.empty()) << arguments;
  }
  EXPECT_EQ(folder.names(), Names{});
}

TEST_F(Cli, BadInputsAreStatus3WithOneSentenceAndLeaveNothing) {
  write("empty.step", "");
  write("empty.stl", "");
  write("garbage.step", "this is no part at all\n");
  write("garbage.stl", "this is no part at all\n");
  const std::string box = box_stl(10, 10, 1);
  write("truncated.stl", box.substr(0, box.size() / 2));
  write("nothing.stl", "solid nothing\nendsolid nothing\n");
  write("empty.json", "");
  write("lost.json", R"({"schema": 1, "inputs": ["nowhere.step"]})");
  const Names before = folder.names();
  for (const std::string name :
       {"missing.step", "missing.stl", "empty.step", "empty.stl", "garbage.step", "garbage.stl",
        "truncated.stl", "nothing.stl", "empty.json", "lost.json", "missing.json"}) {
    EXPECT_EQ(run("mesh " + name + " -o out.msh"), 3) << name << ": " << err;
    const std::string named = name == "lost.json" ? "nowhere.step" : name;
    EXPECT_NE(err.find(named), std::string::npos) << err;
    if (name.find("json") == std::string::npos) {
      EXPECT_EQ(run("info --json " + name), 3) << name;
      EXPECT_EQ(lines().at(0)["status"], 3);
      EXPECT_EQ(run("generate " + name + " -o out.mesh"), 3) << name;
    }
  }
  EXPECT_EQ(folder.names(), before);
}

TEST_F(Cli, FacetsWoundInwardAreTurned) {
  std::string text = box_stl(10, 10, 1);
  write("outward.stl", text);
  const std::string loop = "outer loop\n", end = "endloop";
  for (std::size_t at = 0; (at = text.find(loop, at)) != text.npos;) {
    at += loop.size();
    const std::size_t second = text.find("vertex", at + 1);
    const std::size_t third = text.find("vertex", second + 1);
    const std::size_t last = text.find(end, third);
    const std::string turned = text.substr(third, last - third) +
                               text.substr(second, third - second) + text.substr(at, second - at);
    text.replace(at, last - at, turned);
  }
  write("inward.stl", text);
  for (const std::string name : {"outward", "inward"}) {
    ASSERT_EQ(run("generate --json " + name + ".stl -o " + name + ".mesh"), 0) << err;
    bool generated = false;
    for (const json& line : lines()) {
      if (line["phase"] != "generated") continue;
      generated = true;
      EXPECT_NEAR(line["volume"].get<double>(), 100, 1e-6) << name;
      EXPECT_NEAR(line["cad_volume"].get<double>(), 100, 1e-6) << name;
    }
    EXPECT_TRUE(generated) << out;
  }
}

TEST_F(Cli, BadMeshesAreStatus3) {
  write("empty.mesh", "");
  write("garbage.msh", "garbage");
  write("garbage.vtu", "garbage");
  write("noending", "x");
  for (const std::string name :
       {"missing.mesh", "empty.mesh", "garbage.msh", "garbage.vtu", "noending"}) {
    EXPECT_EQ(run("check " + name), 3) << name;
    EXPECT_NE(err.find(name), std::string::npos) << err;
    EXPECT_EQ(run("adapt " + name + " --metric uniform -o out.mesh"), 3) << name;
  }
  SimplexMesh<3> inverted = unit_box<3>(2);
  inverted.points[14] += Vec<3>(1.5, 0, 0);
  ASSERT_TRUE(write_medit<3>(inverted, folder / "inverted.mesh").ok());
  EXPECT_EQ(run("check inverted.mesh"), 3);
}

TEST_F(Cli, DetectorAndSeveralThicknessesAreTakenAndWrittenDown) {
  ASSERT_EQ(run("sample wedge -o w.step"), 0) << err;
  const auto nodes = [&](const std::string& options) {
    const int status = run("mesh w.step -n 2 --iterations 1 --json -o w.mesh " + options);
    EXPECT_TRUE(status == 0 || status == 4) << err;
    for (const json& line : lines())
      if (line["phase"] == "done") return line["nodes"].get<int>();
    ADD_FAILURE() << err;
    return 0;
  };
  const int by_default = nodes("");
  EXPECT_EQ(nodes("--detector geometric"), by_default);
  const auto study = [&] {
    const Result<std::string> report = read_file(folder / "w.report.json");
    EXPECT_TRUE(report.ok());
    return json::parse(report.ok() ? *report : "{}")["study"];
  };
  EXPECT_NE(nodes("--detector neighborhood"), by_default);
  EXPECT_EQ(study()["options"]["detector"], "neighborhood");
  EXPECT_GT(nodes("--layers2 8 --alpha2 20 --layers3 9 --progressive"), by_default);
  EXPECT_EQ(study()["bodies"][0]["layers2"], 8);
  EXPECT_EQ(study()["bodies"][0]["alpha2"], 20);
  EXPECT_EQ(study()["bodies"][0]["layers3"], 9);
  EXPECT_EQ(study()["options"]["progressive"], true);
}

TEST_F(Cli, AnOpenBoxIsDiagnosedAndRepairedOnlyIfAllowed) {
  const std::string box = box_stl(10, 10, 1);
  write("open.stl", box.substr(0, box.rfind("facet normal")) + "endsolid box\n");
  ASSERT_EQ(run("info --json --repair none open.stl"), 3) << err;
  EXPECT_EQ(lines().at(0)["bodies"][0]["open_edges"]["count"], 3);
  EXPECT_EQ(lines().at(0)["bodies"][0]["open_edges"]["places"].size(), 3);
  EXPECT_EQ(lines().at(0)["bodies"][0]["sound"], false);
  EXPECT_NE(err.find("3 open edges"), std::string::npos) << err;
  ASSERT_EQ(run("info --json --wrap-spacing 0.2 open.stl"), 0) << err;
  const json wrap = lines().at(1), body = lines().at(2);
  EXPECT_EQ(wrap["phase"], "wrap");
  EXPECT_EQ(wrap["bodies"], json::array({"open"}));
  EXPECT_NEAR(wrap["spacing"], 0.2, 0.02);
  // Both ways, and no farther than a cell; the farther one is what the body is accurate to.
  const double to = wrap["to_file"]["distance"], from = wrap["from_file"]["distance"];
  EXPECT_LT(std::max(to, from), wrap["spacing"].get<double>());
  EXPECT_NEAR(body["chord_error"], std::max(to, from), 1e-9);
  EXPECT_GT(wrap["bridged"], 0);
  EXPECT_EQ(body["phase"], "body");
  EXPECT_NE(body["notes"].dump().find("Wrapped: within"), std::string::npos);
}

TEST_F(Cli, APlateGetsItsLayersAndEveryFileAgrees) {
  ASSERT_EQ(run("sample plate -o plate.step"), 0) << err;
  ASSERT_EQ(run("info plate.step --json"), 0) << err;
  EXPECT_EQ(lines().at(0)["phase"], "diagnosis");
  const double volume = lines().at(1)["volume"];
  ASSERT_EQ(run("mesh plate.step -n 4 --json -o p.msh -o p.vtu -o p.mesh"), 0) << err;

  const std::vector<json> told = lines();
  EXPECT_EQ(told.front()["phase"], "body");
  const json& done = told.back();
  ASSERT_EQ(done["phase"], "done");
  EXPECT_EQ(done["converged"], true);
  EXPECT_EQ(done["valid"], true);
  EXPECT_NEAR(done["bodies"][0]["mesh_volume"], volume, 5e-3 * volume);
  EXPECT_GE(done["bodies"][0]["layers_mean"], 4);
  EXPECT_LE(done["bodies"][0]["boundary_distance"], done["bodies"][0]["chord_tolerance"]);
  EXPECT_EQ(folder.names(),
            (Names{"p.mesh", "p.mesh.json", "p.msh", "p.msh.json", "p.report.html", "p.report.json",
                   "p.sol", "p.vtu", "plate.step", "plate.study.json"}));

  const Result<MeshContent> back = read_msh(folder / "p.msh");
  ASSERT_TRUE(back.ok());
  EXPECT_TRUE(validate<3>(back->mesh).ok());
  EXPECT_EQ(back->mesh.groups, Names{"walls"});
  const json report = json::parse(read_file(folder / "p.report.json").value());
  EXPECT_EQ(report["exports"].size(), 3u);
  EXPECT_NE(report["command"].get<std::string>().find("mesh plate.step -n 4"), std::string::npos);

  for (const std::string name : {"p.msh", "p.vtu"}) {
    ASSERT_EQ(run("check " + name + " --layers 4 --json"), 0) << name << err;
    EXPECT_EQ(lines().at(0)["elements"], done["elements"]);
    EXPECT_NEAR(lines().at(0)["quality"]["min"], done["quality_min"], 1e-9);
  }
  ASSERT_EQ(run("check p.mesh --sol p.sol --json"), 0) << err;
  EXPECT_NEAR(lines().at(0)["quality"]["min"], done["quality_min"], 1e-9);
  EXPECT_EQ(run("check p.msh --min-quality 0.999"), 5);
  EXPECT_EQ(run("check p.msh --layers 200"), 4);
}

// Each iteration starts on the boundary the one before has left: what must not add up is its error.
TEST_F(Cli, ManyIterationsStayAtTheBoundaryTheyWereGiven) {
  ASSERT_EQ(run("sample t_junction -o t.step"), 0) << err;
  ASSERT_EQ(run("mesh t.step -n 2 -o t.mesh"), 0) << err;
  for (const std::string tolerance : {"0.05", "0.2"}) {
    ASSERT_EQ(run("adapt t.mesh --metric uniform:h=3 --iterations 5 --chord-tolerance " +
                  tolerance + " -o coarse.msh --json"),
              0)
        << err;
    const std::vector<json> told = lines();
    const auto boundary = std::find_if(told.begin(), told.end(),
                                       [](const json& j) { return j["phase"] == "boundary"; });
    ASSERT_NE(boundary, told.end());
    EXPECT_LE((*boundary)["boundary_to_given"]["distance"], std::stod(tolerance));
    EXPECT_LE((*boundary)["given_to_boundary"]["distance"], std::stod(tolerance));
  }
  // The metric that is read is not written over.
  const std::string before = read_file(folder / "t.sol").value();
  std::filesystem::copy_file(folder / "t.sol", folder / "out.sol");
  EXPECT_EQ(run("adapt t.mesh --sol out.sol -o out.mesh"), 2);
  EXPECT_EQ(read_file(folder / "out.sol").value(), before);
}

TEST_F(Cli, AStudySaysTheSameAsTheCommandLine) {
  std::filesystem::create_directory(folder / "parts");
  write("parts/box.stl", box_stl(12, 10, 1));
  write("study.json",
        R"({"schema": 1, "name": "s", "inputs": ["parts/box.stl"],
            "bodies": [{"name": "box", "layers": 2}], "options": {"iterations": 3, "seed": 5}})");
  const int by_study = run("mesh study.json -o a.msh");
  const int by_line = run("mesh parts/box.stl -n 2 --iterations 3 --seed 5 -o b.msh");
  EXPECT_EQ(by_study, by_line);
  EXPECT_EQ(read_file(folder / "a.msh").value(), read_file(folder / "b.msh").value());
}

TEST_F(Cli, GroupsGoIntoEveryFileWithTheirNamesAndAreas) {
  write("box.stl", box_stl(12, 10, 1));
  ASSERT_EQ(run("info box.stl --faces --json"), 0) << err;
  std::string top;
  for (const json& line : lines())
    if (line["phase"] == "face" && line["point"][2] > 0.99) top = std::to_string(int(line["id"]));
  ASSERT_FALSE(top.empty());
  const std::string asked = "mesh box.stl -n 2 --iterations 1 --group gate=box:" + top +
                            " --group 'cold side=0,5,0.5~0.3' ";
  const int status = run(asked + "-o g.msh -o g.vtu -o g.mesh");
  ASSERT_TRUE(status == 0 || status == 4) << err;
  const auto areas = [](const SimplexMesh<3>& mesh) {
    std::map<std::string, double> found;
    for (const NamedMeasure& group : summarize(mesh).groups) found[group.name] = group.measure;
    return found;
  };
  const Result<MeshContent> msh = read_msh(folder / "g.msh");
  ASSERT_TRUE(msh) << msh.error().message;
  auto area = areas(msh->mesh);
  ASSERT_EQ(area.size(), 3u);
  EXPECT_NEAR(area["gate"], 120, 120e-9);
  EXPECT_NEAR(area["cold side"], 10, 10e-9);
  EXPECT_NEAR(area["walls"], 120 + 10 + 2 * 12, 154e-9);
  // Every file was read back and compared with the mesh; the report has what was found.
  const json report = json::parse(read_file(folder / "g.report.json").value());
  ASSERT_EQ(report["exports"].size(), 3u);
  // Medit has references only: the names are beside it, with what they are to a simulation.
  const json sidecar = json::parse(read_file(folder / "g.mesh.json").value());
  std::map<std::string, json> groups;
  for (const json& group : sidecar["groups"]) groups[group["name"]] = group;
  EXPECT_EQ(groups["gate"]["kind"], "gate");
  EXPECT_EQ(groups["cold side"]["kind"], "other");
  EXPECT_FALSE(groups["walls"].contains("kind"));

  EXPECT_EQ(run("mesh box.stl --group gate=lid:1 -o x.msh"), 2);
  EXPECT_NE(err.find("lid"), std::string::npos) << err;
  EXPECT_EQ(run("mesh box.stl --group gate=box:99 -o x.msh"), 2);
  EXPECT_EQ(run("mesh box.stl --group gate -o x.msh"), 2);
  EXPECT_EQ(run("mesh box.stl --group gate=1,2~0.3 -o x.msh"), 2);
}

TEST_F(Cli, AGateIsForecastAndRefined) {
  write("box.stl", box_stl(12, 10, 1));
  const std::string gate = " -n 2 --size-sphere 6,5,1,1,0.2 ";
  ASSERT_EQ(run("mesh box.stl" + gate + "--forecast --json"), 0) << err;
  const json told = lines().back();
  ASSERT_EQ(told["phase"], "forecast");
  EXPECT_EQ(folder.names(), Names{"box.stl"});
  EXPECT_GT(told["corrected"]["nodes"], 2 * told["natural"]["nodes"].get<double>());
  ASSERT_EQ(run("mesh box.stl" + gate + "-o gate.msh --json"), 0) << err;
  const double gated = lines().back()["nodes"];
  EXPECT_NEAR(told["corrected"]["nodes"], gated, 0.25 * gated);
  ASSERT_EQ(run("mesh box.stl -n 2 -o plain.msh --json"), 0) << err;
  const double plain = lines().back()["nodes"];
  EXPECT_NEAR(told["natural"]["nodes"], plain, 0.25 * plain);
  // The text has both lines.
  ASSERT_EQ(run("mesh box.stl" + gate + "--forecast"), 0) << err;
  EXPECT_NE(out.find("box: about"), std::string::npos) << out;
  EXPECT_NE(out.find("sizes corrected: about"), std::string::npos) << out;
}

TEST_F(Cli, AStudyAndTheCommandLineCorrectSizesAlike) {
  write("box.stl", box_stl(12, 10, 1));
  ASSERT_EQ(run("info box.stl --faces --json"), 0) << err;
  std::string top;
  for (const json& line : lines())
    if (line["phase"] == "face" && line["point"][2] > 0.99) top = std::to_string(int(line["id"]));
  ASSERT_FALSE(top.empty());
  write("study.json", R"({"schema": 1, "inputs": ["box.stl"], "bodies": [{"name": "box"}],
      "sizing": [
        {"shape": {"kind": "sphere", "center": [6, 5, 1], "radius": 1}, "factor": 0.5,
         "gradation": 2, "keep_directions": true},
        {"shape": {"kind": "box", "center": [1, 1, 0.5], "size": [2, 2, 1]}, "size": 0.3,
         "gradation": 2, "keep_directions": true},
        {"shape": {"kind": "cylinder", "from": [9, 7, 0], "to": [9, 7, 1], "radius": 0.5},
         "size": 0.2, "gradation": 2, "keep_directions": true},
        {"body": "box", "shape": {"kind": "faces", "ids": [)" +
                          top + R"(]}, "size": 0.24,
         "gradation": 2, "keep_directions": true}]})");
  ASSERT_EQ(run("mesh study.json --forecast --json"), 0) << err;
  const json by_study = lines().back();
  ASSERT_EQ(run("mesh box.stl --size-sphere 6,5,1,1,0.5x --size-box 0,0,0,2,2,1,0.3 "
                "--size-cylinder 9,7,0,9,7,1,0.5,0.2 --size-face box:" +
                top + ",0.24 --size-gradation 2 --size-keep-directions --forecast --json"),
            0)
      << err;
  EXPECT_EQ(lines().back()["corrected"], by_study["corrected"]);
  EXPECT_GT(by_study["corrected"]["nodes"], by_study["natural"]["nodes"]);
  // One body needs no name; what is not there is told.
  EXPECT_EQ(run("mesh box.stl --size-face " + top + ",0.24 --forecast"), 0) << err;
  EXPECT_EQ(run("mesh box.stl --size-face lid:0,0.24 --forecast"), 2);
  EXPECT_NE(err.find("\"lid\""), std::string::npos) << err;
  EXPECT_EQ(run("mesh box.stl --size-face box:gate,0.24 --forecast"), 2);
  EXPECT_NE(err.find("\"gate\""), std::string::npos) << err;
  EXPECT_EQ(run("mesh box.stl --size-sphere 0,0,0,-1,1 --forecast"), 2);
  EXPECT_EQ(run("mesh box.stl --size-sphere 0,0,0,1,1 --size-gradation 1 --forecast"), 2);
  write("bad.json", R"({"schema": 1, "inputs": ["box.stl"], "sizing": [{"shape": 3}]})");
  EXPECT_EQ(run("mesh bad.json --forecast"), 3);
}

TEST_F(Cli, TheMeshDoesNotDependOnTheThreads) {
  write("box.stl", box_stl(12, 10, 1));
  run("mesh box.stl -n 2 --iterations 2 --threads 1 -o one.msh");
  run("mesh box.stl -n 2 --iterations 2 --threads 2 -o two.msh");
  EXPECT_EQ(read_file(folder / "one.msh").value(), read_file(folder / "two.msh").value());
}

TEST_F(Cli, StlUnitsAreHonored) {
  write("box.stl", box_stl(1, 2, 3));
  ASSERT_EQ(run("info box.stl --unit inch --json"), 0) << err;
  const std::vector<json> told = lines();
  const auto body = std::find_if(told.begin(), told.end(),
                                 [](const json& line) { return line["phase"] == "body"; });
  ASSERT_NE(body, told.end());
  EXPECT_NEAR((*body)["volume"], 6 * 25.4 * 25.4 * 25.4, 1e-6);
}

TEST_F(Cli, GenerateTellsBeforehandThatTheMemoryWillNotDo) {
  write("box.stl", box_stl(3, 4, 5));
  EXPECT_EQ(run("generate box.stl -o box.msh --memory 0.001"), 6);
  EXPECT_NE(err.find("whose surface has 12 triangles: about 1 MB"), std::string::npos) << err;
  EXPECT_FALSE(std::filesystem::exists(folder / "box.msh"));
  EXPECT_EQ(run("generate box.stl -o box.msh --memory 100"), 0) << err;
  // Algorithm 2.1 alone: Netgen would not fit.
  EXPECT_EQ(run("generate box.stl -o box.msh --memory 0.03"), 0) << err;
  EXPECT_EQ(run("generate box.stl -o box.msh --memory 0.03 --mesher netgen"), 6);
}

TEST_F(Cli, GenerateFillsASurface) {
  write("box.stl", box_stl(3, 2, 1));
  ASSERT_EQ(run("generate box.stl -o box.mesh --json"), 0) << err;
  EXPECT_NEAR(lines().at(0)["volume"], 6, 1e-12);
  ASSERT_EQ(run("check box.mesh --json"), 0) << err;
  EXPECT_NEAR(lines().at(0)["volume"], 6, 1e-12);
  EXPECT_EQ(run("check box.mesh --min-quality 0.1"), 2);
}

TEST_F(Cli, AdaptsToAnAnalyticMetricIn2DAnd3D) {
  ASSERT_TRUE(write_medit<2>(unit_box<2>(4), folder / "square.mesh").ok());
  ASSERT_EQ(run("adapt square.mesh --metric uniform:h=0.1 -o a.mesh --json"), 0) << err;
  EXPECT_GT(lines().at(2)["unit_edges"], 0.9);
  EXPECT_NEAR(lines().at(2)["volume"], 1, 1e-9);
  // The nodal metric goes along and gives the same figures.
  const double mean = lines().at(2)["quality"]["mean"];
  ASSERT_EQ(run("check a.mesh --sol a.sol --json"), 0) << err;
  EXPECT_NEAR(lines().at(0)["quality"]["mean"], mean, 1e-9);
  ASSERT_EQ(run("adapt a.mesh --sol a.sol --iterations 1 -o b.mesh"), 0) << err;

  ASSERT_TRUE(write_medit<3>(unit_box<3>(3), folder / "cube.mesh").ok());
  ASSERT_EQ(run("adapt cube.mesh --metric constaniso:hx=0.1,hy=0.3,hz=0.3 -o c.msh --json"), 0)
      << err;
  EXPECT_GT(lines().at(2)["unit_edges"], 0.8);
  EXPECT_NEAR(lines().at(2)["volume"], 1, 1e-9);
  EXPECT_EQ(run("adapt cube.mesh --metric nonsense -o d.mesh"), 2);
}

TEST_F(Cli, AnAdaptionIsBoundedAndTellsWhatTheBoundsDid) {
  ASSERT_TRUE(write_medit<2>(unit_box<2>(4), folder / "square.mesh").ok());
  // A bound that holds everywhere is the metric itself.
  ASSERT_EQ(run("adapt square.mesh --metric uniform:h=0.1 -o a.mesh"), 0) << err;
  ASSERT_EQ(run("adapt square.mesh --metric uniform:h=5 --h-max 0.1 -o b.mesh --json"), 0) << err;
  EXPECT_EQ(read_file(folder / "a.mesh").value(), read_file(folder / "b.mesh").value());
  const json told = lines().at(0);
  EXPECT_EQ(told["phase"], "conditioning");
  EXPECT_EQ(told["steps"].at(0)["step"], "h_max");
  EXPECT_EQ(told["steps"].at(0)["nodes"], 25);
  EXPECT_NEAR(told["steps"].at(0)["size_largest"], 50, 1e-6);
  EXPECT_NEAR(told["steps"].at(0)["anisotropy_lost"], 1, 1e-9);
  EXPECT_NEAR(told["elements_after"], 4 / std::sqrt(3.0) / 0.01, 1e-6);
  EXPECT_TRUE(lines().at(1)["adaption"].contains("splits"));

  // As many elements as asked, and 20 to 1 cut to 4 to 1.
  ASSERT_EQ(run("adapt square.mesh --metric constaniso:hx=0.02,hy=0.4 --max-anisotropy 4 "
                "--elements 600 -o c.mesh --json"),
            0)
      << err;
  const json last = lines().at(5);
  EXPECT_NEAR(last["elements"], 600, 120);  // as if all were equilateral
  EXPECT_GT(last["unit_edges"], 0.9);
  const auto field = read_sol<2>(folder / "c.sol", last["nodes"]).value();
  EXPECT_NEAR(sizes<2>(field[1])[1], 4 * sizes<2>(field[1])[0], 1e-6);

  // A size jump of 40 at the nodes, once by each kind, is bounded on the way.
  MetricField<2> jump(26, isotropic_metric<2>(0.4));
  jump[13] = isotropic_metric<2>(0.01);
  ASSERT_TRUE(write_sol<2>(jump, folder / "square.sol").ok());
  for (const std::string kind : {"isotropic", "intersection"}) {
    ASSERT_EQ(run("adapt square.mesh --sol square.sol --gradation 1.5 --gradation-kind " + kind +
                  " --iterations 1 -o d.mesh --json"),
              0)
        << err;
    const json step = lines().at(0)["steps"].at(0);
    EXPECT_EQ(step["step"], "gradation");
    EXPECT_EQ(step["settled"], true);
    EXPECT_EQ(step["nodes"], 22);  // two corners are 1 away: .01 + ln 1.5 is above 0.4
    EXPECT_GT(step["elements_after"], step["elements_before"]);
  }
  EXPECT_EQ(run("adapt square.mesh --metric uniform --gradation 1 -o d.mesh"), 2);
  EXPECT_EQ(run("adapt square.mesh --metric uniform --h-min 1 --h-max 0.5 -o d.mesh"), 2);
  // The text says the same as the JSON.
  ASSERT_EQ(run("adapt square.mesh --metric uniform:h=5 --h-max 0.1 -o b.mesh"), 0);
  EXPECT_NE(out.find("h_max"), std::string::npos);
  EXPECT_NE(out.find("sweeps"), std::string::npos);
}

TEST_F(Cli, AGradationOfAnAnalyticMetricReachesEveryPlaceOfIt) {
  // The layer of h = 0.01 lies between the nodes of the first mesh.
  ASSERT_TRUE(write_medit<2>(box_mesh<2>({5, 5}, {0, 0}, {7, 9}), folder / "box.mesh").ok());
  ASSERT_EQ(run("adapt box.mesh --metric gb2d --gradation 1.3 --iterations 6 -o a.mesh --json"), 0)
      << err;
  const json graded = lines().at(11);  // after the conditioning and figures of five others
  ASSERT_EQ(graded["phase"], "iteration");
  EXPECT_GT(graded["unit_edges"], 0.9);
  ASSERT_EQ(run("adapt box.mesh --metric gb2d --iterations 6 -o b.mesh --json"), 0) << err;
  EXPECT_GT(graded["elements"].get<double>(), 1.2 * lines().at(5)["elements"].get<double>());
}

TEST_F(Cli, ABackgroundMetricIsNotBlurredFromPassToPass) {
  const SimplexMesh<2> mesh = unit_box<2>(20);
  ASSERT_TRUE(write_medit<2>(mesh, folder / "square.mesh").ok());
  const auto size = [](const Vec<2>& x) { return 0.01 + 0.2 * std::abs(x[0] - 0.5); };
  MetricField<2> field(mesh.points.size(), Metric<2>::Identity());
  for (std::size_t n = 1; n < field.size(); ++n)
    field[n] = metric_from_sizes<2>(Mat<2>::Identity(), {size(mesh.points[n]), 0.2});
  ASSERT_TRUE(write_sol<2>(field, folder / "square.sol").ok());
  ASSERT_EQ(run("adapt square.mesh --sol square.sol -o a.mesh --iterations 4"), 0) << err;
  ASSERT_EQ(run("adapt square.mesh --sol square.sol --background -o b.mesh --iterations 4"), 0);
  ASSERT_EQ(run("adapt square.mesh --sol square.sol --no-background -o c.mesh --iterations 4"), 0);
  EXPECT_EQ(read_file(folder / "a.mesh").value(), read_file(folder / "b.mesh").value());
  EXPECT_NE(read_file(folder / "a.mesh").value(), read_file(folder / "c.mesh").value());
  const auto adapted = read_medit<2>(folder / "a.mesh").value();
  const auto kept = read_sol<2>(folder / "a.sol", adapted.node_count()).value();
  // Sizes are linear between the nodes of the background, so they are met at any place.
  for (std::size_t n = 1; n < kept.size(); ++n) {
    EXPECT_NEAR(size_from_eigenvalue(kept[n](0, 0)), size(adapted.points[n]), 1e-9);
    EXPECT_NEAR(size_from_eigenvalue(kept[n](1, 1)), 0.2, 1e-9);
  }
}

TEST_F(Cli, EveryMeanAdapts) {
  ASSERT_TRUE(write_medit<2>(unit_box<2>(4), folder / "square.mesh").ok());
  for (const std::string mean : {"m", "root", "size", "log", "h"})
    for (const std::string average : {"l2", "l1"}) {
      ASSERT_EQ(run("adapt square.mesh --metric uniform:h=0.1 --mean " + mean + " --element-mean " +
                    mean + " --size-average " + average + " --sweeps 20 --json -o a.mesh"),
                0)
          << err;
      EXPECT_GT(lines().at(2)["unit_edges"], 0.9) << mean << average;
    }
}

TEST_F(Cli, UnknownGroupsAndBodiesAreToldWithTheKnownOnes) {
  SimplexMesh<3> box = two_body_box<3>(2);
  box.bodies = {"core", "shell"};
  box.groups = {"walls", "gate"};
  box.facet_group[3] = 1;
  ASSERT_TRUE(write_msh(box, {}, folder / "box.msh").ok());
  EXPECT_EQ(run("adapt box.msh --metric uniform --freeze-group walls --freeze-group lid -o a.msh"),
            2);
  EXPECT_NE(err.find("\"lid\""), std::string::npos) << err;
  EXPECT_NE(err.find("\"walls\", \"gate\""), std::string::npos) << err;
  EXPECT_EQ(run("adapt box.msh --metric uniform --freeze-body inlay -o a.msh"), 2);
  EXPECT_NE(err.find("\"core\", \"shell\""), std::string::npos) << err;
  EXPECT_EQ(folder.names(), Names{"box.msh"});
}

TEST_F(Cli, AnAdaptionDoesNotDependOnTheThreads) {
  ASSERT_TRUE(write_medit<3>(unit_box<3>(4), folder / "cube.mesh").ok());
  for (const std::string n : {"1", "2"})
    ASSERT_EQ(run("adapt cube.mesh --metric linear:h0=0.05 --gradation 1.5 --elements 4000 "
                  "--iterations 2 --threads " +
                  n + " -o " + n + ".msh"),
              0)
        << err;
  EXPECT_EQ(read_file(folder / "1.msh").value(), read_file(folder / "2.msh").value());
}

TEST_F(Cli, ACancelledAdaptionWritesItsMesh) {
  ASSERT_TRUE(write_medit<3>(unit_box<3>(4), folder / "cube.mesh").ok());
  FILE* pipe =
      start("adapt cube.mesh --metric uniform:h=0.08 --iterations 1000 --json -o adapted.mesh");
  char line[65536];
  ASSERT_NE(std::fgets(line, sizeof line, pipe), nullptr);
  const auto pid = static_cast<pid_t>(std::stol(line));
  ASSERT_NE(std::fgets(line, sizeof line, pipe), nullptr);
  EXPECT_NE(std::string(line).find("\"iteration\":1"), std::string::npos) << line;
  ::kill(pid, SIGINT);
  EXPECT_EQ(finish(pipe), 130) << err;
  const auto mesh = read_medit<3>(folder / "adapted.mesh");
  ASSERT_TRUE(mesh.ok());
  EXPECT_TRUE(validate<3>(*mesh).ok());
  EXPECT_GT(mesh->node_count(), 1000u);
  EXPECT_TRUE(read_sol<3>(folder / "adapted.sol", mesh->node_count()).ok());
}

TEST_F(Cli, BoxesAreMadeInEveryDimension) {
  ASSERT_EQ(run("box --dimension 2 --cells 3,4 --low -1 --high 1,3 -o a.mesh"), 0) << err;
  ASSERT_EQ(run("box --cells 2 -o b.vtu"), 0) << err;
  ASSERT_EQ(run("box --dimension 4 --cells 2,2,2,4 --high 1,1,1,2 -o c.mesh --json"), 0) << err;
  EXPECT_EQ(lines().at(0)["elements"], 24 * 2 * 2 * 2 * 4);
  for (const auto& [name, dimension, volume, boundary] :
       {std::tuple{"a.mesh", 2, 8.0, 12.0}, {"b.vtu", 3, 1.0, 6.0}, {"c.mesh", 4, 2.0, 14.0}}) {
    ASSERT_EQ(run(std::string("check ") + name + " --json"), 0) << err;
    const json report = lines().at(0);
    EXPECT_EQ(report["dimension"], dimension);
    EXPECT_EQ(report["valid"], true);
    EXPECT_NEAR(report["volume"], volume, 1e-12);
    EXPECT_NEAR(report["boundary_area"], boundary, 1e-12);
  }
  // The sides are groups.
  const auto box = read_medit<4>(folder / "c.mesh");
  ASSERT_TRUE(box.ok());
  EXPECT_EQ(box->groups.size(), 8u);
}

TEST_F(Cli, AHypercubeIsAdaptedCheckedAndSliced) {
  ASSERT_EQ(run("box --dimension 4 --cells 1 -o cube.mesh"), 0) << err;
  ASSERT_EQ(run("adapt cube.mesh --metric uniform:h=0.5 --iterations 2 -o a.mesh --json"), 0)
      << err;
  const json adapted = lines().at(1);
  EXPECT_EQ(adapted["valid"], true);
  EXPECT_NEAR(adapted["volume"], 1, 1e-9);
  EXPECT_GT(adapted["unit_edges"], 0.8);
  ASSERT_EQ(run("check a.mesh --sol a.sol --json"), 0) << err;
  EXPECT_NEAR(lines().at(0)["quality"]["min"], adapted["quality"]["min"], 1e-9);
  ASSERT_EQ(run("check a.mesh --metric tesseract-linear --json"), 0) << err;
  EXPECT_EQ(run("check a.mesh --metric polar-1"), 2);

  // The first and the last time go through nodes.
  ASSERT_EQ(run("slice a.mesh --sol a.sol --times 0,0.3,1 -o at.vtu --json"), 0) << err;
  const std::vector<json> told = lines();
  ASSERT_EQ(told.size(), 4u);
  for (int i = 0; i < 3; ++i) {
    const std::string file = "at_000" + std::to_string(i) + ".vtu";
    EXPECT_EQ(told[i]["file"], file);
    EXPECT_NEAR(told[i]["volume"], 1, 1e-9);
    EXPECT_NEAR(told[i]["boundary_area"], 6, 1e-9);
    ASSERT_EQ(run("check " + file + " --json"), 0) << err;
    const json report = lines().at(0);
    EXPECT_EQ(report["valid"], true);
    EXPECT_EQ(report["elements"], told[i]["elements"]);
    EXPECT_TRUE(report.contains("quality")) << "the metric goes along";
  }
  const std::string series = read_file(folder / "at.pvd").value();
  EXPECT_NE(series.find("timestep=\"0.3\" part=\"0\" file=\"at_0001.vtu\""), std::string::npos)
      << series;

  // Medit has no names: the groups of both ends, which a slice has no facets of, are not missed.
  ASSERT_EQ(run("slice cube.mesh --times 0.5 --metric uniform -o b.mesh"), 0) << err;
  const auto solid = read_medit<3>(folder / "b_0000.mesh");
  ASSERT_TRUE(solid.ok());
  EXPECT_EQ(solid->groups, (Names{"ref 1", "ref 2", "ref 3", "ref 4", "ref 5", "ref 6"}));
  EXPECT_TRUE(std::filesystem::exists(folder / "b_0000.sol"));

  // A plane through a 3D mesh.
  ASSERT_EQ(run("box --cells 2 -o solid.mesh"), 0) << err;
  ASSERT_EQ(run("slice solid.mesh --times 0.3 -o plane.mesh"), 0) << err;
  ASSERT_EQ(run("check plane_0000.mesh --json"), 0) << err;
  EXPECT_EQ(lines().at(0)["dimension"], 2);
  EXPECT_NEAR(lines().at(0)["volume"], 1, 1e-12);
}

TEST_F(Cli, SlicesThatFailLeaveNothing) {
  ASSERT_EQ(run("box --dimension 4 --cells 1 -o cube.mesh"), 0) << err;
  ASSERT_EQ(run("box --dimension 2 --cells 1 -o flat.mesh"), 0) << err;
  write("garbage.mesh", "garbage");
  const Names before = folder.names();
  EXPECT_EQ(run("slice cube.mesh --times 0.5,7 -o at.vtu"), 2);
  EXPECT_NE(err.find("from 0 to 1"), std::string::npos) << err;
  EXPECT_EQ(run("slice cube.mesh --times 0.5,7 --metric uniform -o at.mesh"), 2);
  EXPECT_EQ(run("slice cube.mesh --times 0.5 --metric linear -o at.vtu"), 2);
  EXPECT_EQ(run("slice cube.mesh --times 0.5 -o at.stl"), 2);
  EXPECT_EQ(run("slice flat.mesh --times 0.5 -o at.vtu"), 2);
  EXPECT_EQ(run("slice cube.mesh --times 0.5 --sol no.sol -o at.vtu"), 3);
  EXPECT_EQ(run("slice garbage.mesh --times 0.5 -o at.vtu"), 3);
  EXPECT_EQ(run("slice missing.mesh --times 0.5 -o at.vtu"), 3);
  EXPECT_EQ(folder.names(), before);
}

TEST_F(Cli, ASampleBringsAStudyOfAllItsBodies) {
  ASSERT_EQ(run("sample twisted_tube -o s.step"), 0) << err;
  const json study = json::parse(read_file(folder / "s.study.json").value());
  EXPECT_EQ(study["bodies"].size(), 2u);
  ASSERT_EQ(run("sample plate -o plate.step"), 0) << err;
  ASSERT_EQ(run("mesh plate.study.json -o p.msh"), 0) << err;
  EXPECT_TRUE(read_msh(folder / "p.msh").ok());
}

TEST_F(Cli, CtrlCWritesTheBestMeshAndNothingElse) {
  ASSERT_EQ(run("sample t_junction -o t.step"), 0) << err;
  FILE* pipe = start("mesh t.step -n 6 --iterations 1000 --json -o t.msh");
  char line[65536];
  ASSERT_NE(std::fgets(line, sizeof line, pipe), nullptr);
  const auto pid = static_cast<pid_t>(std::stol(line));
  bool adapted = false;
  while (!adapted && std::fgets(line, sizeof line, pipe))
    adapted = std::string(line).find("\"iteration\":1") != std::string::npos;
  EXPECT_TRUE(adapted);
  ::kill(pid, SIGINT);
  EXPECT_EQ(finish(pipe), 130) << err;
  EXPECT_EQ(folder.names(), (Names{"t.msh", "t.msh.json", "t.report.html", "t.report.json",
                                   "t.step", "t.study.json"}));
  EXPECT_TRUE(read_msh(folder / "t.msh").ok());
}

}  // namespace
}  // namespace lamella
