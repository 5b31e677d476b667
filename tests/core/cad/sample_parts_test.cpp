#include "core/cad/sample_parts.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/cad/load_parts.h"
#include "core/geometry/soup.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

class EverySample : public testing::TestWithParam<std::string> {};

TEST_P(EverySample, IsWrittenAndReadBack) {
  const test::TemporaryFolder folder;
  const auto file = folder / (GetParam() + ".step");
  const auto written = write_sample(GetParam(), file);
  ASSERT_TRUE(written.ok()) << written.error().message;
  EXPECT_EQ(folder.names(), std::vector<std::string>{GetParam() + ".step"});
  const auto parts = load_parts(file);
  ASSERT_TRUE(parts.ok()) << parts.error().message;
  EXPECT_EQ(parts->size(), GetParam() == "twisted_tube" ? 2 : 1);
  for (const Part& part : *parts) {
    EXPECT_TRUE(check_closed(part.surface).ok());
    EXPECT_NEAR(enclosed_measure(part.surface), part.cad_volume, 3e-3 * part.cad_volume);
    EXPECT_GE(part.color[0], 0);
    EXPECT_LT(part.surface.facets.size(), 20000);
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, EverySample, testing::ValuesIn(sample_names()),
                         [](const auto& each) { return each.param; });

TEST(SampleParts, HaveTheVolumesOfTheirDrawings) {
  const test::TemporaryFolder folder;
  const auto volume = [&](const std::string& name, std::size_t part) {
    const auto file = folder / (name + ".step");
    EXPECT_TRUE(write_sample(name, file).ok());
    const auto parts = load_parts(file);
    return parts.ok() && parts->size() > part ? (*parts)[part].cad_volume : 0;
  };
  const double pi = 3.14159265358979323846;
  // 60 x 40 x 2, corners of radius 5, a hole of radius 4.
  EXPECT_NEAR(volume("plate", 0), 2 * (2400 - (4 - pi) * 25 - 16 * pi), 1e-6 * 4656);
  // Two fillets of radius 1 along 60 mm.
  EXPECT_NEAR(volume("t_junction", 0), 40 * 60 * 3 + 2 * 60 * 22 + 2 * 60 * (1 - pi / 4),
              1e-6 * 9866);
  // Pappus: the area of the section times the way of its center.
  const double center = 30 + 2.0 / 3 * (125000 - 110592) / (2500 - 2304) * std::sin(0.7) / 0.7;
  EXPECT_NEAR(volume("curved_shell", 0), 0.7 * (2500 - 2304) * 0.9 * center, 1e-6 * 9274);
  EXPECT_NEAR(volume("l_profile", 0), 2 * 40 * (30 + 28), 1e-6 * 4640);
  EXPECT_NEAR(volume("cross_junction", 0), 40 * (2 * 40 * 2 - 4), 1e-6 * 6240);
  EXPECT_NEAR(volume("wedge", 0), 20 * 40 * (0.4 + 4) / 2, 1e-6 * 1760);
  // Half rings 20 wide around radii 30, 45, 60, 75.
  EXPECT_NEAR(volume("spiral_mold", 0), 2 * 20 * pi * (30 + 45 + 60 + 75), 1e-6 * 26389);
}

TEST(SampleParts, UnknownNamesAndFoldersAreRefused) {
  const test::TemporaryFolder folder;
  const auto unknown = write_sample("teapot", folder / "x.step");
  ASSERT_FALSE(unknown.ok());
  EXPECT_EQ(unknown.error().code, Code::usage);
  EXPECT_NE(unknown.error().hint.find("ribbed_tray"), std::string::npos);
  const auto nowhere = write_sample("plate", folder.path() / "none" / "x.step");
  ASSERT_FALSE(nowhere.ok());
  EXPECT_EQ(nowhere.error().code, Code::io);
  EXPECT_TRUE(folder.names().empty());
}

/// An IGES file has faces that are not sewn, a BREP file no names: the same volume all the same.
TEST(SampleParts, ComeBackFromEveryCadFormat) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_sample("ribbed_tray", folder / "t.step").ok());
  const auto step = load_parts(folder / "t.step");
  ASSERT_TRUE(step.ok()) << step.error().message;
  for (const char* name : {"t.igs", "t.IGES", "t.brep", "t.brp"}) {
    ASSERT_TRUE(write_sample("ribbed_tray", folder / name).ok()) << name;
    const auto parts = load_parts(folder / name);
    ASSERT_TRUE(parts.ok()) << parts.error().message;
    ASSERT_EQ(parts->size(), 1u) << name;
    EXPECT_NEAR((*parts)[0].cad_volume, (*step)[0].cad_volume, 1e-6 * (*step)[0].cad_volume)
        << name;
    EXPECT_TRUE(check_closed((*parts)[0].surface).ok()) << name;
  }
}

TEST(SampleParts, SolidsOfABrepFileStayApart) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_sample("twisted_tube", folder / "t.brep").ok());
  const auto parts = load_parts(folder / "t.brep");
  ASSERT_TRUE(parts.ok()) << parts.error().message;
  ASSERT_EQ(parts->size(), 2u);
  EXPECT_NE((*parts)[0].name, (*parts)[1].name);
}

TEST(SampleParts, WhatIsNoCadFileIsRefusedByItsName) {
  const test::TemporaryFolder folder;
  for (const char* name : {"x.igs", "x.brep"})
    for (const char* text : {"", "no CAD", "DBRep_DrawableShape\n\nCASCADE Topology V1"}) {
      std::ofstream(folder / name) << text;
      const auto parts = load_parts(folder / name);
      ASSERT_FALSE(parts.ok()) << name;
      EXPECT_NE(parts.error().message.find(name), std::string::npos) << parts.error().message;
      EXPECT_FALSE(parts.error().hint.empty());
    }
}

}  // namespace
}  // namespace lamella
