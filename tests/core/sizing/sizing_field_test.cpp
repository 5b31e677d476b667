#include "core/sizing/sizing_field.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/metric/analytic.h"
#include "tests/support/random_metric.h"
#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

const Vec<3> kX = Vec<3>::UnitX(), kY = Vec<3>::UnitY(), kZ = Vec<3>::UnitZ();
constexpr double kRound = 1e-9;

SizeCorrection size_of(double size, bool keep = false) {
  SizeCorrection c;
  c.size = size;
  c.keep_directions = keep;
  return c;
}
SizeCorrection factor_of(double factor, bool keep = false) {
  SizeCorrection c;
  c.factor = factor;
  c.keep_directions = keep;
  return c;
}

/// A box of 10 x 10 x 2 whose faces have names, -x to +z.
ReferenceSurface<3> named_box() {
  ReferenceSurface<3> s = testing::box_surface({10, 10, 2}, {2, 2, 1});
  const char* names[] = {"left", "right", "front", "back", "bottom", "top"};
  for (int f = 0; f < 6; ++f) s.faces[f].name = names[f];
  return s;
}

SizingField field_of(const std::vector<SizingObject>& objects) {
  Result<SizingField> field = SizingField::make(objects, named_box());
  EXPECT_TRUE(field.ok()) << (field.ok() ? "" : field.error().message);
  return field.ok() ? *field : SizingField{};
}
template <class Shape, class Asks>
SizingField field_of(const Shape& shape, const Asks& asks) {
  return field_of(std::vector{SizingObject{"gate", "", shape, asks}});
}

/// Size asked along u.
double size_along(const Metric<3>& m, const Vec<3>& u) {
  return 1 / metric_length<3>(u.normalized(), m);
}

void expect_near(const Metric<3>& a, const Metric<3>& b, double relative = kRound) {
  EXPECT_LE((a - b).norm(), relative * b.norm()) << a << "\n\n" << b;
}

/// a asks in no direction for a larger size than b: a - b has no negative eigenvalue.
void expect_no_coarser(const Metric<3>& a, const Metric<3>& b) {
  EXPECT_GE(spectrum<3>(Mat<3>(a - b)).values[0], -kRound * a.norm());
}

Metric<3> wall() { return metric_from_sizes<3>(Mat<3>::Identity(), Vec<3>(8, 4, 0.5)); }

TEST(SizingField, WithoutObjectsTheNaturalMetricStays) {
  std::mt19937 rng(1);
  const Metric<3> natural = test::random_metric<3>(rng, 100);
  EXPECT_EQ(SizingField().apply(kX, natural), natural);
  EXPECT_EQ(field_of({}).apply(kX, natural), natural);
  EXPECT_TRUE(field_of({}).empty());
}

/// A point at the distance d from a shape, for several distances.
struct Case {
  SizingShape shape;
  Vec<3> inside, border, outward;
};
std::vector<Case> cases() {
  const double s = std::sqrt(0.5);
  BoxShape turned;
  turned.center = {1, 2, 3};
  turned.size = {2, 4, 6};
  turned.x_axis = {3, 3, 0};
  turned.y_axis = {0, 1, 0};  // only its part across x counts
  FacesShape top, deep;
  top.ids = {5};
  deep.names = {"top"};
  deep.depth = 0.25;
  return {
      {SphereShape{{1, 2, 3}, 2}, {1, 3, 3.5}, {1, 2, 5}, kZ},
      {BoxShape{{1, 2, 3}, {2, 4, 6}}, {1.5, 1, 5}, {2, 2, 3}, kX},
      // Off an edge of the box the distance goes across the corner.
      {BoxShape{{0, 0, 0}, {2, 2, 6}}, {0.9, 0.9, 2}, {1, 1, 1}, kX + kY},
      {turned, Vec<3>(1, 2, 3) + 0.9 * Vec<3>(s, s, 0), Vec<3>(1, 2, 3) + Vec<3>(s, s, 0), kX + kY},
      {CylinderShape{{0, 0, 0}, {0, 4, 0}, 1.5}, {1, 3, 1}, {0, 2, 1.5}, kZ},
      {CylinderShape{{0, 0, 0}, {0, 4, 0}, 1.5}, {0, 0.1, 0}, {1, 4, 0}, kY},
      {top, {3, 4, 2}, {3, 4, 2}, kZ},
      {deep, {3, 4, 1.9}, {3, 4, 1.75}, -kZ}};
}

TEST(SizingField, InsideAShapeTheSizeIsTheTargetAndOutsideItGrows) {
  const double slope = std::log(1.3);
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.shape.index());
    const SizingField field = field_of(c.shape, size_of(0.2));
    const Metric<3> natural = isotropic_metric<3>(1.2);
    expect_near(field.apply(c.inside, natural), isotropic_metric<3>(0.2));
    expect_near(field.apply(c.border, natural), isotropic_metric<3>(0.2));
    for (const double d : {0.3, 1.0, 3.0})
      expect_near(field.apply(c.border + d * c.outward.normalized(), natural),
                  isotropic_metric<3>(0.2 + d * slope));
    // From where the natural size is reached on, it is the natural metric itself.
    const double end = 1 / slope;
    EXPECT_EQ(field.apply(c.border + 1.001 * end * c.outward.normalized(), natural), natural);
  }
}

TEST(SizingField, AnIsotropicTargetOnlyShrinksTheSizesAboveIt) {
  const SizingField field = field_of(SphereShape{{0, 0, 0}, 2}, size_of(1));
  expect_near(field.apply(kX, wall()), metric_from_sizes<3>(Mat<3>::Identity(), Vec<3>(1, 1, 0.5)));
  // A target above all sizes changes nothing, to the bit.
  EXPECT_EQ(field_of(SphereShape{{0, 0, 0}, 2}, size_of(9)).apply(kX, wall()), wall());
}

TEST(SizingField, AFactorIsOfTheSmallestNaturalSize) {
  const SphereShape sphere{{0, 0, 0}, 2};
  expect_near(field_of(sphere, factor_of(0.5)).apply(kX, wall()), isotropic_metric<3>(0.25));
  expect_near(field_of(sphere, factor_of(2)).apply(kX, wall()),
              metric_from_sizes<3>(Mat<3>::Identity(), Vec<3>(1, 1, 0.5)));
  expect_near(field_of(sphere, factor_of(0.5)).apply(3 * kX, wall()),
              metric_from_sizes<3>(Mat<3>::Identity(),
                                   Vec<3>(0.25 + std::log(1.3), 0.25 + std::log(1.3), 0.5)));
}

TEST(SizingField, KeptDirectionsKeepTheRatiosToo) {
  std::mt19937 rng(3);
  const SphereShape sphere{{0, 0, 0}, 2};
  for (int i = 0; i < 20; ++i) {
    const Metric<3> natural = test::random_metric<3>(rng, 100);
    const double h1 = sizes<3>(natural)[0];
    for (const double f : {0.1, 0.7}) {
      const Metric<3> finer = natural * eigenvalue_from_size(f);
      expect_near(field_of(sphere, size_of(f * h1, true)).apply(kX, natural), finer, 1e-8);
      expect_near(field_of(sphere, factor_of(f, true)).apply(kX, natural), finer, 1e-8);
      // Outside the smallest size grows like the target does.
      const double d = 0.5 * (1 - f) * h1 / std::log(1.3);
      expect_near(field_of(sphere, size_of(f * h1, true)).apply((2 + d) * kX, natural),
                  natural * eigenvalue_from_size(0.5 * (1 + f)), 1e-8);
    }
    // Never coarser, unless a factor above 1 says so.
    EXPECT_EQ(field_of(sphere, size_of(2 * h1, true)).apply(kX, natural), natural);
    const SizingField coarser = field_of(sphere, factor_of(3, true));
    EXPECT_TRUE(coarser.may_coarsen());
    expect_near(coarser.apply(kX, natural), natural / 9, 1e-8);
    const double d = h1 / std::log(1.3);
    expect_near(coarser.apply((2 + d) * kX, natural), natural / 4, 1e-8);
    EXPECT_EQ(coarser.apply((2 + 2.001 * d) * kX, natural), natural);
  }
}

TEST(SizingField, TheResultIsNoCoarserThanEachOfItsParts) {
  std::mt19937 rng(4);
  AnalyticZone zone;
  zone.frame = CylindricalFrame{{0, 0, 0}, {1, 1, 2}};
  zone.sizes = {0.1, 0.6, 0.3};
  const std::vector<SizingObject> all = {{"a", "", SphereShape{{0, 0, 0}, 1}, size_of(0.3)},
                                         {"b", "", SphereShape{{1, 0, 0}, 1}, size_of(0.05, true)},
                                         {"c", "", SphereShape{{0, 1, 0}, 1}, zone}};
  for (int i = 0; i < 200; ++i) {
    const Vec<3> x = 2 * test::random_vector<3>(rng);
    const Metric<3> natural = test::random_metric<3>(rng, 30);
    const Metric<3> together = field_of(all).apply(x, natural);
    EXPECT_TRUE(is_spd<3>(together));
    expect_no_coarser(together, natural);
    // What each asks for by itself: of next to nothing, or of the metric it scales.
    expect_no_coarser(together, field_of({all[0]}).apply(x, isotropic_metric<3>(1e5)));
    expect_no_coarser(together, field_of({all[1]}).apply(x, natural));
    expect_no_coarser(together, field_of({all[2]}).apply(x, isotropic_metric<3>(1e5)));
  }
}

TEST(SizingField, TurnsWithItsObjects) {
  std::mt19937 rng(5);
  for (int i = 0; i < 50; ++i) {
    const Mat<3> r = test::random_rotation<3>(rng);
    const Vec<3> shift = test::random_vector<3>(rng);
    const auto place = [&](const Vec<3>& x) -> Vec<3> { return r * x + shift; };
    AnalyticZone zone, turned_zone;
    zone.frame = CylindricalFrame{{0.1, 0, 0}, kY};
    turned_zone.frame = CylindricalFrame{place({0.1, 0, 0}), r * kY};
    zone.sizes = turned_zone.sizes = {0.1, 0.6, 0.3};
    AnalyticZone ball = zone, turned_ball = turned_zone;
    ball.frame = SphericalFrame{{0, 0.2, 0}, kX};
    turned_ball.frame = SphericalFrame{place({0, 0.2, 0}), r * kX};
    AnalyticZone plate = zone, turned_plate = turned_zone;
    plate.frame = CartesianFrame{kZ, kX};
    turned_plate.frame = CartesianFrame{r * kZ, r * kX};
    plate.replace = turned_plate.replace = true;
    const std::vector<SizingObject> objects = {
        {"a", "", BoxShape{{0, 0, 0}, {1, 0.4, 0.6}}, size_of(0.1)},
        {"b", "", CylinderShape{{0, 0, 0}, {1, 0, 0}, 0.3}, factor_of(0.5, true)},
        {"c", "", SphereShape{{0, 0, 0}, 0.7}, zone},
        {"d", "", SphereShape{{0.5, 0, 0}, 0.4}, ball},
        {"e", "", SphereShape{{0, 0.5, 0}, 0.4}, plate}};
    const std::vector<SizingObject> turned = {
        {"a", "", BoxShape{place({0, 0, 0}), {1, 0.4, 0.6}, r * kX, r * kY}, size_of(0.1)},
        {"b", "", CylinderShape{place({0, 0, 0}), place({1, 0, 0}), 0.3}, factor_of(0.5, true)},
        {"c", "", SphereShape{place({0, 0, 0}), 0.7}, turned_zone},
        {"d", "", SphereShape{place({0.5, 0, 0}), 0.4}, turned_ball},
        {"e", "", SphereShape{place({0, 0.5, 0}), 0.4}, turned_plate}};
    const Vec<3> x = test::random_vector<3>(rng);
    const Metric<3> natural = test::random_metric<3>(rng, 20);
    expect_near(field_of(turned).apply(place(x), r * natural * r.transpose()),
                r * field_of(objects).apply(x, natural) * r.transpose(), 1e-8);
  }
}

TEST(SizingField, ACartesianZoneHasItsSizesAlongItsAxes) {
  AnalyticZone zone;
  zone.frame = CartesianFrame{{0, 2, 0}, {1, 5, 0}};  // y, then the part of (1, 5, 0) across it
  zone.sizes = {0.1, 0.2, 0.4};
  zone.replace = true;
  const BoxShape box{{5, 5, 1}, {10, 10, 2}};
  const SizingField field = field_of(box, zone);
  EXPECT_TRUE(field.may_coarsen());
  const Metric<3> tiny = isotropic_metric<3>(1e-3);
  for (const Vec<3>& x : {Vec<3>(5, 5, 1), Vec<3>(0, 0, 0), Vec<3>(10, 3, 2)}) {
    const Metric<3> m = field.apply(x, tiny);
    EXPECT_NEAR(size_along(m, kY), 0.1, kRound);
    EXPECT_NEAR(size_along(m, kX), 0.2, kRound);
    EXPECT_NEAR(size_along(m, kZ), 0.4, kRound);
  }
  EXPECT_EQ(field.apply({5, 5, 2.01}, tiny), tiny);
  // Intersected instead, the finer natural metric stays.
  zone.replace = false;
  EXPECT_FALSE(field_of(box, zone).may_coarsen());
  expect_near(field_of(box, zone).apply({5, 5, 1}, tiny), tiny);
}

TEST(SizingField, ACylindricalZoneFollowsItsAxisAtEveryAngleAndNearIt) {
  std::mt19937 rng(6);
  const Mat<3> frame = test::random_rotation<3>(rng);
  const Vec<3> origin(1, 2, 3), u = frame.col(0), v = frame.col(1), w = frame.col(2);
  AnalyticZone zone;
  zone.frame = CylindricalFrame{origin, 7 * w};
  zone.sizes = {0.1, 0.5, 2};
  zone.replace = true;
  const SizingField field = field_of(WholeBody{}, zone);
  for (const double r : {1e-9, 1e-3, 1.0, 50.0})
    for (int k = 0; k < 12; ++k) {
      const double theta = 2 * std::numbers::pi * (k + 0.3) / 12;
      const Vec<3> e_r = std::cos(theta) * u + std::sin(theta) * v;
      const Metric<3> m = field.apply(origin + r * e_r + 4 * w, wall());
      const double slack = std::max(1e-8, 1e-14 / r);  // of the place, by its rounding
      EXPECT_NEAR(size_along(m, e_r), 0.1, slack);
      EXPECT_NEAR(size_along(m, w.cross(e_r)), 0.5, 30 * slack);
      EXPECT_NEAR(size_along(m, w), 2, 30 * slack);
    }
  // On the axis, (A.19).
  zone.frame = CylindricalFrame{{0, 0, 0}, kZ};
  expect_near(field_of(WholeBody{}, zone).apply(3 * kZ, wall()),
              metric_from_sizes<3>(Mat<3>::Identity(), Vec<3>(0.1, 0.1, 2)));
}

TEST(SizingField, SizesProgressWithTheRadius) {
  AnalyticZone zone;
  zone.sizes = {0.1, 1, 2};
  RadialProgression p;
  p.from = 1;
  p.to = 3;
  p.sizes = {0.4, 4, 0.5};
  for (const bool round : {false, true})
    for (const bool geometric : {false, true}) {
      p.kind = geometric ? RadialProgression::Kind::geometric : RadialProgression::Kind::linear;
      zone.progression = p;
      if (round)
        zone.frame = SphericalFrame{};
      else
        zone.frame = CylindricalFrame{};
      const SizingField field = field_of(WholeBody{}, zone);
      const Metric<3> natural = isotropic_metric<3>(100);
      const auto at = [&](double r) { return field.apply(r * kX, natural); };
      const Vec<3> middle = geometric ? Vec<3>(0.2, 2, 1) : Vec<3>(0.25, 2.5, 1.25);
      for (const auto& [r, h] : {std::pair{0.5, zone.sizes},
                                 {1.0, zone.sizes},
                                 {2.0, middle},
                                 {3.0, p.sizes},
                                 {9.0, p.sizes}}) {
        EXPECT_NEAR(size_along(at(r), kX), h[0], 1e-8) << r;
        EXPECT_NEAR(size_along(at(r), kY), h[1], 1e-8) << r;
        EXPECT_NEAR(size_along(at(r), kZ), h[2], 1e-8) << r;
      }
    }
}

TEST(SizingField, RefinementsCountFromWhatReplacesTheNaturalMetric) {
  AnalyticZone zone;
  zone.sizes = {2, 2, 2};
  zone.replace = true;
  const SphereShape sphere{{0, 0, 0}, 1};
  // Whatever the order of the list.
  for (const bool first : {false, true}) {
    std::vector<SizingObject> objects = {{"gate", "", sphere, factor_of(0.5)},
                                         {"zone", "", WholeBody{}, zone}};
    if (first) std::swap(objects[0], objects[1]);
    expect_near(field_of(objects).apply({0, 0, 0}, wall()), isotropic_metric<3>(1));
  }
}

TEST(SizingField, FacesAreFoundByNumberAndName) {
  FacesShape ids, names;
  ids.ids = {0, 5};
  names.names = {"left", "top"};
  const SizingField a = field_of(ids, size_of(0.1)), b = field_of(names, size_of(0.1));
  const Metric<3> natural = isotropic_metric<3>(3);
  std::mt19937 rng(8);
  for (int i = 0; i < 50; ++i) {
    const Vec<3> x = (test::random_vector<3>(rng).array() + 1) * Eigen::Array3d(5, 5, 1);
    expect_near(a.apply(x, natural),
                isotropic_metric<3>(std::min(3.0, 0.1 + std::log(1.3) * std::min(x[0], 2 - x[2]))));
    EXPECT_EQ(a.apply(x, natural), b.apply(x, natural));
  }
}

TEST(SizingField, DetailIsTheSmallestExtentNearby) {
  const SizingField field = field_of({{"a", "", SphereShape{{0, 0, 0}, 1}, size_of(1)},
                                      {"b", "", BoxShape{{10, 0, 0}, {4, 0.5, 3}}, size_of(1)},
                                      {"c", "", WholeBody{}, size_of(1)}});
  EXPECT_EQ(field.detail({{0.5, 0.5, 0.5}, {1, 1, 1}}), 2);
  EXPECT_EQ(field.detail({{-9, 0, 0}, {9, 1, 1}}), 0.5);
  EXPECT_TRUE(std::isinf(field.detail({{4, 4, 4}, {5, 5, 5}})));
}

TEST(SizingField, WhatMakesNoSenseIsRefusedByName) {
  const SphereShape sphere{{0, 0, 0}, 1};
  const auto with = [](auto change) {
    SizeCorrection c = size_of(1);
    change(c);
    return c;
  };
  const auto zone_with = [](auto change) {
    AnalyticZone z;
    z.sizes = {1, 1, 1};
    z.frame = CylindricalFrame{};
    change(z);
    return z;
  };
  const double nan = std::nan("");
  BoxShape parallel{{0, 0, 0}, {1, 1, 1}};
  parallel.y_axis = {-2, 0, 0};
  BoxShape no_axis{{0, 0, 0}, {1, 1, 1}};
  no_axis.x_axis = {0, 0, 0};
  FacesShape unknown_id, negative_id, unknown_name, deep;
  unknown_id.ids = {6};
  negative_id.ids = {-1};
  unknown_name.names = {"lid"};
  deep.ids = {1};
  deep.depth = -1;
  const std::vector<std::pair<SizingObject, std::string>> bad = {
      {{"o", "", SphereShape{{0, 0, 0}, 0}, size_of(1)}, "radius"},
      {{"o", "", SphereShape{{nan, 0, 0}, 1}, size_of(1)}, "sphere"},
      {{"o", "", BoxShape{{0, 0, 0}, {1, 0, 1}}, size_of(1)}, "empty"},
      {{"o", "", parallel, size_of(1)}, "parallel"},
      {{"o", "", no_axis, size_of(1)}, "axis"},
      {{"o", "", CylinderShape{{1, 1, 1}, {1, 1, 1}, 1}, size_of(1)}, "empty"},
      {{"o", "", CylinderShape{{1, 1, 1}, {1, 1, 2}, 0}, size_of(1)}, "empty"},
      {{"o", "", FacesShape{}, size_of(1)}, "no face"},
      {{"o", "", unknown_id, size_of(1)}, "no face 6"},
      {{"o", "", negative_id, size_of(1)}, "no face -1"},
      {{"o", "", unknown_name, size_of(1)}, "\"lid\""},
      {{"o", "", deep, size_of(1)}, "depth"},
      {{"o", "", sphere, SizeCorrection{}}, "either"},
      {{"o", "", sphere, with([](auto& c) { c.factor = 1; })}, "either"},
      {{"o", "", sphere, with([](auto& c) { c.size = 0; })}, "not positive"},
      {{"o", "", sphere, with([](auto& c) { c.size = -1; })}, "not positive"},
      {{"o", "", sphere, factor_of(0)}, "not positive"},
      {{"o", "", sphere, with([](auto& c) { c.gradation = 0.9; })}, "gradation"},
      {{"o", "", sphere, with([](auto& c) { c.gradation = 1; })}, "gradation"},
      {{"o", "", sphere, zone_with([](auto& z) { z.sizes[1] = 0; })}, "not positive"},
      {{"o", "", sphere, zone_with([](auto& z) {
          z.frame = CylindricalFrame{{0, 0, 0}, {0, 0, 0}};
        })},
       "axis"},
      {{"o", "", sphere, zone_with([](auto& z) {
          z.progression = {RadialProgression::Kind::linear, 2, 1, {1, 1, 1}};
        })},
       "radii"},
      {{"o", "", sphere, zone_with([](auto& z) {
          z.progression = {RadialProgression::Kind::linear, 0, 1, {1, 0, 1}};
        })},
       "not positive"},
      {{"o", "", sphere, zone_with([](auto& z) {
          z.frame = CartesianFrame{};
          z.progression = {RadialProgression::Kind::linear, 0, 1, {1, 1, 1}};
        })},
       "Cartesian"}};
  for (const auto& [object, named] : bad) {
    const Result<SizingField> field = SizingField::make({object}, named_box());
    ASSERT_FALSE(field.ok()) << named;
    EXPECT_EQ(field.error().code, Code::usage);
    EXPECT_NE(field.error().message.find("\"o\""), std::string::npos) << field.error().message;
    EXPECT_NE(field.error().message.find(named), std::string::npos) << field.error().message;
    EXPECT_FALSE(field.error().hint.empty());
  }
}

TEST(SizingField, ABoundaryLayerIsThinAcrossItsFacesOnly) {
  FacesShape top;
  top.names = {"top"};
  BoundaryLayer asked;
  asked.thickness = 0.3;
  asked.layers = 3;
  const SizingField field = field_of({{"skin", "", top, asked}});
  const Metric<3> natural = isotropic_metric<3>(1);
  const double across = size_from_eigenvalue(field.apply({5, 5, 1.9}, natural)(2, 2));
  // A little finer than the third of it, the same throughout the layer.
  EXPECT_LT(across, 0.1);
  EXPECT_GT(across, 0.08);
  for (const double depth : {0.0, 0.2, 0.299}) {
    const Metric<3> m = field.apply({4, 6, 2 - depth}, natural);
    EXPECT_NEAR(size_from_eigenvalue(m(2, 2)), across, 1e-9);
    EXPECT_NEAR(m(0, 0), 1, 1e-9);
    EXPECT_NEAR(m(1, 1), 1, 1e-9);
  }
  const Metric<3> beyond = field.apply({5, 5, 1.5}, natural);
  EXPECT_NEAR(size_from_eigenvalue(beyond(2, 2)), across + 0.2 * std::log(1.5), 1e-9);
  EXPECT_EQ(field.apply({5, 5, 0.1}, isotropic_metric<3>(0.2)), isotropic_metric<3>(0.2));

  FacesShape others = top;
  others.others = true;
  const SizingField rest = field_of({{"skin", "", others, asked}});
  EXPECT_EQ(rest.apply({5, 5, 1.9}, isotropic_metric<3>(0.2)), isotropic_metric<3>(0.2));
  EXPECT_GT(rest.apply({9.9, 5, 1}, natural)(0, 0), 100);
  asked.thickness = 0;
  const SizingObject none{"skin", "", top, asked};
  EXPECT_EQ(SizingField::make({none}, named_box()).error().code, Code::usage);
  SizingObject sphere{"skin", "", SphereShape{kX, 1}, BoundaryLayer{0.3, 3, 1.5}};
  EXPECT_EQ(SizingField::make({sphere}, named_box()).error().code, Code::usage);
}

}  // namespace
}  // namespace lamella
