#include "core/natural/natural_metric.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "core/geometry/locator.h"
#include "core/geometry/soup.h"
#include "core/io/stl.h"
#include "core/mesh/sample_meshes.h"
#include "core/metric/metric.h"
#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

using namespace lamella::testing;

double quantile(std::vector<double> v, double p) {
  std::sort(v.begin(), v.end());
  return v[static_cast<std::size_t>(p * static_cast<double>(v.size() - 1))];
}

TEST(NaturalMetric, PlatesGetTheirThicknessOverN) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> u(0, 1);
  for (const double t : {0.01, 0.02, 0.05})
    for (const int n : {1, 4, 8}) {
      const Mat<3> r = turn(0.7, {1, 2, 3});
      const Vec<3> shift{3, 4, 5};
      const NaturalDetector detector(moved<3>(box_surface({1, 1, t}, {6, 6, 1}), r, shift));
      NaturalParams params;
      params.layers = n;
      std::vector<double> ratio;
      for (int i = 0; i < 400; ++i) {
        // Half of the places on the faces, as mesh nodes are.
        const double z = i % 4 == 0 ? 0 : i % 4 == 1 ? t : t * u(rng);
        const auto natural = detector.at(r * Vec<3>(u(rng), u(rng), z) + shift, params);
        const Vec<3> h = sizes<3>(natural.metric);
        if (n > 1) ratio.push_back(h[0] * n / t);
        EXPECT_NEAR(natural.thickness, t, 0.1 * t);
        EXPECT_NEAR(std::abs(natural.direction.dot(r.col(2))), 1, 0.05);
      }
      if (n == 1) continue;  // one layer: the long axes are divided by 4 and may be shorter
      EXPECT_GT(quantile(ratio, 0.05), 0.98);
      EXPECT_LT(quantile(ratio, 0.95), 1.01);
    }
}

TEST(NaturalMetric, ThicknessAndWidthGetNumbersOfLayersOfTheirOwn) {
  // The cross section of the spiral mold of section 4.4.3: 2 x 20, long.
  const double t = 2, w = 20;
  const NaturalDetector detector(box_surface({200, w, t}, {40, 4, 1}));
  NaturalParams params;
  params.layers = 4;
  const Vec<3> center{100, w / 2, t / 2};
  const Vec<3> plain = sizes<3>(detector.at(center, params).metric);
  params.layers2 = 5;
  params.alpha2 = 8;
  const Vec<3> two = sizes<3>(detector.at(center, params).metric);
  params.layers3 = 10;
  const Vec<3> three = sizes<3>(detector.at(center, params).metric);
  EXPECT_NEAR(two[0], t / 4, 0.02 * t);
  EXPECT_NEAR(two[1], w / 5, 0.2 * w / 5);
  // The width is seen a little longer than 10 t, the length cut at 20 t: both touch the band where
  // one number fades into the next.
  EXPECT_NEAR(two[1] / plain[1], 4.0 / 5, 0.02) << "not divided: half the semi-axis";
  EXPECT_NEAR(two[2] / plain[2], 1, 0.02) << "the length is left alone";
  EXPECT_NEAR(three[0], two[0], 1e-9);
  EXPECT_NEAR(three[1] / two[1], 1, 0.05);
  EXPECT_NEAR(three[2] / two[2], 4.0 / 10, 0.02);
  params.layers2.reset();
  const Vec<3> all_long = sizes<3>(detector.at(center, params).metric);
  EXPECT_NEAR(all_long[1] / plain[1], 4.0 / 10, 1e-9) << "without n2, n3 is for all beyond alpha1";
}

TEST(NaturalMetric, WedgeFollowsItsThicknessDownToTheSmallestSize) {
  const double slope = 0.1;
  const NaturalDetector detector(prism_surface({{0, 0}, {1, 0}, {1, slope}}, 1));
  NaturalParams params;
  params.h_min = 0.002;
  const double angle = std::atan(slope);
  for (double x = 0.05; x < 0.9; x += 0.05) {
    // The ball that touches the floor at x has the radius x tan(angle / 2).
    const auto natural = detector.at({x, 0.5, 0}, params);
    const double exact = 2 * x * std::tan(angle / 2);
    EXPECT_NEAR(natural.thickness / exact, 1, 0.05);
    EXPECT_NEAR(sizes<3>(natural.metric)[0], std::max(exact / 4, params.h_min), 0.05 * exact / 4);
  }
  EXPECT_NEAR(sizes<3>(detector.at({0, 0.5, 0}, params).metric)[0], params.h_min, 1e-9);
}

TEST(NaturalMetric, ThickBodiesAreIsotropic) {
  const NaturalDetector cube(box_surface({1, 1, 1}));
  const NaturalDetector ball(sphere_surface(1, 3));
  const Vec<3> in_cube = sizes<3>(cube.at({0.5, 0.4, 0.55}, {}).metric);
  EXPECT_LT(in_cube[2] / in_cube[0], 1.15);
  EXPECT_NEAR(in_cube[0], 0.25, 0.02);
  const Vec<3> in_ball = sizes<3>(ball.at({0, 0, 1}, {}).metric);
  EXPECT_LT(in_ball[2] / in_ball[0], 1.1);
  EXPECT_NEAR(in_ball[0], 0.5, 0.05);
}

TEST(NaturalMetric, CornerOfAnLIsABlockAndItsLegsAreWalls) {
  const double t = 0.1;
  const NaturalDetector detector(l_surface(t));
  const auto leg = detector.at({0.7, 0.5, 0.03}, {});
  EXPECT_NEAR(leg.thickness, t, 1e-3);
  EXPECT_NEAR(std::abs(leg.direction[2]), 1, 0.01);
  const Vec<3> h = sizes<3>(leg.metric);
  EXPECT_GT(h[1] / h[0], 4);
  // In the corner both walls are divided: two short axes, one long.
  const auto corner = detector.at({0.05, 0.5, 0.05}, {});
  const auto corner_sizes = spectrum<3>(corner.metric);
  EXPECT_LT(std::sqrt(corner_sizes.values[2] / corner_sizes.values[1]), 1.6);
  EXPECT_NEAR(corner.thickness, t, 0.02);
}

TEST(NaturalMetric, BothWallsOfAReentrantEdgeGetTheirLayers) {
  // A step from 0.1 to 0.4: the edge belongs to the thin side too.
  const double thin = 0.1, thick = 0.4;
  const Mat<3> r = turn(0.7, {1, 2, 3});
  const NaturalDetector step(
      moved<3>(cell_surface({std::vector{0.0, 1.0, 2.0}, {0.0, 1.0}, {0.0, thin, thick}},
                            [](int i, int, int k) { return i == 1 || k == 0; }),
               r, Vec<3>::Zero()));
  NaturalParams params;
  params.layers = 4;
  const auto at_step = step.at(r * Vec<3>(1, 0.45, thin), params);
  EXPECT_NEAR(at_step.thickness, thin, 0.02 * thin);
  const Vec<3> across = r * Vec<3>::UnitZ();
  EXPECT_LT(1 / metric_length<3>(across, at_step.metric), 1.1 * thin / params.layers);
  // The inner edge of an L: across one leg and across the other.
  const NaturalDetector ell(l_surface(thin));
  const auto corner = ell.at({thin, 0.45, thin}, params);
  for (const int k : {0, 2})
    EXPECT_LT(1 / metric_length<3>(Vec<3>::Unit(k), corner.metric), 1.1 * thin / params.layers);
  EXPECT_GT(1 / metric_length<3>(Vec<3>::UnitY(), corner.metric), 4 * thin / params.layers);
}

TEST(NaturalMetric, CurvedWallsPointAcross) {
  const NaturalDetector tube(tube_surface(0.95, 1, 1, 200, 10));
  for (const double phi : {0.1, 1.0, 2.2, 4.5}) {
    const Vec<3> radial{std::cos(phi), std::sin(phi), 0};
    const auto natural = tube.at(0.97 * radial + Vec<3>(0, 0, 0.5), {});
    EXPECT_NEAR(natural.thickness, 0.05, 0.0005);
    EXPECT_NEAR(std::abs(natural.direction.dot(radial)), 1, 0.005);
    // Seen within the wall, the tube is longer along its axis than around.
    const auto s = spectrum<3>(natural.metric);
    EXPECT_NEAR(std::abs(s.vectors(2, 0)), 1, 0.05);
  }
}

TEST(NaturalMetric, FieldIsThePointwiseAnswerOnAnyNumberOfThreads) {
  const NaturalDetector detector(box_surface({1, 1, 1}));
  const auto mesh = box_mesh<3>({3, 4, 2}, {0, 0, 0}, {1, 1, 1});
  NaturalParams params;
  params.threads = 1;
  double reported = 0;
  const auto one =
      detector.field(mesh, params, Progress([&](double f, std::string_view) { reported = f; }));
  params.threads = 3;
  const auto three = detector.field(mesh, params);
  ASSERT_TRUE(one.ok() && three.ok());
  EXPECT_EQ(reported, 1);
  ASSERT_EQ(one->metric.size(), mesh.points.size());
  for (std::size_t i = 1; i < mesh.points.size(); ++i) {
    EXPECT_EQ(one->metric[i], three->metric[i]);
    EXPECT_EQ(one->metric[i], detector.at(mesh.points[i], params).metric);
    EXPECT_EQ(one->thickness[i], three->thickness[i]);
    EXPECT_TRUE(is_spd<3>(one->metric[i]));
    EXPECT_NEAR(one->direction[i].norm(), 1, 1e-9);
  }
}

TEST(NaturalMetric, RealPartHasTheWallsItsDrawingShows) {
  // A hinge of plates 5 mm and ears 2 mm thick, coarsely tessellated.
  const std::filesystem::path file =
      std::filesystem::path(LAMELLA_REAL_PARTS) / "netgen_hinge_ascii.stl";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here.";
  const auto soup = read_stl(file);
  ASSERT_TRUE(soup.ok());
  const auto surface = surface_from_soup(*soup);
  ASSERT_TRUE(surface.ok());
  const Locator<3> locator(*surface);
  const NaturalDetector detector(*surface);
  std::mt19937 rng(1);
  std::normal_distribution<double> normal;
  std::vector<double> thickness;
  for (const auto& f : surface->facets) {
    const Vec<3> x = (surface->points[f[0]] + surface->points[f[1]] + surface->points[f[2]]) / 3;
    const auto natural = detector.at(x, {});
    thickness.push_back(natural.thickness);
    EXPECT_TRUE(is_spd<3>(natural.metric));
    // From just inside, a ray leaves the body whatever its direction.
    const Vec<3> inside = x - 1e-3 * locator.normal(locator.nearest(x)->facet);
    for (int i = 0; i < 20; ++i)
      EXPECT_TRUE(locator.exit(inside, Vec<3>(normal(rng), normal(rng), normal(rng)).normalized()));
  }
  EXPECT_GT(quantile(thickness, 0), 1);
  EXPECT_NEAR(quantile(thickness, 0.05), 2, 0.05);
  EXPECT_NEAR(quantile(thickness, 0.9), 5, 0.05);
}

TEST(NaturalMetric, ABoundOfAnisotropyShortensTheLongAxesOnly) {
  const NaturalDetector detector(box_surface({1, 1, 0.02}, {6, 6, 1}));
  NaturalParams free, bound;
  bound.max_anisotropy = 10;
  for (const Vec<3>& x : {Vec<3>(0.5, 0.5, 0.01), Vec<3>(0.3, 0.7, 0), Vec<3>(0.6, 0.2, 0.015)}) {
    const Vec<3> before = sizes<3>(detector.at(x, free).metric);
    const Vec<3> after = sizes<3>(detector.at(x, bound).metric);
    ASSERT_GT(before[2], 15 * before[0]);
    EXPECT_NEAR(after[0], before[0], 1e-9);
    EXPECT_NEAR(after[1], 10 * before[0], 1e-9);
    EXPECT_NEAR(after[2], 10 * before[0], 1e-9);
  }
  bound.max_anisotropy = 0.5;
  ASSERT_FALSE(check_params(bound).ok());
  EXPECT_EQ(check_params(bound).error().code, Code::usage);
}

TEST(NaturalMetric, SizesStayWithinTheirBounds) {
  const NaturalDetector detector(box_surface({1, 1, 0.01}));
  NaturalParams params;
  params.h_min = 0.005;
  params.h_max = 0.03;
  const Vec<3> h = sizes<3>(detector.at({0.5, 0.5, 0}, params).metric);
  EXPECT_NEAR(h[0], 0.005, 1e-12);
  EXPECT_NEAR(h[2], 0.03, 1e-12);
}

TEST(NaturalMetric, RefusesWhatMakesNoSenseAndStopsWhenAsked) {
  const NaturalDetector detector(box_surface({1, 1, 1}));
  const auto mesh = unit_box<3>(2);
  NaturalParams none;
  none.layers = 0;
  EXPECT_EQ(detector.field(mesh, none).error().code, Code::usage);
  NaturalParams crossed;
  crossed.h_min = 2;
  crossed.h_max = 1;
  EXPECT_EQ(detector.field(mesh, crossed).error().code, Code::usage);
  NaturalParams negative;
  negative.alpha = -1;
  EXPECT_EQ(detector.field(mesh, negative).error().code, Code::usage);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(detector.field(mesh, {}, Progress({}, stop.get_token())).error().code, Code::cancelled);
  EXPECT_EQ(NaturalDetector(ReferenceSurface<3>{}).field(mesh, {}).error().code, Code::bad_input);
}

}  // namespace
}  // namespace lamella
