#include "core/flow/correction.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "core/mesh/quality.h"
#include "core/mesh/sample_meshes.h"
#include "tests/support/random_metric.h"

namespace lamella {
namespace {

template <class T>
class FlowCorrection : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(FlowCorrection, Dimensions);

template <int D>
std::vector<double> scalar(const SimplexMesh<D>& mesh, const Vec<D>& along) {
  std::vector<double> out;
  for (const Vec<D>& x : mesh.points) out.push_back(along.dot(x) + 3);
  return out;
}

template <int D>
Corrected<D> value(Result<Corrected<D>> r) {
  EXPECT_TRUE(r.ok()) << (r.ok() ? "" : r.error().message);
  return std::move(*r);
}

template <int D>
double forecast(const SimplexMesh<D>& mesh, const MetricField<D>& metric) {
  return allocation_factor<D>(mesh, metric) * static_cast<double>(mesh.elements.size());
}

TYPED_TEST(FlowCorrection, CurvatureIsThatOfAQuadraticFieldAndNoneOfALinearOne) {
  constexpr int D = TypeParam::value;
  const auto mesh = unit_box<D>(8);
  std::vector<Vec<D>> linear, quadratic;
  for (const Vec<D>& x : mesh.points) {
    linear.push_back(x[1] * Vec<D>::Unit(0));
    quadratic.push_back(x[1] * x[1] * (3 * Vec<D>::Unit(0) + 4 * Vec<D>::Unit(1)));
  }
  for (const Mat<D>& t : curvature_tensors<D>(mesh, linear)) EXPECT_LT(t.norm(), 1e-6);
  const auto found = curvature_tensors<D>(mesh, quadratic);
  // Means of gradients are exact where all neighbors lie inside, too.
  std::size_t checked = 0;
  for (std::size_t n = 1; n < mesh.points.size(); ++n) {
    if ((mesh.points[n] - Vec<D>::Constant(0.5)).cwiseAbs().maxCoeff() > 0.3) continue;
    EXPECT_LT((found[n] - 10 * Vec<D>::Unit(1) * Vec<D>::Unit(1).transpose()).norm(), 1e-6);
    ++checked;
  }
  EXPECT_GT(checked, 20u);
  // Of a linear field (5.7) is all there is; scaling the field changes nothing.
  const auto combined = combined_tensors<D>(mesh, linear);
  for (std::size_t n = 1; n < combined.size(); ++n) EXPECT_NEAR(combined[n](1, 1), 1, 1e-3);
  std::vector<Vec<D>> larger = quadratic;
  for (Vec<D>& v : larger) v *= 1000;
  const auto one = combined_tensors<D>(mesh, quadratic), other = combined_tensors<D>(mesh, larger);
  for (std::size_t n = 1; n < one.size(); ++n) EXPECT_LT((one[n] - other[n]).norm(), 1e-6);
}

TYPED_TEST(FlowCorrection, TensorsOfLinearFieldsAreTheirs) {
  constexpr int D = TypeParam::value;
  const auto mesh = unit_box<D>(2);
  Mat<D> g = Mat<D>::Identity();
  g(0, 1) = 2;
  g(1, 1) = -3;
  std::vector<Vec<D>> v;
  for (const Vec<D>& x : mesh.points) v.push_back(g * x);
  const Vec<D> along = g.row(0).transpose();
  for (std::size_t n = 1; n < mesh.points.size(); ++n) {
    EXPECT_LT(
        (gradient_tensors<D>(mesh, scalar<D>(mesh, along))[n] - along * along.transpose()).norm(),
        1e-10);
    EXPECT_LT((gradient_tensors<D>(mesh, v)[n] - g.transpose() * g).norm(), 1e-10);
    // |eps| has the square of eps and is not negative.
    const Mat<D> strain = 0.5 * (g + g.transpose()), found = strain_tensors<D>(mesh, v)[n];
    EXPECT_LT((found * found - strain * strain).norm(), 1e-10);
    EXPECT_GT(spectrum<D>(found).values[0], -1e-12);
  }
}

// (5.6): only the size along the gradient changes, by sqrt(1 + 256 strength^2) at the strongest.
TYPED_TEST(FlowCorrection, OnlyTheSizeAlongTheGradientChanges) {
  constexpr int D = TypeParam::value;
  const auto mesh = unit_box<D>(3);
  const Vec<D> along = Vec<D>::Ones().normalized();
  const MetricField<D> metric(mesh.points.size(), isotropic_metric<D>(0.5));
  for (const double strength : {1.0, 0.25}) {
    AddParams params;
    params.strength = strength;
    const auto found = value<D>(
        add_tensors<D>(mesh, metric, gradient_tensors<D>(mesh, scalar<D>(mesh, along)), params));
    for (std::size_t n = 1; n < mesh.points.size(); ++n) {
      EXPECT_NEAR(along.dot(found.metric[n] * along), 4 * (1 + 256 * strength * strength), 1e-6);
      EXPECT_LT(
          (found.metric[n] - metric[n] - 4 * 256 * strength * strength * along * along.transpose())
              .norm(),
          1e-6);
    }
    EXPECT_NEAR(found.elements_after, forecast<D>(mesh, found.metric), 1e-9 * found.elements_after);
  }
}

TYPED_TEST(FlowCorrection, AConstantFieldCorrectsNothing) {
  constexpr int D = TypeParam::value;
  const auto mesh = unit_box<D>(3);
  std::mt19937 rng(2);
  MetricField<D> metric;
  for (std::size_t n = 0; n < mesh.points.size(); ++n)
    metric.push_back(test::random_metric<D>(rng, 10));
  const std::vector<double> field(mesh.points.size(), 0.0);
  EXPECT_EQ(value<D>(add_tensors<D>(mesh, metric, gradient_tensors<D>(mesh, field))).metric,
            metric);
}

TYPED_TEST(FlowCorrection, UnitsOfTheFieldDoNotMatterAndRotationTurnsTheMetric) {
  constexpr int D = TypeParam::value;
  const auto mesh = ball_mesh<D>(4, 1);
  std::vector<double> field, scaled;
  for (const Vec<D>& x : mesh.points) {
    field.push_back(std::sin(2 * x[0]) * x[1]);
    scaled.push_back(1e4 * field.back());
  }
  const MetricField<D> metric(mesh.points.size(), isotropic_metric<D>(0.3));
  const auto a = value<D>(add_tensors<D>(mesh, metric, gradient_tensors<D>(mesh, field)));
  const auto b = value<D>(add_tensors<D>(mesh, metric, gradient_tensors<D>(mesh, scaled)));
  Mat<D> turn = Mat<D>::Identity();
  turn.template topLeftCorner<2, 2>() = Eigen::Rotation2Dd(0.6).toRotationMatrix();
  auto turned = mesh;
  for (Vec<D>& x : turned.points) x = turn * x;
  const auto c = value<D>(add_tensors<D>(turned, metric, gradient_tensors<D>(turned, field)));
  for (std::size_t n = 1; n < metric.size(); ++n) {
    EXPECT_LT((a.metric[n] - b.metric[n]).norm(), 1e-9 * a.metric[n].norm());
    EXPECT_LT((turn * a.metric[n] * turn.transpose() - c.metric[n]).norm(),
              1e-9 * a.metric[n].norm());
  }
}

TYPED_TEST(FlowCorrection, BoundsAndBudgetHold) {
  constexpr int D = TypeParam::value;
  const auto mesh = unit_box<D>(6);
  std::vector<double> field;
  for (const Vec<D>& x : mesh.points) field.push_back(std::tanh(8 * (x[0] - 0.5)));
  const MetricField<D> metric(mesh.points.size(), isotropic_metric<D>(0.2));
  const auto tensors = gradient_tensors<D>(mesh, field);
  AddParams params;
  const auto free = value<D>(add_tensors<D>(mesh, metric, tensors, params));
  params.h_min = 0.05;
  const auto bounded = value<D>(add_tensors<D>(mesh, metric, tensors, params));
  for (std::size_t n = 1; n < metric.size(); ++n)
    EXPECT_GT(sizes<D>(bounded.metric[n])[0], 0.05 * (1 - 1e-9));
  EXPECT_LT(bounded.elements_after, free.elements_after);

  params = {};
  params.elements = 0.5 * (free.elements_before + free.elements_after);
  const auto within = value<D>(add_tensors<D>(mesh, metric, tensors, params));
  EXPECT_LE(forecast<D>(mesh, within.metric), *params.elements);
  EXPECT_GT(forecast<D>(mesh, within.metric), 0.98 * *params.elements);
  // The metric given is still in it.
  for (std::size_t n = 1; n < metric.size(); ++n)
    EXPECT_GT(spectrum<D>(Mat<D>(within.metric[n] - metric[n])).values[0], -1e-9);
  params.elements = 0.5 * free.elements_before;
  const auto coarse = value<D>(add_tensors<D>(mesh, metric, tensors, params));
  EXPECT_NEAR(forecast<D>(mesh, coarse.metric) / *params.elements, 1, 0.01);
}

// With the mesh's own metric the elements forecast are card(T) beta^-D, (5.10): exactly so where
// elements are alike.
TYPED_TEST(FlowCorrection, EqualErrorsScaleTheMetricByBeta) {
  constexpr int D = TypeParam::value;
  const auto mesh = unit_box<D>(3);
  const auto metric = own_metric<D>(mesh);
  const std::vector<double> even(mesh.elements.size(), 0.7);
  for (const double beta : {1.0, 0.5, 2.0}) {
    UniformizeParams params;
    params.beta = beta;
    const auto found = value<D>(uniformize<D>(mesh, metric, even, params));
    EXPECT_NEAR(found.elements_after, found.elements_before * std::pow(beta, -D),
                1e-9 * found.elements_after);
    for (std::size_t n = 1; n < metric.size(); ++n)
      EXPECT_LT((found.metric[n] - metric[n] / (beta * beta)).norm(), 1e-9 * metric[n].norm());
  }
  UniformizeParams params;
  params.elements = 1000;
  EXPECT_NEAR(value<D>(uniformize<D>(mesh, metric, even, params)).elements_after, 1000, 10);
}

// Smoothing keeps the elements: (5.14) for an indicator that varies, on elements that are alike.
TYPED_TEST(FlowCorrection, SmoothingRefinesWhereTheErrorIsLarge) {
  constexpr int D = TypeParam::value;
  const auto mesh = unit_box<D>(D == 2 ? 24 : 10);
  const auto metric = own_metric<D>(mesh);
  std::vector<double> indicator;
  for (const auto& e : mesh.elements) {
    Vec<D> x = Vec<D>::Zero();
    for (const NodeId n : e) x += mesh.points[n] / (D + 1);
    indicator.push_back(std::exp(2 * x[0]));
  }
  const auto found = value<D>(uniformize<D>(mesh, metric, indicator));
  EXPECT_NEAR(found.elements_after / found.elements_before, 1, 0.03);
  NodeId low = 1, high = 1;
  for (NodeId n = 1; n < static_cast<NodeId>(mesh.points.size()); ++n) {
    if (mesh.points[n].sum() < mesh.points[low].sum()) low = n;
    if (mesh.points[n].sum() > mesh.points[high].sum()) high = n;
  }
  // alpha^(2 / (2 p + D)) of the indicator sets the ratio of the sizes.
  const double asked = std::exp(2 * 2.0 / (2 + D));
  const double ratio = std::sqrt((found.metric[high] * metric[high].inverse()).determinant() /
                                 (found.metric[low] * metric[low].inverse()).determinant());
  EXPECT_NEAR(std::pow(ratio, 1.0 / D), asked, 0.1 * asked);
}

TEST(FlowCorrectionErrors, AreValues) {
  const auto mesh = unit_box<2>(2);
  const MetricField<2> metric(mesh.points.size(), isotropic_metric<2>(1));
  std::vector<Mat<2>> tensors(mesh.points.size(), Mat<2>::Identity());
  AddParams params;
  params.strength = -1;
  EXPECT_EQ(add_tensors<2>(mesh, metric, tensors, params).error().code, Code::usage);
  params = {};
  params.h_min = 0;
  EXPECT_EQ(add_tensors<2>(mesh, metric, tensors, params).error().code, Code::usage);
  tensors[2](0, 0) = std::nan("");
  EXPECT_EQ(add_tensors<2>(mesh, metric, tensors).error().code, Code::bad_input);
  tensors.pop_back();
  EXPECT_EQ(add_tensors<2>(mesh, metric, tensors).error().code, Code::bad_input);
  std::vector<double> indicator(mesh.elements.size(), 1);
  UniformizeParams uniform;
  uniform.beta = 0;
  EXPECT_EQ(uniformize<2>(mesh, metric, indicator, uniform).error().code, Code::usage);
  indicator[0] = -1;
  EXPECT_EQ(uniformize<2>(mesh, metric, indicator).error().code, Code::bad_input);
}

}  // namespace
}  // namespace lamella
