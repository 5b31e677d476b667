// Part files that somebody's disk or program spoiled: an error that says so, or bodies that are
// sound, never the end of the program.

#include <gtest/gtest.h>

#include "core/base/atomic_file.h"
#include "core/cad/load_parts.h"
#include "core/cad/sample_parts.h"
#include "core/geometry/soup.h"
#include "core/io/stl.h"
#include "tests/support/damage.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

void expect_error_or_bodies(const std::filesystem::path& file, const LoadParams& params,
                            int round) {
  const auto parts = load_parts(file, params);
  if (!parts) {
    EXPECT_FALSE(parts.error().message.empty()) << "round " << round;
    return;
  }
  EXPECT_FALSE(parts->empty()) << "round " << round;
  for (const Part& part : *parts) {
    EXPECT_TRUE(check_closed(part.surface).ok()) << "round " << round;
    EXPECT_GT(enclosed_measure(part.surface), 0) << "round " << round;
  }
}

void try_damages(const std::filesystem::path& file, const LoadParams& params, int usual) {
  const std::string bytes = read_file(file).value();
  std::mt19937 random(1);
  const int rounds = test::damage_rounds(usual);
  for (int k = 0; k < rounds; ++k) {
    ASSERT_TRUE(write_file(file, test::damaged(bytes, random)).ok());
    expect_error_or_bodies(file, params, k);
  }
}

class DamagedPart : public testing::Test {
 protected:
  const test::TemporaryFolder folder;
  std::filesystem::path step() const {
    const auto file = folder / "plate.step";
    EXPECT_TRUE(write_sample("plate", file).ok());
    return file;
  }
  ReferenceSurface<3> surface() const { return load_parts(step()).value()[0].surface; }
};

TEST_F(DamagedPart, Step) { try_damages(step(), {.cad_seconds = 60}, 15); }

TEST_F(DamagedPart, BinaryStl) {
  const auto file = folder / "plate.stl";
  ASSERT_TRUE(write_stl(surface(), file).ok());
  try_damages(file, {.repair = Repair::none}, 100);
  ASSERT_TRUE(write_stl(surface(), file).ok());
  try_damages(file, {}, 20);
}

TEST_F(DamagedPart, TextStl) {
  const ReferenceSurface<3> s = surface();
  std::string text = "solid plate\n";
  for (const auto& f : s.facets) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const auto v : f) {
      text += "vertex";
      for (int k = 0; k < 3; ++k) text += " " + std::to_string(s.points[v][k]);
      text += "\n";
    }
    text += "endloop\nendfacet\n";
  }
  const auto file = folder / "plate.stl";
  ASSERT_TRUE(write_file(file, text + "endsolid plate\n").ok());
  try_damages(file, {.repair = Repair::none}, 100);
  ASSERT_TRUE(write_file(file, text + "endsolid plate\n").ok());
  try_damages(file, {}, 20);
}

}  // namespace
}  // namespace lamella
