#include "core/io/stl.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "core/geometry/soup.h"
#include "tests/support/soups.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

const std::filesystem::path kReal = LAMELLA_REAL_PARTS;

class Folder : public test::TemporaryFolder {
 public:
  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(*this / name, std::ios::binary) << bytes;
    return *this / name;
  }
};

std::string binary_box(const std::string& header) {
  std::string bytes(80, ' ');
  std::memcpy(bytes.data(), header.data(), header.size());
  const test::Soup soup = test::unit_box();
  const auto count = static_cast<std::uint32_t>(soup.size());
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  for (const auto& facet : soup) {
    bytes.append(12, '\0');
    for (const Vec<3>& p : facet) {
      const Eigen::Vector3f single = p.cast<float>();
      bytes.append(reinterpret_cast<const char*>(single.data()), 12);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string ascii_box() {
  std::string text = "solid a name, with facet and vertex in it\n";
  for (const auto& facet : test::unit_box()) {
    text += "  facet normal 0 0 0\r\n    outer loop\r\n";
    for (const Vec<3>& p : facet) {
      text += "      vertex " + std::to_string(p[0]) + " +" + std::to_string(p[1]) + "\t" +
              std::to_string(p[2]) + "e+00\n";
    }
    text += "    ENDLOOP\n  endfacet\n";
  }
  return text + "endsolid a name\n";
}

Error refusal(const std::filesystem::path& file) {
  const auto soup = read_stl(file);
  EXPECT_FALSE(soup.ok()) << file;
  if (soup.ok()) return {};
  EXPECT_FALSE(soup.error().hint.empty());
  EXPECT_NE(soup.error().message.find(file.filename().string()), std::string::npos);
  return soup.error();
}

bool says(const Error& e, const std::string& word) {
  return e.message.find(word) != std::string::npos;
}

TEST(Stl, ReadsAsciiAndBinaryAlike) {
  const Folder folder;
  const auto ascii = read_stl(folder.write("a.stl", ascii_box()));
  const auto binary = read_stl(folder.write("b.stl", binary_box("a part")));
  ASSERT_TRUE(ascii.ok()) << ascii.error().message;
  ASSERT_TRUE(binary.ok()) << binary.error().message;
  EXPECT_EQ(*ascii, test::unit_box());
  EXPECT_EQ(*binary, test::unit_box());
}

TEST(Stl, ByteCountDecidesOverASolidHeader) {
  const Folder folder;
  const auto soup = read_stl(folder.write("solid.stl", binary_box("solid facet vertex")));
  ASSERT_TRUE(soup.ok()) << soup.error().message;
  EXPECT_EQ(*soup, test::unit_box());
}

TEST(Stl, RefusesWhatIsNotThere) {
  const Folder folder;
  EXPECT_EQ(refusal(folder.path() / "missing.stl").code, Code::io);
  EXPECT_EQ(refusal(folder.path()).code, Code::io);
}

TEST(Stl, RefusesEmptyFiles) {
  const Folder folder;
  EXPECT_TRUE(says(refusal(folder.write("none.stl", "")), "empty"));
  EXPECT_TRUE(says(refusal(folder.write("no_facet.stl", "solid x\nendsolid x\n")), "no facet"));
  EXPECT_TRUE(says(refusal(folder.write("zero.stl", std::string(84, '\0'))), "no facet"));
}

TEST(Stl, RefusesTruncatedFiles) {
  const Folder folder;
  const std::string binary = binary_box("solid");
  for (const std::size_t bytes : {std::size_t{84}, std::size_t{100}, binary.size() - 1}) {
    const Error e = refusal(folder.write("cut.stl", binary.substr(0, bytes)));
    EXPECT_EQ(e.code, Code::bad_input);
    EXPECT_TRUE(says(e, "truncated")) << bytes << ": " << e.message;
  }
  const std::string ascii = ascii_box();
  for (const double part : {0.3, 0.5, 0.77, 0.98}) {
    const auto bytes = static_cast<std::size_t>(part * static_cast<double>(ascii.size()));
    EXPECT_EQ(refusal(folder.write("cut.stl", ascii.substr(0, bytes))).code, Code::bad_input);
  }
}

TEST(Stl, RefusesOtherFiles) {
  const Folder folder;
  EXPECT_TRUE(says(refusal(folder.write("s.stl", "ISO-10303-21; HEADER; " + std::string(200, 'x'))),
                   "not an STL"));
  EXPECT_TRUE(says(refusal(folder.write("tiny.stl", std::string("\x01\x02", 2))), "not an STL"));
  EXPECT_TRUE(says(refusal(folder.write("zip.stl", std::string(500, '\xff'))), "not an STL"));
  EXPECT_TRUE(
      says(refusal(folder.write("long.stl", binary_box("") + std::string(7, '\0'))), "not an STL"));
  EXPECT_TRUE(says(
      refusal(folder.write("word.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0\n")),
      "zero is no coordinate"));
}

TEST(Stl, CancelsBeforeTheFirstFacet) {
  const Folder folder;
  std::stop_source stop;
  stop.request_stop();
  const Progress progress([](double, std::string_view) {}, stop.get_token());
  for (const std::string& bytes : {ascii_box(), binary_box("")}) {
    const auto soup = read_stl(folder.write("box.stl", bytes), progress);
    ASSERT_FALSE(soup.ok());
    EXPECT_EQ(soup.error().code, Code::cancelled);
  }
}

TEST(Stl, WritesWhatItReads) {
  const Folder folder;
  auto surface = surface_from_soup(test::box_soup({0, 0, 0}, {4, 2, 1}));
  ASSERT_TRUE(surface.ok());
  const auto file = folder.path() / "box.stl";
  ASSERT_TRUE(write_stl(*surface, file).ok());
  const auto soup = read_stl(file);
  ASSERT_TRUE(soup.ok());
  EXPECT_EQ(*soup, test::box_soup({0, 0, 0}, {4, 2, 1}));
  // Nothing is left behind, neither beside the file nor where writing fails.
  EXPECT_EQ(folder.names(), std::vector<std::string>{"box.stl"});
  const auto failure = write_stl(*surface, folder.path() / "no folder" / "box.stl");
  ASSERT_FALSE(failure.ok());
  EXPECT_EQ(failure.error().code, Code::io);
}

TEST(Stl, ReadsTheFacetsOfRealParts) {
  // The number of triangles of MANIFEST.tsv; the first three begin with "solid" or nearly so.
  const std::pair<const char*, std::size_t> expected[] = {
      {"m5_unit_env_housing.stl", 10860},         {"mark2_audio_chamber_cracks.stl", 61914},
      {"featuretype_inch_cracks.stl", 3476},      {"netgen_hinge_ascii.stl", 1212},
      {"prusa_mini_cable_cover_ascii.stl", 2392}, {"fan_duct_hotend_mount.stl", 2262}};
  if (!std::filesystem::exists(kReal)) GTEST_SKIP() << "no real parts at " << kReal;
  for (const auto& [name, facets] : expected) {
    const auto soup = read_stl(kReal / name);
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    EXPECT_EQ(soup->size(), facets) << name;
  }
}

}  // namespace
}  // namespace lamella
