#include "core/metric/analytic.h"

#include <gtest/gtest.h>

#include "tests/support/random_metric.h"

namespace lamella {
namespace {

/// Size asked at x along the direction u.
template <int D>
double size_along(const MetricFunction<D>& metric, const Vec<D>& x, const Vec<D>& u) {
  return 1 / metric_length<D>(u.normalized(), metric(x));
}

MetricFunction<3> named(const std::string& specification) {
  const auto result = named_metric<3>(specification);
  EXPECT_TRUE(result.ok()) << result.error().message;
  return *result;
}

const Vec<3> kX = Vec<3>::UnitX(), kY = Vec<3>::UnitY(), kZ = Vec<3>::UnitZ();

TEST(AnalyticMetric, CartesianAsksForItsSizesEverywhere) {
  std::mt19937 rng(2);
  const Mat<3> axes = test::random_rotation<3>(rng);
  const auto metric = cartesian_metric<3>(axes, Vec<3>(0.1, 0.2, 3));
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(size_along<3>(metric, test::random_vector<3>(rng), axes.col(k)),
                (Vec<3>(0.1, 0.2, 3)[k]), 1e-9);
}

TEST(AnalyticMetric, PolarFollowsTheRadius) {
  const Vec<2> origin(1, -2);
  const auto metric = polar_metric(origin, 0.1, 0.5);
  const Vec<2> u = Vec<2>(3, 4) / 5;
  EXPECT_NEAR(size_along<2>(metric, origin + 7 * u, u), 0.1, 1e-12);
  EXPECT_NEAR(size_along<2>(metric, origin + 7 * u, Vec<2>(-u[1], u[0])), 0.5, 1e-12);
  EXPECT_EQ(metric(origin), isotropic_metric<2>(0.1));
}

TEST(AnalyticMetric, CylindricalFollowsItsAxis) {
  std::mt19937 rng(4);
  const Mat<3> r = test::random_rotation<3>(rng);  // columns: radius, around, axis
  const Vec<3> origin(1, 2, 3);
  const auto metric = cylindrical_metric(origin, 5 * r.col(2), 0.1, 0.2, 0.4);
  const Vec<3> x = origin + 2 * r.col(0) - 3 * r.col(2);
  EXPECT_NEAR(size_along<3>(metric, x, r.col(0)), 0.1, 1e-9);
  EXPECT_NEAR(size_along<3>(metric, x, r.col(1)), 0.2, 1e-9);
  EXPECT_NEAR(size_along<3>(metric, x, r.col(2)), 0.4, 1e-9);
  // On the axis, (A.19).
  const auto upright = cylindrical_metric(Vec<3>::Zero(), kZ, 0.1, 0.2, 0.4);
  EXPECT_NEAR(size_along<3>(upright, 2 * kZ, kX), 0.1, 1e-12);
  EXPECT_NEAR(size_along<3>(upright, 2 * kZ, kY), 0.1, 1e-12);
  EXPECT_NEAR(size_along<3>(upright, 2 * kZ, kZ), 0.4, 1e-12);
}

TEST(AnalyticMetric, SphericalFollowsRadiusLongitudeAndLatitude) {
  const Vec<3> origin(1, 2, 3);
  const auto metric = spherical_metric(origin, 0.1, 0.2, 0.4);
  const double theta = 0.7, phi = 0.3;
  const Vec<3> e_r(std::cos(theta) * std::cos(phi), std::sin(theta) * std::cos(phi), std::sin(phi));
  const Vec<3> e_theta(-std::sin(theta), std::cos(theta), 0), e_phi = e_r.cross(e_theta);
  const Vec<3> x = origin + 5 * e_r;
  EXPECT_NEAR(size_along<3>(metric, x, e_r), 0.1, 1e-9);
  EXPECT_NEAR(size_along<3>(metric, x, e_theta), 0.2, 1e-9);
  EXPECT_NEAR(size_along<3>(metric, x, e_phi), 0.4, 1e-9);
  EXPECT_EQ(metric(origin), isotropic_metric<3>(0.1));
  EXPECT_NEAR(size_along<3>(metric, origin + kZ, kZ), 0.1, 1e-12);
  EXPECT_NEAR(size_along<3>(metric, origin + kZ, kX), 0.4, 1e-12);
}

TEST(NamedMetric, ConstantOnes) {
  const Vec<3> x(0.3, 0.2, 0.1);
  EXPECT_EQ(named("uniform")(x), isotropic_metric<3>(0.1));
  EXPECT_EQ(named("uniform:h=0.02")(x), isotropic_metric<3>(0.02));
  const auto m = named("constaniso:hz=.001,hx=2");
  EXPECT_DOUBLE_EQ(size_along<3>(m, x, kX), 2);
  EXPECT_DOUBLE_EQ(size_along<3>(m, x, kY), 0.1);
  EXPECT_DOUBLE_EQ(size_along<3>(m, x, kZ), 0.001);
}

TEST(NamedMetric, SheetsAreThinnestInTheirMiddle) {
  const auto linear = named("linear");
  EXPECT_NEAR(size_along<3>(linear, Vec<3>(.1, .9, 0.5), kZ), 0.001, 1e-12);
  EXPECT_NEAR(size_along<3>(linear, Vec<3>(.1, .9, 0), kZ), 0.1, 1e-12);
  EXPECT_NEAR(size_along<3>(linear, Vec<3>(.1, .9, 0.75), kZ), 0.0505, 1e-12);
  EXPECT_NEAR(size_along<3>(linear, Vec<3>(.1, .9, 0.5), kX), 0.1, 1e-12);
  EXPECT_NEAR(size_along<3>(named("linear:h0=0.02"), Vec<3>(0, 0, 0.5), kZ), 0.02, 1e-12);
  const Vec<3> u(0.6, 0.8, 0), v(-0.8, 0.6, 0);
  for (const std::string name : {"polar-1", "polar-2"}) {
    const auto polar = named(name);
    EXPECT_NEAR(size_along<3>(polar, 0.5 * u + kZ, u), 0.001, 1e-12) << name;
    EXPECT_NEAR(size_along<3>(polar, 1.0 * u, u), 0.1, 1e-9) << name;
    EXPECT_NEAR(size_along<3>(polar, 0.5 * u, kZ), 0.1, 1e-12) << name;
    EXPECT_NEAR(size_along<3>(polar, 0.9 * u, v), 0.1, 1e-9) << name;
    EXPECT_TRUE(is_spd<3>(polar(Vec<3>::Zero()))) << name;
  }
  EXPECT_NEAR(size_along<3>(named("polar-1"), 0.5 * u, v), 0.1, 1e-9);
  EXPECT_NEAR(size_along<3>(named("polar-2"), 0.5 * u, v), 0.025, 1e-9);
  EXPECT_NEAR(size_along<3>(named("polar-2"), 0.55 * u, v), 0.0625, 1e-9);
}

TEST(NamedMetric, GeorgeAndBorouchakiIsContinuousAndMeetsItsFigures) {
  const auto metric = *named_metric<2>("gb2d");
  const Vec<2> x = Vec<2>::UnitX(), y = Vec<2>::UnitY();
  const auto hx = [&](double t) { return size_along<2>(metric, Vec<2>(t, 0), x); };
  const auto hy = [&](double t) { return size_along<2>(metric, Vec<2>(0, t), y); };
  for (const auto& [t, h] : {std::pair{0.0, 1.0}, {2, 0.05}, {3.5, 1}, {5, 0.2}, {7, 1}})
    EXPECT_NEAR(hx(t), h, 1e-12) << t;
  for (const auto& [t, h] : {std::pair{0.0, 1.0}, {2, 0.05}, {4.5, 1}, {7, 0.2}, {9, 1}})
    EXPECT_NEAR(hy(t), h, 1e-12) << t;
  for (const double t : {2.0, 3.5, 4.5, 5.0, 7.0}) {
    EXPECT_NEAR(hx(t - 1e-9), hx(t + 1e-9), 1e-7);
    EXPECT_NEAR(hy(t - 1e-9), hy(t + 1e-9), 1e-7);
  }
  const auto isotropic = *named_metric<2>("gb2d-iso");
  EXPECT_LT((isotropic(Vec<2>(2, 4.5)) - isotropic_metric<2>(0.05)).norm(), 1e-9);
}

TEST(NamedMetric, ThinBoxScalesTheRectangle) {
  const auto box = named("thinbox"), iso = named("thinbox-iso:s=5,ht=0.02");
  const Vec<3> x(0.05, 2 / 7.0, 2 / 9.0);
  EXPECT_NEAR(size_along<3>(box, x, kX), 0.05, 1e-12);
  EXPECT_NEAR(size_along<3>(box, x, kY), 0.005, 1e-12);
  EXPECT_NEAR(size_along<3>(box, x, kZ), 0.005, 1e-12);
  EXPECT_NEAR(size_along<3>(iso, x, kX), 0.01, 1e-12);
  EXPECT_NEAR(size_along<3>(iso, Vec<3>(0, 0, 0), kX), 0.02, 1e-12);
}

TEST(NamedMetric, In2DIsTheBlockOfThePlane) {
  for (const std::string& name : metric_names()) {
    const auto flat = named_metric<2>(name);
    ASSERT_EQ(flat.ok(), name != "tesseract-linear") << name;
    if (!flat) continue;
    const Vec<2> x(0.31, 0.47);
    EXPECT_EQ((*flat)(x), (Metric<2>(named(name)(Vec<3>(x[0], x[1], 0)).topLeftCorner<2, 2>())));
    EXPECT_TRUE(is_spd<2>((*flat)(x)));
  }
  EXPECT_EQ(metric_names().size(), 10u);
}

TEST(NamedMetric, In4DTheLastAxisIsTime) {
  const auto along = [](const std::string& name, const Vec<4>& x) {
    const auto metric = named_metric<4>(name);
    EXPECT_TRUE(metric.ok()) << name;
    Vec<4> h;
    for (int k = 0; k < 4; ++k) h[k] = size_along<4>(*metric, x, Vec<4>::Unit(k));
    return h;
  };
  const Vec<4> x(0.1, 0.9, 0.2, 0.5);
  EXPECT_LT((along("uniform:h=0.3", x) - Vec<4>::Constant(0.3)).norm(), 1e-12);
  EXPECT_LT((along("constaniso:hy=1,ht=0.01", x) - Vec<4>(0.1, 1, 0.1, 0.01)).norm(), 1e-12);
  EXPECT_LT((along("tesseract-linear", x) - Vec<4>(0.25, 0.25, 0.25, 0.0025)).norm(), 1e-12);
  for (const double t : {0.0, 1.0})
    EXPECT_NEAR(along("tesseract-linear", Vec<4>(0, 0, 0, t))[3], 0.25, 1e-12);
  EXPECT_NEAR(along("tesseract-linear", Vec<4>(0, 0, 0, 0.75))[3], 0.0025 + 0.2475 / 2, 1e-12);
  EXPECT_NEAR(along("tesseract-linear:h0=0.05", x)[3], 0.05, 1e-12);
  const auto refused = named_metric<4>("polar-1");
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, Code::usage);
  EXPECT_NE(refused.error().hint.find("uniform, constaniso, tesseract-linear"), std::string::npos);
}

TEST(NamedMetric, RefusesWhatItDoesNotKnow) {
  const auto refused = [](const std::string& text, const std::string& words) {
    const auto r = named_metric<3>(text);
    ASSERT_FALSE(r.ok()) << text;
    EXPECT_EQ(r.error().code, Code::usage);
    const std::string all = r.error().message + r.error().hint;
    EXPECT_NE(all.find(words), std::string::npos) << all;
  };
  refused("unform", "uniform, constaniso, linear, polar-1, polar-2, gb2d");
  refused("", "no metric called ''");
  refused("uniform:size=1", "It has: h.");
  refused("gb2d:h=1", "It has none.");
  refused("uniform:h=", "not a positive number");
  refused("uniform:h", "not a positive number");
  refused("uniform:", "no parameter ''");
  refused("uniform:h=-1", "not a positive number");
  refused("uniform:h=0.1x", "not a positive number");
  refused("uniform:h=inf", "not a positive number");
  refused("constaniso:hx=1,", "no parameter ''");
}

TEST(SampleMetric, LeavesTheVirtualNodeAlone) {
  const auto field =
      sample_metric<3>(named("uniform:h=0.5"), {Vec<3>::Zero(), Vec<3>::Ones(), Vec<3>::Zero()});
  ASSERT_EQ(field.size(), 3u);
  EXPECT_EQ(field[0], Metric<3>::Identity());
  EXPECT_EQ(field[2], isotropic_metric<3>(0.5));
}

}  // namespace
}  // namespace lamella
