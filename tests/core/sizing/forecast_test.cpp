#include "core/sizing/forecast.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/mesh/sample_meshes.h"
#include "core/metric/analytic.h"
#include "core/optimize/adapt.h"

namespace lamella {
namespace {

MetricFunction<3> uniform(double h) {
  return [m = isotropic_metric<3>(h)](const Vec<3>&) { return m; };
}

SizingField gate(const Vec<3>& center, double radius, double size, double gradation = 1.3) {
  SizeCorrection c;
  c.size = size;
  c.gradation = gradation;
  return SizingField::make({{"gate", "", SphereShape{center, radius}, c}}, {}).value();
}

SizingForecast forecast(const SimplexMesh<3>& mesh, const MetricFunction<3>& natural,
                        const SizingField& sizing = {}, const ForecastParams& params = {}) {
  const Result<SizingForecast> result = forecast_mesh(mesh, natural, sizing, params);
  EXPECT_TRUE(result.ok());
  return result.ok() ? *result : SizingForecast{};
}

TEST(Forecast, AUniformMetricIsCountedExactlyWhateverTheMesh) {
  const double coarse = forecast(unit_box<3>(1), uniform(0.1)).natural.elements;
  const double fine = forecast(unit_box<3>(5), uniform(0.1)).natural.elements;
  EXPECT_NEAR(fine, coarse, 1e-9 * coarse);
  EXPECT_NEAR(forecast(unit_box<3>(2), uniform(0.05)).natural.elements, 8 * coarse, 1e-9 * coarse);
  const SizingForecast f = forecast(unit_box<3>(2), uniform(0.1));
  EXPECT_EQ(f.natural.nodes, f.corrected.nodes);
  EXPECT_GT(f.natural.memory, 0);
}

TEST(Forecast, AThinWallHasMoreNodesAnElement) {
  const auto nodes_an_element = [](double thickness) {
    const auto mesh = box_mesh<3>({4, 4, 1}, Vec<3>::Zero(), Vec<3>(1, 1, thickness));
    const MeshForecast f = forecast(mesh, uniform(0.05)).natural;
    return f.nodes / f.elements;
  };
  EXPECT_GT(nodes_an_element(0.1), 1.1 * nodes_an_element(0.2));
  EXPECT_GT(nodes_an_element(0.2), 1.1 * nodes_an_element(1));
}

TEST(Forecast, ASmallSphereInALargeElementIsNotMissed) {
  // Elements of 4 and a gate of radius 0.3 within one of them; the integral outside by a sum.
  const double radius = 0.3, size = 0.05, h = 1.5, slope = std::log(1.3);
  double volume = 4 * std::numbers::pi / 3 * std::pow(radius / size, 3);
  double shell = 0;
  const double end = (h - size) / slope, step = 1e-4;
  for (double d = step / 2; d < end; d += step) {
    const double r = radius + d;
    const double share = std::pow(size + slope * d, -3) - std::pow(h, -3);
    shell += 4 * std::numbers::pi * r * r * share * step;
  }
  volume += shell - 4 * std::numbers::pi / 3 * std::pow(radius / h, 3) + 8000 / std::pow(h, 3);
  const auto mesh = box_mesh<3>({5, 5, 5}, Vec<3>::Constant(-10), Vec<3>::Constant(10));
  const SizingForecast f = forecast(mesh, uniform(h), gate({0.4, 0.9, 1.3}, radius, size));
  const double unit = f.natural.elements / (8000 / std::pow(h, 3));
  EXPECT_NEAR(f.corrected.elements / unit, volume, 0.05 * volume);
}

TEST(Forecast, MeetsTheNodesOfTheMeshThatIsAdapted) {
  struct Case {
    Vec<3> size;
    Vec<3> h;
    Vec<3> center;
    double radius, target;
  };
  for (const Case& c : {Case{{1, 1, 1}, {0.25, 0.25, 0.25}, {0.5, 0.5, 1}, 0.15, 0.05},
                        Case{{2, 2, 0.2}, {0.4, 0.4, 0.05}, {0.6, 0.9, 0.2}, 0.2, 0.04}}) {
    const auto mesh = box_mesh<3>({4, 4, 1}, Vec<3>::Zero(), c.size);
    const auto natural = cartesian_metric<3>(Mat<3>::Identity(), c.h);
    const SizingField sizing = gate(c.center, c.radius, c.target);
    const SizingForecast f = forecast(mesh, natural, sizing);
    const MetricFunction<3> plain = natural;
    const MetricFunction<3> corrected = [&](const Vec<3>& x) {
      return sizing.apply(x, natural(x));
    };
    for (const bool with : {false, true}) {
      const MetricFunction<3>& metric = with ? corrected : plain;
      SimplexMesh<3> adapted = mesh;
      for (int i = 0; i < 2; ++i)
        adapted =
            adapt<3>(adapted, sample_metric<3>(metric, adapted.points), nullptr, {}, {}, metric)
                .value()
                .mesh;
      const auto nodes = static_cast<double>(adapted.node_count());
      const MeshForecast& told = with ? f.corrected : f.natural;
      EXPECT_NEAR(told.nodes, nodes, 0.25 * nodes) << with;
      const auto elements = static_cast<double>(adapted.element_count());
      EXPECT_NEAR(told.elements, elements, 0.25 * elements) << with;
    }
  }
}

TEST(Forecast, DoesNotDependOnTheThreads) {
  ForecastParams one, two;
  one.threads = 1;
  two.threads = 2;
  const auto linear = named_metric<3>("linear").value();
  const SizingField sizing = gate({0.5, 0.5, 0}, 0.1, 0.01);
  const SizingForecast a = forecast(unit_box<3>(2), linear, sizing, one);
  const SizingForecast b = forecast(unit_box<3>(2), linear, sizing, two);
  EXPECT_EQ(a.corrected.nodes, b.corrected.nodes);
  EXPECT_EQ(a.natural.nodes, b.natural.nodes);
  EXPECT_EQ(a.samples, b.samples);
}

TEST(Forecast, EndsByItsSamples) {
  ForecastParams few;
  few.samples = 100;
  const auto linear = named_metric<3>("linear").value();
  // A round that has begun is ended: it doubles at the most.
  EXPECT_LT(forecast(unit_box<3>(2), linear, {}, few).samples, 2000u);
  few.samples = 100000;
  EXPECT_GT(forecast(unit_box<3>(2), linear, {}, few).samples, 2000u);
}

TEST(Forecast, RefusesWhatItCannotCount) {
  const auto nothing = forecast_mesh(SimplexMesh<3>{}, uniform(1), {});
  ASSERT_FALSE(nothing.ok());
  EXPECT_EQ(nothing.error().code, Code::bad_input);
  const auto flat = forecast_mesh(unit_box<3>(1),
                                  [](const Vec<3>&) -> Metric<3> { return Metric<3>::Zero(); }, {});
  ASSERT_FALSE(flat.ok());
  EXPECT_EQ(flat.error().code, Code::bad_input);
  std::stop_source stop;
  stop.request_stop();
  const auto cancelled =
      forecast_mesh(unit_box<3>(1), uniform(1), {}, {}, Progress({}, stop.get_token()));
  ASSERT_FALSE(cancelled.ok());
  EXPECT_EQ(cancelled.error().code, Code::cancelled);
}

}  // namespace
}  // namespace lamella
