#include "core/io/mesh_format.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/io/open_foam.h"
#include "tests/support/format_contract.h"

namespace lamella {

namespace test {
INSTANTIATE_TEST_SUITE_P(Own, FormatContract, testing::ValuesIn(own_formats()), format_name);
}

namespace {

TEST(NamesInFile, AreAllowedDifferentAndNoLongerThanTheFormatWants) {
  const std::string longest(90, 'a');
  const std::vector<std::string> names = {
      "cold side/2", "cold_side_2", "COLD_SIDE_2", "ä|ö",        "",
      "7",           longest + "1", longest + "2", longest + "2"};
  const NameRule rule{.any = false, .marks = "_-", .longest = 40, .shared = true};
  std::vector<std::string> taken = {"gate"};
  const std::vector<std::string> found = names_in_file(names, rule, taken);
  ASSERT_EQ(found.size(), names.size());
  std::vector<std::string> folded;
  for (const std::string& name : found) {
    EXPECT_LE(name.size(), 40u);
    EXPECT_EQ(
        name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                               "_-"),
        std::string::npos)
        << name;
    EXPECT_FALSE(name.empty() || std::isdigit(static_cast<unsigned char>(name[0]))) << name;
    folded.push_back(name);
    for (char& c : folded.back()) c = static_cast<char>(std::tolower(c));
  }
  std::sort(folded.begin(), folded.end());
  EXPECT_EQ(std::adjacent_find(folded.begin(), folded.end()), folded.end());
  EXPECT_NE(names_in_file({"Gate"}, rule, taken)[0], "Gate") << "taken, in another case";
}

TEST(NamesInFile, StayAsTheyAreWhereTheFormatHoldsThem) {
  std::vector<std::string> taken;
  const std::vector<std::string> names = {"Kühlung|Kern", "cold side / 2"};
  EXPECT_EQ(names_in_file(names, {.longest = 100}, taken), names);
  // A letter of two bytes is not cut in half.
  EXPECT_EQ(names_in_file({"aaä"}, {.longest = 3}, taken)[0], "aa");
  EXPECT_EQ(names_in_file({"ref 7", "ref 3"}, {.references = true}, taken),
            (std::vector<std::string>{"ref 7", "ref 3"}));
  EXPECT_EQ(names_in_file({"ref 7", "b"}, {.references = true}, taken),
            (std::vector<std::string>{"ref 1", "ref 2"}));
}

TEST(MeshFormats, AreFoundByNameAndByEnding) {
  MeshFormats formats;
  formats.add(own_formats());
  formats.add_missing("med", ".med", "This build has no MED.");
  EXPECT_EQ((*formats.of_file("a/B.INP"))->name, "abaqus");
  EXPECT_EQ((*formats.called("msh22"))->title, "Gmsh MSH 2.2");
  const auto unknown = formats.of_file("a.xyz");
  ASSERT_FALSE(unknown.ok());
  EXPECT_EQ(unknown.error().code, Code::usage);
  EXPECT_NE(unknown.error().hint.find(".unv"), std::string::npos);
  EXPECT_NE(formats.of_file("a.med").error().message.find("This build has no MED."),
            std::string::npos);
  EXPECT_EQ(formats.called("med").error().message, "This build has no MED.");
  std::vector<std::string> endings;
  for (const MeshFormat& format : formats.all())
    endings.insert(endings.end(), format.endings.begin(), format.endings.end());
  std::sort(endings.begin(), endings.end());
  EXPECT_EQ(std::adjacent_find(endings.begin(), endings.end()), endings.end());
}

TEST(Sidecar, TellsWhatTheFormatHasNoPlaceFor) {
  const test::TemporaryFolder folder;
  const test::ThreeBodies made = test::three_bodies_of_odd_names();
  MeshFields fields = made.with_metric();
  fields.provenance = R"({"program": "x", "bodies": [{"name": "cold side / 2", "layers": 4}],
                          "inputs": [{"sha256": "abc"}]})";
  MeshFormats formats;
  formats.add(own_formats());
  ASSERT_TRUE(
      write_mesh_file(**formats.called("abaqus"), made.mesh, fields, folder / "m.inp").ok());
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"m.inp", "m.inp.json", "m.inp.sol"}));
  const auto json = nlohmann::json::parse(read_file(folder / "m.inp.json").value());
  EXPECT_EQ(json["unit"], "mm");
  EXPECT_EQ(json["bodies"][0]["layers"], 4);
  EXPECT_EQ(json["bodies"][0]["name"], "cold side / 2");
  EXPECT_EQ(json["bodies"][0]["name_in_file"], "cold_side___2");
  EXPECT_EQ(json["groups"][2]["name"], "Gate");
  EXPECT_EQ(json["inputs"][0]["sha256"], "abc");
  EXPECT_EQ(json["filling"]["elements"][1], nlohmann::json({6, 0.75, 0.25, 0}));
}

TEST(Sidecar, ADamagedOneIsToldInsteadOfLosingNames) {
  const test::TemporaryFolder folder;
  const test::ThreeBodies made;
  MeshFormats formats;
  formats.add(own_formats());
  const MeshFormat& format = **formats.called("abaqus");
  ASSERT_TRUE(write_mesh_file(format, made.mesh, made.fields, folder / "m.inp").ok());
  const std::string good = read_file(folder / "m.inp.json").value();
  std::string without_bodies = good;
  without_bodies.replace(good.rfind("\"bodies\""), 8, "\"others\"");
  for (const std::string& bad : {good.substr(0, good.size() / 2), without_bodies}) {
    ASSERT_TRUE(write_file(folder / "m.inp.json", bad).ok());
    const Result<MeshContent> read = read_mesh_file(format, folder / "m.inp");
    ASSERT_FALSE(read.ok());
    EXPECT_EQ(read.error().code, Code::bad_input);
    EXPECT_NE(read.error().message.find("m.inp.json"), std::string::npos);
  }
}

/// A file of another program, read by the format of its ending.
Result<MeshContent> read_text(const test::TemporaryFolder& folder, const std::string& name,
                              const std::string& text) {
  EXPECT_TRUE(write_file(folder / name, text).ok());
  MeshFormats formats;
  formats.add(own_formats());
  return read_mesh_file(**formats.of_file(name), folder / name);
}

TEST(ForeignFiles, AbaqusWithGapsGeneratedSetsAndOtherElements) {
  const test::TemporaryFolder folder;
  const auto mesh = read_text(folder, "a.inp",
                              "*Heading\nanything\n*Node\n10, 0, 0, 0\n20, 1, 0, 0\n"
                              "30, 0, 1., 0\n40, 0, 0, 1E0\n50, 1, 1, 1\n"
                              "*Element, type=C3D4, elset=Part\n7, 10, 20, 30, 40\n"
                              "9, 20, 30, 40, 50\n*ELEMENT, TYPE=S3\n11, 10, 20, 30\n"
                              "*Elset, elset=lower, generate\n7, 7, 1\n"
                              "*Surface, type=ELEMENT, name=base\nlower, S1\n");
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->mesh.bodies, (std::vector<std::string>{"lower", "body"}));
  EXPECT_EQ(mesh->mesh.groups, (std::vector<std::string>{"base", "unnamed"}));
  EXPECT_EQ(mesh->mesh.facets.size(), 6u);
  EXPECT_EQ(summarize(mesh->mesh).groups[0].measure, 0.5);
  EXPECT_TRUE(validate<3>(mesh->mesh).ok());
}

// A set of sets must not be read from where the list of sets was before it grew.
TEST(ForeignFiles, AbaqusSetsOfSetsThatAreNotThere) {
  const test::TemporaryFolder folder;
  std::string text =
      "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT, TYPE=C3D4\n"
      "1,1,2,3,4\n*ELSET, ELSET=all\n";
  for (int i = 0; i < 40; ++i) text += "s" + std::to_string(i) + ", 1, ";
  const auto mesh = read_text(folder, "a.inp", text + "\n");
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->mesh.elements.size(), 1u);
}

TEST(ForeignFiles, NastranInEveryFieldFormatAndOrder) {
  const test::TemporaryFolder folder;
  const auto mesh =
      read_text(folder, "a.bdf",
                "SOL 101\nCEND\nBEGIN BULK\n"
                "CTETRA,1,5,1,2,3,4\n"
                "GRID,1,,0.,0.,0.\n"
                "GRID           2             1.0     0.0     0.0\n"
                "GRID*                  3"
                "                             0.0           2.5-1\n*                    0.\n"
                "GRID    4               0.      0.      1.+0\n"
                "CTRIA3  2       6       1       3       2\nENDDATA\n");
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->mesh.bodies, std::vector<std::string>{"solid 5"});
  EXPECT_EQ(mesh->mesh.groups, (std::vector<std::string>{"shell 6", "unnamed"}));
  EXPECT_NEAR(summarize(mesh->mesh).bodies[0].measure, 0.25 / 6, 1e-15);
}

TEST(ForeignFiles, UnvOfOneGroupWithPlaneTriangles) {
  const test::TemporaryFolder folder;
  std::string text = "    -1\n  2411\n";
  const char* points[] = {"0.0D+00 0.0D+00 0.0D+00", "1.0D+00 0.0D+00 0.0D+00",
                          "0.0D+00 1.0D+00 0.0D+00", "0.0D+00 0.0D+00 2.0D+00"};
  for (int i = 0; i < 4; ++i) {
    char line[120];
    std::snprintf(line, sizeof line, "%10d%10d%10d%10d\n%25.7s%25.7s%25.7s\n", 5 * i + 5, 1, 1, 11,
                  points[i], points[i] + 8, points[i] + 16);
    text += line;
  }
  text +=
      "    -1\n    -1\n  2412\n"
      "         3       111         1         1         7         4\n"
      "         5        10        15        20\n"
      "         8        41         1         1         7         3\n"
      "         5        15        10\n    -1\n    -1\n  2477\n"
      "         1         0         0         0         0         0         0         1\n"
      "the gate\n         8         8         0         0\n    -1\n";
  const auto mesh = read_text(folder, "a.unv", text);
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->mesh.groups, (std::vector<std::string>{"the gate", "unnamed"}));
  EXPECT_NEAR(summarize(mesh->mesh).bodies[0].measure, 1.0 / 3, 1e-15);
  EXPECT_TRUE(validate<3>(mesh->mesh).ok());
}

TEST(ForeignFiles, CoordinatesThatAreNoNumbersAreRefused) {
  const test::TemporaryFolder folder;
  for (const std::string bad : {"nan", "inf", "1e999", "x"}) {
    const auto mesh = read_text(folder, "a.inp",
                                "*NODE\n1,0,0,0\n2,1,0," + bad +
                                    "\n3,0,1,0\n4,0,0,1\n"
                                    "*ELEMENT, TYPE=C3D4\n1,1,2,3,4\n");
    ASSERT_FALSE(mesh.ok()) << bad;
    EXPECT_EQ(mesh.error().code, Code::bad_input);
  }
}

TEST(OpenFoam, PatchTypesFollowTheNames) {
  EXPECT_EQ(patch_type("Gate 1"), "patch");
  EXPECT_EQ(patch_type("vents"), "patch");
  EXPECT_EQ(patch_type("symmetry"), "symmetry");
  EXPECT_EQ(patch_type("cold side"), "wall");
}

}  // namespace
}  // namespace lamella
