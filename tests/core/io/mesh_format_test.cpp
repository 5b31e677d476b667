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

TEST(OpenFoam, PatchTypesFollowTheNames) {
  EXPECT_EQ(patch_type("Gate 1"), "patch");
  EXPECT_EQ(patch_type("vents"), "patch");
  EXPECT_EQ(patch_type("symmetry"), "symmetry");
  EXPECT_EQ(patch_type("cold side"), "wall");
}

}  // namespace
}  // namespace lamella
