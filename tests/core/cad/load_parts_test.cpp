#include "core/cad/load_parts.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/base/atomic_file.h"
#include "core/geometry/self_intersection.h"
#include "core/geometry/soup.h"
#include "core/io/stl.h"
#include "tests/support/soups.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

const std::filesystem::path kReal = LAMELLA_REAL_PARTS;

std::filesystem::path put(const test::TemporaryFolder& folder, const std::string& name,
                          const std::string& bytes) {
  std::ofstream(folder / name, std::ios::binary) << bytes;
  return folder / name;
}

Error refusal(const std::filesystem::path& file, const LoadParams& params = {}) {
  const auto parts = load_parts(file, params);
  EXPECT_FALSE(parts.ok()) << file;
  if (parts.ok()) return {};
  EXPECT_FALSE(parts.error().hint.empty()) << parts.error().message;
  EXPECT_NE(parts.error().message.find(file.filename().string()), std::string::npos)
      << parts.error().message;
  return parts.error();
}

bool says(const Error& e, const std::string& word) {
  return e.message.find(word) != std::string::npos;
}

struct RealPart {
  const char* file;
  std::size_t solids;
  double volume;      // mm^3, of MANIFEST.tsv
  std::size_t faces;  // of all solids
};

void PrintTo(const RealPart& part, std::ostream* out) { *out << part.file; }

class RealStep : public testing::TestWithParam<RealPart> {};

TEST_P(RealStep, IsWatertightAndKeepsItsVolume) {
  const RealPart& expected = GetParam();
  const auto file = kReal / expected.file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "missing " << file;
  const auto parts = load_parts(file);
  ASSERT_TRUE(parts.ok()) << parts.error().message;
  EXPECT_EQ(parts->size(), expected.solids);
  double volume = 0;
  std::size_t faces = 0;
  for (const Part& part : *parts) {
    const auto& s = part.surface;
    EXPECT_FALSE(part.name.empty());
    EXPECT_TRUE(check_closed(s).ok());
    EXPECT_EQ(find_self_intersections(s).pairs, 0);
    EXPECT_EQ(s.facet_face.size(), s.facets.size());
    EXPECT_GT(part.chord_error, 0);
    EXPECT_NEAR(enclosed_measure(s), part.cad_volume, 3e-3 * part.cad_volume) << part.name;
    // A corner lies on a feature.
    std::vector<int> uses(s.points.size());
    for (const auto& e : s.feature_edges) {
      ++uses[e[0]];
      ++uses[e[1]];
    }
    for (const std::int32_t c : s.corners) EXPECT_GT(uses[c], 0);
    for (std::size_t v = 0; v < uses.size(); ++v) {
      if (uses[v] == 0 || uses[v] == 2) continue;
      EXPECT_TRUE(
          std::binary_search(s.corners.begin(), s.corners.end(), static_cast<std::int32_t>(v)))
          << part.name << " vertex " << v;
    }
    volume += part.cad_volume;
    faces += s.faces.size();
  }
  EXPECT_NEAR(volume, expected.volume, 1e-3 * expected.volume);
  EXPECT_EQ(faces, expected.faces);
}

INSTANTIATE_TEST_SUITE_P(
    Parts, RealStep,
    testing::Values(RealPart{"prusa_mini_fsensor_cover.stp", 1, 4106.8, 61},
                    RealPart{"fan_duct_hotend_mount.step", 1, 9053.3, 102},
                    RealPart{"base_interface_ap203_inch.step", 1, 1.258e6, 30},
                    RealPart{"base_interface_ap214_inch.step", 1, 1.258e6, 30},
                    RealPart{"featuretype_inch.step", 1, 1.9053e5, 96},
                    RealPart{"nist_ctc_03_asme1_ap242-e2.stp", 1, 3.3212e5, 120},
                    RealPart{"nist_ftc_07_asme1_ap242-e2.stp", 1, 1.7266e6, 304},
                    RealPart{"lego_3xaa_battery_case.step", 5, 35885, 600},
                    RealPart{"jst_xh_s4b_header.step", 1, 278.25, 165},
                    RealPart{"prusa_mini_display_box.stp", 1, 24951, 183},
                    RealPart{"desktop_top_cover.stp", 1, 41278, 492},
                    RealPart{"vhb_din_mount.step", 1, 2687.1, 152}),
    [](const auto& each) {
      std::string name = std::filesystem::path(each.param.file).stem().string();
      std::replace_if(
          name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
      return name;
    });

TEST(LoadParts, NamesColorsAndPlacesOfAnAssembly) {
  const auto file = kReal / "lego_3xaa_battery_case.step";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "missing " << file;
  const auto parts = load_parts(file);
  ASSERT_TRUE(parts.ok());
  std::vector<std::string> names;
  for (const Part& part : *parts) {
    names.push_back(part.name);
    EXPECT_GE(part.color[0], 0) << part.name;
  }
  EXPECT_EQ(names, (std::vector<std::string>{"Bottom Tubes", "Bottom Cover", "Case", "Top Studs",
                                             "3xAA-BC3AAW v7"}));
}

TEST(LoadParts, SewsLooseFaces) {
  const auto loose = kReal / "din_rail_adapter_loose_faces.step";
  if (!std::filesystem::exists(loose)) GTEST_SKIP() << "missing " << loose;
  const Inspection found = inspect_parts(loose);
  ASSERT_TRUE(found.parts.ok()) << found.parts.error().message;
  EXPECT_EQ(found.diagnosis.free_faces + found.diagnosis.free_shells, 63);
  ASSERT_EQ(found.parts->size(), 1);
  EXPECT_NEAR((*found.parts)[0].cad_volume, 5368.1, 1e-3 * 5368.1);
  EXPECT_TRUE(check_closed((*found.parts)[0].surface).ok());
  bool told = false;
  for (const std::string& note : (*found.parts)[0].notes)
    told = told || note.find("63 loose faces sewn") != std::string::npos;
  EXPECT_TRUE(told);

  LoadParams strict;
  strict.repair = Repair::none;
  EXPECT_TRUE(says(refusal(loose, strict), "no solid"));
}

TEST(LoadParts, WrapsWhatSmallRepairsDoNotClose) {
  const auto teapot = kReal / "utah_teapot.stl";
  if (!std::filesystem::exists(teapot)) GTEST_SKIP() << "missing " << teapot;
  const Inspection found = inspect_parts(teapot);
  ASSERT_TRUE(found.parts.ok()) << found.parts.error().message;
  std::size_t open = 0;
  for (const Diagnosis& d : found.diagnosis.bodies) open += d.open_edges.count;
  EXPECT_EQ(open, 64);
  for (const Part& part : *found.parts) {
    EXPECT_TRUE(check_closed(part.surface).ok());
    EXPECT_EQ(find_self_intersections(part.surface).pairs, 0);
  }
  bool told = false;
  for (const std::string& note : (*found.parts)[0].notes)
    told = told || note.find("Wrapped: within") != std::string::npos;
  EXPECT_TRUE(told);
}

TEST(LoadParts, RefusesTruncatedStep) {
  const auto file = kReal / "prusa_mini_fsensor_cover.stp";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "missing " << file;
  const std::string text = *read_file(file);
  const test::TemporaryFolder folder;
  for (const double share : {0.1, 0.5, 0.9, 0.999}) {
    const auto cut =
        put(folder, "cut.step",
            text.substr(0, static_cast<std::size_t>(share * static_cast<double>(text.size()))));
    EXPECT_TRUE(says(refusal(cut), "truncated")) << share;
  }
  // The middle is missing: entities refer to what is not there.
  const auto holed =
      put(folder, "holed.step", text.substr(0, text.size() / 3) + text.substr(text.size() / 2));
  EXPECT_EQ(refusal(holed).code, Code::bad_input);
}

TEST(LoadParts, RefusesWhatIsNoPart) {
  const test::TemporaryFolder folder;
  for (const std::string extension : {".step", ".STP", ".stl"}) {
    EXPECT_EQ(refusal(folder / ("missing" + extension)).code, Code::io);
    EXPECT_TRUE(says(refusal(put(folder, "empty" + extension, "")), "empty"));
  }
  EXPECT_TRUE(
      says(refusal(put(folder, "text.step", "Dear reader, this is a letter.")), "not a STEP file"));
  EXPECT_TRUE(says(refusal(put(folder, "void.step",
                               "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\n"
                               "END-ISO-10303-21;\n")),
                   "void.step"));
  EXPECT_TRUE(says(refusal(put(folder, "part.doc", "x")), "'.doc'"));
  LoadParams params;
  params.chord_tolerance = 0;
  const auto parts = load_parts(folder / "x.step", params);
  ASSERT_FALSE(parts.ok());
  EXPECT_EQ(parts.error().code, Code::usage);
}

TEST(LoadParts, RefusesBadStl) {
  const test::TemporaryFolder folder;
  const auto write = [&](const std::string& name, const test::Soup& soup) {
    std::string text = "solid\n";
    for (const auto& facet : soup) {
      text += "facet normal 0 0 0\nouter loop\n";
      for (const Vec<3>& p : facet) {
        text += "vertex " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " +
                std::to_string(p[2]) + "\n";
      }
      text += "endloop\nendfacet\n";
    }
    return put(folder, name, text + "endsolid\n");
  };
  test::Soup open = test::unit_box();
  open.pop_back();
  const auto strict = [&](const std::filesystem::path& file) {
    LoadParams params;
    params.repair = Repair::none;
    const auto parts = load_parts(file, params);
    EXPECT_FALSE(parts.ok());
    return parts.ok() ? Error{} : parts.error();
  };
  EXPECT_TRUE(says(strict(write("open.stl", open)), "3 open edges"));
  EXPECT_TRUE(says(strict(write("touching.stl", test::both(test::unit_box(),
                                                           test::box_soup({1, 1, 0}, {2, 2, 1})))),
                   "not manifold"));
  // Nothing encloses a volume here: no repair helps, and the hole tells more than that.
  EXPECT_TRUE(says(refusal(write("flat.stl", {test::unit_box()[0]})), "3 open edges"));
}

TEST(LoadParts, ReadsBodiesOfAnStlInItsUnit) {
  const test::TemporaryFolder folder;
  auto surface = surface_from_soup(
      test::both(test::turned(test::unit_box()), test::box_soup({3, 0, 0}, {5, 2, 2})));
  ASSERT_TRUE(surface.ok());
  const auto file = folder / "two.stl";
  ASSERT_TRUE(write_stl(*surface, file).ok());
  LoadParams params;
  params.unit = 25.4;
  const auto parts = load_parts(file, params);
  ASSERT_TRUE(parts.ok()) << parts.error().message;
  ASSERT_EQ(parts->size(), 2);
  EXPECT_EQ((*parts)[0].name, "two 1");
  EXPECT_EQ((*parts)[1].name, "two 2");
  const double inch3 = 25.4 * 25.4 * 25.4;
  EXPECT_NEAR((*parts)[0].cad_volume, 8 * inch3, 1e-9 * inch3);
  EXPECT_NEAR((*parts)[1].cad_volume, inch3, 1e-9 * inch3);
  ASSERT_FALSE((*parts)[0].notes.empty());
  EXPECT_NE((*parts)[0].notes[0].find("25.4 mm"), std::string::npos);
}

TEST(LoadParts, TellsOfBodiesThatCrossEachOther) {
  const test::TemporaryFolder folder;
  const auto told = [&](const std::string& name, const test::Soup& soup) {
    const auto file = folder / name;
    EXPECT_TRUE(write_stl(surface_from_soup(soup).value(), file).ok());
    const auto parts = load_parts(file, {});
    EXPECT_TRUE(parts.ok() && parts->size() == 2);
    bool found = false;
    for (const std::string& note : (*parts)[0].notes)
      found = found || note.find("cross each other") != note.npos;
    return found;
  };
  EXPECT_TRUE(told("through.stl",
                   test::both(test::unit_box(), test::box_soup({-1, .25, .25}, {2, .75, .75}))));
  EXPECT_FALSE(
      told("apart.stl", test::both(test::unit_box(), test::box_soup({2, 0, 0}, {3, 1, 1}))));
}

TEST(LoadParts, CancelReturnsCancelled) {
  const auto file = kReal / "prusa_mini_fsensor_cover.stp";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "missing " << file;
  std::stop_source before;
  before.request_stop();
  auto parts = load_parts(file, {}, Progress({}, before.get_token()));
  ASSERT_FALSE(parts.ok());
  EXPECT_EQ(parts.error().code, Code::cancelled);

  std::stop_source during;
  double last = 0;
  const Progress progress(
      [&](double fraction, std::string_view) {
        EXPECT_GE(fraction, last);
        last = fraction;
        if (fraction > 0.2) during.request_stop();
      },
      during.get_token());
  parts = load_parts(file, {}, progress);
  ASSERT_FALSE(parts.ok());
  EXPECT_EQ(parts.error().code, Code::cancelled);
}

}  // namespace
}  // namespace lamella
