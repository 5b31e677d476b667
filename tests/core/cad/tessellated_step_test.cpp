#include "core/cad/tessellated_step.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/cad/load_parts.h"
#include "core/geometry/soup.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

/// A tetrahedron of legs of one unit: a strip of two triangles, a fan of one, and a plain one.
std::string tetrahedron(const std::string& unit, const std::string& kind = "SOLID") {
  return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','',''"
         ");"
         "\nFILE_SCHEMA(('AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF'));\nENDSEC;\nDATA;\n"
         "#1=" +
         unit +
         ";\n"
         "#2 = COORDINATES_LIST('',4,((0.,0.,0.),(1.,0.,0.),(0.,1.,0.),\n (0.,0.,1.0E+00)));\n"
         "#3=COMPLEX_TRIANGULATED_FACE('a (b',#2,4,(),$,(4,1,3,2),((1,2,3,4)),());\n"
         "#4=COMPLEX_TRIANGULATED_FACE('',#2,4,(),$,(),(),((1,2,4)));\n"
         "#5=TRIANGULATED_FACE('',#2,4,(),$,(),((2,3,4)));\n"
         "#6=TESSELLATED_" +
         kind +
         "('corner',(#3,#4,#5),$);\n"
         "ENDSEC;\nEND-ISO-10303-21;\n";
}

constexpr const char* kMillimeter = "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))";
constexpr const char* kInch = "(CONVERSION_BASED_UNIT('INCH',#9)LENGTH_UNIT()NAMED_UNIT(#8))";

TEST(TessellatedStep, ReadsStripsFansAndTriangles) {
  const auto bodies = tessellated_bodies(tetrahedron(kMillimeter));
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_EQ(bodies[0].name, "corner");
  const auto surface = surface_from_soup(bodies[0].soup);
  ASSERT_TRUE(surface.ok()) << surface.error().message;
  EXPECT_EQ(surface->facets.size(), 4u);
  EXPECT_NEAR(enclosed_measure(*surface), 1.0 / 6, 1e-15);
  // The strip's triangles are wound alike, as those of the tetrahedron are.
  EXPECT_GT(facet_normal<3>(bodies[0].soup[0]).dot(Vec<3>(-1, 0, 0)) *
                facet_normal<3>(bodies[0].soup[1]).dot(Vec<3>(0, 0, -1)),
            0);
}

TEST(TessellatedStep, ReadsWhatIsWrittenInOtherWays) {
  std::string text = tetrahedron("(CONVERSION_BASED_UNIT('FOOT',#9)LENGTH_UNIT()NAMED_UNIT(#8))");
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, text.npos) << from;
    text.replace(at, from.size(), to);
  };
  replace("'corner'", "'driver''s, seat (2)'");
  replace("TESSELLATED_SOLID(", "TESSELLATED_SOLID (");
  replace("(1.,0.,0.)", "(+1.,0.,-0.)");
  const auto bodies = tessellated_bodies(text);
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_EQ(bodies[0].name, "driver''s, seat (2)");
  const auto surface = surface_from_soup(bodies[0].soup);
  ASSERT_TRUE(surface.ok()) << surface.error().message;
  EXPECT_NEAR(enclosed_measure(*surface), std::pow(304.8, 3) / 6, 1e-6);
}

TEST(TessellatedStep, LoadsAsABody) {
  const test::TemporaryFolder folder;
  for (const auto& [unit, mm] : {std::pair(kMillimeter, 1.0), std::pair(kInch, 25.4)}) {
    for (const char* kind : {"SOLID", "SHELL"}) {
      std::ofstream(folder / "t.step") << tetrahedron(unit, kind);
      const auto parts = load_parts(folder / "t.step");
      ASSERT_TRUE(parts.ok()) << parts.error().message;
      ASSERT_EQ(parts->size(), 1u);
      EXPECT_EQ((*parts)[0].name, "corner");
      EXPECT_NEAR((*parts)[0].cad_volume, mm * mm * mm / 6, 1e-9);
      const auto& notes = (*parts)[0].notes;
      EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
        return note.find("No exact geometry") != std::string::npos;
      }));
    }
  }
}

TEST(TessellatedStep, LeavesOutWhatRefersToNothing) {
  std::string text = tetrahedron(kMillimeter);
  text.replace(text.find("(4,1,3,2)"), 9, "(4,1,9,2)");
  EXPECT_EQ(tessellated_bodies(text)[0].soup.size(), 2u);
  text.replace(text.find("(#3,#4,#5)"), 10, "(#3,#4,#7)");
  EXPECT_EQ(tessellated_bodies(text)[0].soup.size(), 1u);
  for (std::size_t n = 0; n < text.size(); n += 3) (void)tessellated_bodies(text.substr(0, n));
  EXPECT_TRUE(tessellated_bodies("").empty());
}

TEST(TessellatedStep, ARealLidIsClosed) {
  const auto file = std::filesystem::path(LAMELLA_REAL_PARTS) / "nist_ftc_08_asme1_ap242-e1-tg.stp";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "missing " << file;
  const auto parts = load_parts(file);
  ASSERT_TRUE(parts.ok()) << parts.error().message;
  ASSERT_EQ(parts->size(), 1u);
  EXPECT_EQ((*parts)[0].name, "PartBody");
  EXPECT_TRUE(check_closed((*parts)[0].surface).ok());
}

}  // namespace
}  // namespace lamella
