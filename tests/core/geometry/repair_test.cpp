#include "core/geometry/repair.h"

#include <gtest/gtest.h>

#include <random>

#include "core/geometry/soup.h"
#include "tests/support/soups.h"

namespace lamella {
namespace {

using test::both;
using test::box_soup;
using test::Soup;
using test::unit_box;

/// A sphere of radius 1: `rings` rings of 2 * rings facets pairs.
Soup sphere(int rings) {
  const auto at = [&](int i, int j) {
    const double a = M_PI * i / rings, b = M_PI * (j % (2 * rings)) / rings;
    return i == 0       ? Vec<3>(0, 0, 1)
           : i == rings ? Vec<3>(0, 0, -1)
                        : Vec<3>(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
  };
  Soup soup;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) soup.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + 1 < rings) soup.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  return soup;
}

double volume_of(const Soup& soup, std::vector<std::string>* notes = nullptr,
                 std::size_t bodies = 1) {
  const auto surfaces = surfaces_from_soup(soup, {}, notes);
  EXPECT_TRUE(surfaces.ok()) << surfaces.error().message;
  if (!surfaces.ok()) return 0;
  EXPECT_EQ(surfaces->size(), bodies);
  double volume = 0;
  for (const auto& s : *surfaces) {
    EXPECT_TRUE(check_closed(s).ok());
    volume += enclosed_measure(s);
  }
  return volume;
}

TEST(Repair, FillsSmallHolesOnly) {
  const double whole = volume_of(sphere(40));
  Soup cut = sphere(40);
  cut.erase(cut.begin() + 1000);
  cut.erase(cut.begin() + 1000);
  cut.erase(cut.begin() + 300);
  std::vector<std::string> notes;
  EXPECT_NEAR(volume_of(cut, &notes), whole, 1e-3);
  ASSERT_FALSE(notes.empty());
  EXPECT_NE(notes[0].find("2 holes filled"), std::string::npos) << notes[0];

  // The cap around the pole: its rim has the radius sin(pi / 4).
  std::erase_if(cut, [](const auto& f) { return (f[0] + f[1] + f[2])[2] > 3 * std::sqrt(.5); });
  const auto refused = surfaces_from_soup(cut);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, Code::bad_input);
  EXPECT_NE(refused.error().message.find("of 80 edges and 2 mm"), std::string::npos)
      << refused.error().message;
  EXPECT_NE(refused.error().message.find("0.7071"), std::string::npos) << refused.error().message;
}

TEST(Repair, SplitsEdgesThatTwoBoxesShare) {
  std::vector<std::string> notes;
  EXPECT_NEAR(volume_of(both(unit_box(), box_soup({1, 1, 0}, {2, 2, 1})), &notes, 2), 2, 1e-12);
  ASSERT_FALSE(notes.empty());
  EXPECT_NE(notes[0].find("1 non-manifold edge was split"), std::string::npos) << notes[0];
}

TEST(Repair, UnitesBoxesThatShareAWall) {
  // Opposite facets on the same vertices enclose nothing.
  EXPECT_NEAR(volume_of(both(unit_box(), box_soup({1, 0, 0}, {2, 1, 1}))), 2, 1e-12);
}

TEST(Repair, MovesASelfTouchingBodyApart) {
  // Four boxes around the edge (1,1,z), two of them missing, joined below by a slab.
  const auto prism = [](double x, double y, double z) {
    return box_soup({x, y, z}, {x + 1, y + 1, z + 1});
  };
  Soup soup = both(prism(0, 0, 1), prism(1, 1, 1));
  for (const double x : {0., 1.})
    for (const double y : {0., 1.}) soup = both(soup, prism(x, y, 0));
  std::vector<std::string> notes;
  EXPECT_NEAR(volume_of(soup, &notes), 6, 1e-3);
  bool told = false;
  for (const std::string& note : notes)
    told = told || note.find("touches itself") != std::string::npos;
  EXPECT_TRUE(told);
}

TEST(Repair, SplitsFacetsAtTVertices) {
  // One face of the box is cut finer than its neighbors.
  Soup soup = unit_box();
  std::erase_if(soup, [](const auto& f) { return f[0][2] == 1 && f[1][2] == 1 && f[2][2] == 1; });
  const Vec<3> center(.5, .5, 1);
  const Vec<3> rim[8] = {{0, 0, 1}, {.5, 0, 1}, {1, 0, 1}, {1, .25, 1},
                         {1, 1, 1}, {.3, 1, 1}, {0, 1, 1}, {0, .5, 1}};
  for (int k = 0; k < 8; ++k) soup.push_back({center, rim[k], rim[(k + 1) % 8]});
  std::vector<std::string> notes;
  EXPECT_NEAR(volume_of(soup, &notes), 1, 1e-12);
  ASSERT_FALSE(notes.empty());
  EXPECT_NE(notes[0].find("4 places"), std::string::npos) << notes[0];
}

TEST(Repair, ClosesASphereBrokenInEveryWay) {
  const double whole = volume_of(sphere(30));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-1e-5, 1e-5);
  Soup broken = sphere(30);
  for (std::size_t k = 0; k < broken.size(); k += 17) std::swap(broken[k][0], broken[k][1]);
  for (std::size_t k = 5; k < broken.size(); k += 31)
    for (Vec<3>& p : broken[k]) p += Vec<3>(jitter(random), jitter(random), jitter(random));
  for (std::size_t k = 3; k < 1500; k += 100) broken.push_back(broken[k]);
  broken.erase(broken.begin() + 700);
  EXPECT_NEAR(volume_of(broken), whole, 2e-3);
}

TEST(Repair, LeavesSmallOpenShellsOut) {
  Soup soup = box_soup({0, 0, 0}, {10, 10, 10});
  soup.push_back({Vec<3>(20, 0, 0), Vec<3>(22, 0, 0), Vec<3>(20, 2, 0)});
  std::vector<std::string> notes;
  EXPECT_NEAR(volume_of(soup, &notes), 1000, 1e-9);
  ASSERT_FALSE(notes.empty());
  EXPECT_NE(notes[0].find("1 open shell"), std::string::npos) << notes[0];
}

TEST(Repair, ChangesNothingWhenNotAsked) {
  SoupParams params;
  params.repair = false;
  Soup soup = unit_box();
  soup.push_back(soup[0]);
  EXPECT_FALSE(surfaces_from_soup(soup, params).ok());
  EXPECT_TRUE(surfaces_from_soup(unit_box(), params).ok());
}

}  // namespace
}  // namespace lamella
