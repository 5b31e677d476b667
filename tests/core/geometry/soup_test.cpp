#include "core/geometry/soup.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>
#include <random>

#include "core/io/stl.h"
#include "tests/support/soups.h"

namespace lamella {
namespace {

using test::both;
using test::box_soup;
using test::Soup;
using test::turned;
using test::unit_box;

const std::filesystem::path kReal = LAMELLA_REAL_PARTS;

/// A surface that must come out, closed.
ReferenceSurface<3> surface_of(const Soup& soup, std::vector<std::string>* notes = nullptr) {
  auto surface = surface_from_soup(soup, {}, notes);
  EXPECT_TRUE(surface.ok()) << surface.error().message;
  if (!surface.ok()) return {};
  const auto closed = check_closed(*surface);
  EXPECT_TRUE(closed.ok()) << closed.error().message;
  return *std::move(surface);
}

Error refusal(const Soup& soup) {
  const auto surface = surface_from_soup(soup);
  EXPECT_FALSE(surface.ok());
  if (surface.ok()) return {};
  EXPECT_EQ(surface.error().code, Code::bad_input);
  EXPECT_FALSE(surface.error().hint.empty());
  return surface.error();
}

bool says(const Error& e, const std::string& word) {
  return e.message.find(word) != std::string::npos;
}

/// A cylinder along z of n sides, radius 1 and height 2, centered.
Soup cylinder(int n) {
  Soup soup;
  const auto ring = [&](int i, double z) {
    const double a = 2 * std::numbers::pi * (i % n) / n;
    return Vec<3>{std::cos(a), std::sin(a), z};
  };
  for (int i = 0; i < n; ++i) {
    soup.push_back({ring(i, -1), ring(i + 1, -1), ring(i + 1, 1)});
    soup.push_back({ring(i, -1), ring(i + 1, 1), ring(i, 1)});
    soup.push_back({Vec<3>{0, 0, 1}, ring(i, 1), ring(i + 1, 1)});
    soup.push_back({Vec<3>{0, 0, -1}, ring(i + 1, -1), ring(i, -1)});
  }
  return soup;
}

TEST(Soup, BoxHasTheFeaturesOfABox) {
  std::vector<std::string> notes;
  const auto box = surface_of(box_soup({-1, 0, 2}, {3, 2, 5}), &notes);
  EXPECT_EQ(box.points.size(), 8);
  EXPECT_EQ(box.facets.size(), 12);
  EXPECT_EQ(box.faces.size(), 6);
  EXPECT_EQ(box.feature_edges.size(), 12);
  EXPECT_EQ(box.corners.size(), 8);
  EXPECT_DOUBLE_EQ(enclosed_measure(box), 24);
  EXPECT_TRUE(notes.empty());
}

TEST(Soup, CylinderHasThreePatchesAndSmoothRims) {
  const auto c = surface_of(cylinder(32));
  EXPECT_EQ(c.faces.size(), 3);
  EXPECT_EQ(c.feature_edges.size(), 64);
  EXPECT_TRUE(c.corners.empty());
  // Volume of the prism on a regular polygon.
  EXPECT_NEAR(enclosed_measure(c), 32 * std::sin(2 * std::numbers::pi / 32), 1e-12);
}

TEST(Soup, FeatureAngleSeparatesTheSidesOfAPrism) {
  SoupParams params;
  params.feature_angle = 0.9;  // 8 sides turn by 0.785 each
  auto smooth = surface_from_soup(cylinder(8), params);
  ASSERT_TRUE(smooth.ok());
  EXPECT_EQ(smooth->faces.size(), 3);
  params.feature_angle = 0.7;
  auto sharp = surface_from_soup(cylinder(8), params);
  ASSERT_TRUE(sharp.ok());
  EXPECT_EQ(sharp->faces.size(), 10);
  EXPECT_EQ(sharp->corners.size(), 16);
}

TEST(Soup, TurnsFacetsAndShells) {
  std::vector<std::string> notes;
  Soup soup = unit_box();
  std::swap(soup[3][0], soup[3][1]);
  std::swap(soup[7][0], soup[7][1]);
  EXPECT_DOUBLE_EQ(enclosed_measure(surface_of(soup, &notes)), 1);
  ASSERT_EQ(notes.size(), 1);
  EXPECT_NE(notes[0].find("2 facets"), std::string::npos) << notes[0];

  notes.clear();
  EXPECT_DOUBLE_EQ(enclosed_measure(surface_of(turned(unit_box()), &notes)), 1);
  ASSERT_EQ(notes.size(), 1);
  EXPECT_NE(notes[0].find("1 inside-out shell"), std::string::npos) << notes[0];
}

TEST(Soup, KeepsVoidsAndSeparatesBodies) {
  const Soup hollow = turned(box_soup({1, 1, 1}, {2, 2, 2}));
  const Soup inner_body = box_soup({1.25, 1.25, 1.25}, {1.75, 1.75, 1.75});
  const Soup soup = both(both(box_soup({10, 0, 0}, {12, 1, 1}), box_soup({0, 0, 0}, {3, 3, 3})),
                         both(hollow, inner_body));
  EXPECT_NEAR(enclosed_measure(surface_of(soup)), 27 - 1 + 0.125 + 2, 1e-12);

  const auto parts = surfaces_from_soup(soup);
  ASSERT_TRUE(parts.ok()) << parts.error().message;
  ASSERT_EQ(parts->size(), 3);
  EXPECT_NEAR(enclosed_measure((*parts)[0]), 26, 1e-12);
  EXPECT_EQ((*parts)[0].facets.size(), 24);
  EXPECT_NEAR(enclosed_measure((*parts)[1]), 2, 1e-12);
  EXPECT_NEAR(enclosed_measure((*parts)[2]), 0.125, 1e-12);
}

TEST(Soup, TurnsAVoidThatPointsOutward) {
  std::vector<std::string> notes;
  const Soup soup = both(box_soup({0, 0, 0}, {3, 3, 3}), box_soup({1, 1, 1}, {2, 2, 2}));
  EXPECT_NEAR(enclosed_measure(surface_of(soup, &notes)), 26, 1e-12);
  EXPECT_EQ(notes.size(), 2);
}

TEST(Soup, DropsDegenerateAndDuplicateFacets) {
  Soup soup = unit_box();
  soup.push_back(soup[4]);
  soup.push_back({soup[0][0], soup[0][0], soup[0][1]});
  // A fin: two facets back to back enclose nothing.
  soup.push_back({soup[0][0], soup[0][1], Vec<3>{9, 9, 9}});
  soup.push_back({soup[0][1], soup[0][0], Vec<3>{9, 9, 9}});
  std::vector<std::string> notes;
  const auto box = surface_of(soup, &notes);
  EXPECT_EQ(box.facets.size(), 12);
  EXPECT_EQ(box.points.size(), 8);
  EXPECT_EQ(notes.size(), 2);
}

TEST(Soup, WeldsCracksAndOnlyThose) {
  // Every facet moved by up to 1e-6: no two share a vertex any more. The thin slot nearby is
  // narrower than the weld tolerance but no crack.
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-1e-6, 1e-6);
  Soup cracked = unit_box();
  for (auto& facet : cracked) {
    for (Vec<3>& p : facet) p += Vec<3>{jitter(random), jitter(random), jitter(random)};
  }
  const Soup neighbor = box_soup({1 + 5e-5, 0, 0}, {2, 1, 1});
  std::vector<std::string> notes;
  const auto surface = surface_of(both(cracked, neighbor), &notes);
  EXPECT_EQ(surface.points.size(), 16);
  EXPECT_NEAR(enclosed_measure(surface), 2 - 5e-5, 1e-5);
  ASSERT_EQ(notes.size(), 1);
  EXPECT_NE(notes[0].find("Cracks along 36 open edges"), std::string::npos) << notes[0];

  SoupParams strict;
  strict.weld_tolerance = 1e-9;
  EXPECT_FALSE(surface_from_soup(cracked, strict).ok());
}

TEST(Soup, RefusesHolesWithCountAndPlace) {
  Soup soup = unit_box();
  soup.erase(soup.begin());  // the facet (0,0,0) (0,1,0) (1,1,0)
  const Error e = refusal(soup);
  EXPECT_TRUE(says(e, "3 open edges")) << e.message;
  EXPECT_TRUE(says(e, "1.41 mm at (0.333333, 0.666667, 0)")) << e.message;
}

TEST(Soup, RefusesNonManifoldEdges) {
  // Two boxes that share one edge.
  SoupParams params;
  params.repair = false;
  const auto surface = surface_from_soup(both(unit_box(), box_soup({1, 1, 0}, {2, 2, 1})), params);
  ASSERT_FALSE(surface.ok());
  EXPECT_TRUE(says(surface.error(), "1 edge")) << surface.error().message;
  EXPECT_TRUE(says(surface.error(), "(1, 1, 0.5)")) << surface.error().message;
}

TEST(Soup, RefusesWhatHasNoVolume) {
  EXPECT_FALSE(surface_from_soup({}).ok());
  refusal({{Vec<3>{0, 0, 0}, Vec<3>{1, 0, 0}, Vec<3>{0, 1, 0}}});
  refusal({{Vec<3>{1, 1, 1}, Vec<3>{1, 1, 1}, Vec<3>{1, 1, 1}}});
  refusal(box_soup({0, 0, 0}, {1, 1, 0}));
  Soup nan = unit_box();
  nan[5][1][2] = std::nan("");
  EXPECT_TRUE(says(refusal(nan), "finite"));
}

TEST(Soup, RefusesAOneSidedSurface) {
  // The real projective plane on six vertices, the smallest closed one-sided surface.
  constexpr int kFacets[10][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1},
                                  {1, 2, 4}, {2, 3, 5}, {3, 4, 1}, {4, 5, 2}, {5, 1, 3}};
  const Vec<3> p[6] = {{0, 0, 1},    {1, 0, 0},      {.3, 1, .1},
                       {-.8, .6, 0}, {-.8, -.6, .2}, {.3, -1, 0}};
  Soup soup;
  for (const auto& f : kFacets) soup.push_back({p[f[0]], p[f[1]], p[f[2]]});
  const Error e = refusal(soup);
  EXPECT_TRUE(says(e, "one-sided")) << e.message;
}

TEST(Soup, CancelReturnsCancelled) {
  std::stop_source stop;
  stop.request_stop();
  const auto result = surface_from_soup(unit_box(), {}, nullptr, Progress({}, stop.get_token()));
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, Code::cancelled);
}

TEST(CheckClosed, FindsOpenAndTurnedFacets) {
  auto box = surface_of(unit_box());
  std::swap(box.facets[0][0], box.facets[0][1]);
  auto wrong = check_closed(box);
  ASSERT_FALSE(wrong.ok());
  EXPECT_TRUE(says(wrong.error(), "winding changes at 3 edges")) << wrong.error().message;
  box.facets.erase(box.facets.begin());
  auto open = check_closed(box);
  ASSERT_FALSE(open.ok());
  EXPECT_TRUE(says(open.error(), "open at 3 edges")) << open.error().message;
  box.facets[0][0] = 99;
  EXPECT_FALSE(check_closed(box).ok());
}

TEST(CheckClosed, WorksInThePlane) {
  ReferenceSurface<2> square;
  square.points = {{0, 0}, {2, 0}, {2, 3}, {0, 3}};
  // facet_normal of (p0, p1) is its left-hand normal: outward means clockwise.
  square.facets = {{0, 3}, {3, 2}, {2, 1}, {1, 0}};
  for (const auto& f : square.facets) {
    const std::array<Vec<2>, 2> p{square.points[f[0]], square.points[f[1]]};
    EXPECT_GT(facet_normal<2>(p).dot(p[0] - Vec<2>{1, 1.5}), 0);
  }
  EXPECT_TRUE(check_closed(square).ok());
  EXPECT_DOUBLE_EQ(enclosed_measure(square), 6);
  square.facets.pop_back();
  EXPECT_FALSE(check_closed(square).ok());
  square.facets = {{3, 0}, {2, 3}, {1, 2}, {0, 1}};
  EXPECT_DOUBLE_EQ(enclosed_measure(square), -6);
  EXPECT_FALSE(check_closed(square).ok());
}

struct RealStl {
  const char* file;
  double volume;  // of MANIFEST.tsv; 0: to be refused
  std::size_t parts;
  const char* finding;
};

class RealSoup : public testing::TestWithParam<RealStl> {};

TEST_P(RealSoup, ClosesOrIsRefused) {
  const RealStl& expected = GetParam();
  const auto file = kReal / expected.file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "missing " << file;
  const auto soup = read_stl(file);
  ASSERT_TRUE(soup.ok());
  const auto parts = surfaces_from_soup(*soup);
  if (expected.volume == 0) {
    ASSERT_FALSE(parts.ok());
    EXPECT_TRUE(says(parts.error(), expected.finding)) << parts.error().message;
    return;
  }
  ASSERT_TRUE(parts.ok()) << parts.error().message;
  EXPECT_EQ(parts->size(), expected.parts);
  double volume = 0;
  for (const auto& part : *parts) {
    EXPECT_TRUE(check_closed(part).ok());
    volume += enclosed_measure(part);
  }
  EXPECT_NEAR(volume, expected.volume, 5e-4 * expected.volume);
}

INSTANTIATE_TEST_SUITE_P(Parts, RealSoup,
                         testing::Values(RealStl{"fan_duct_hotend_mount.stl", 9059.5, 1, ""},
                                         RealStl{"featuretype_inch_cracks.stl", 11.628, 1, ""},
                                         RealStl{"mark2_audio_chamber_cracks.stl", 90651, 1, ""},
                                         RealStl{"shaker_top_cover_bad_normals.stl", 19034, 1, ""},
                                         RealStl{"prusa_mini_z_carriage_front.stl", 47829, 1, ""},
                                         RealStl{"prusa_mini_cable_cover_ascii.stl", 3623.5, 1, ""},
                                         RealStl{"netgen_hinge_ascii.stl", 6336.4, 1, ""},
                                         RealStl{"cpx_snapfit_case.stl", 4312.2, 1, ""},
                                         RealStl{"m5_unit_env_housing.stl", 4476.2, 4, ""},
                                         RealStl{"timecube_box_b_duplicates.stl", 5144.4, 20, ""},
                                         RealStl{"skirt_multibody_nonmanifold.stl", 6573.3, 1, ""},
                                         RealStl{"pathfinder_torso_back_hole.stl", 114780, 1, ""},
                                         RealStl{"utah_teapot.stl", 0, 0, "64 open edges"}),
                         [](const auto& each) {
                           return std::filesystem::path(each.param.file).stem().string();
                         });

}  // namespace
}  // namespace lamella
