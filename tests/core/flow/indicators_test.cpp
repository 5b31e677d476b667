#include "core/flow/indicators.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "core/flow/stokes.h"
#include "core/mesh/adjacency.h"
#include "tests/support/flow_meshes.h"

namespace lamella {
namespace {

template <int D>
std::vector<Vec<D>> linear(const SimplexMesh<D>& mesh, const Mat<D>& g, const Vec<D>& at_zero) {
  std::vector<Vec<D>> out;
  for (const Vec<D>& x : mesh.points) out.push_back(g * x + at_zero);
  return out;
}

template <class T>
class FlowIndicators : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(FlowIndicators, Dimensions);

TYPED_TEST(FlowIndicators, LinearFieldsAreSeenExactly) {
  constexpr int D = TypeParam::value;
  const auto mesh = ball_mesh<D>(4, 1.5);
  std::mt19937 rng(5);
  std::normal_distribution<double> any;
  const Mat<D> g = Mat<D>::NullaryExpr([&] { return any(rng); });
  const Vec<D> c = Vec<D>::Ones();
  const auto v = linear<D>(mesh, g, c);
  std::vector<double> u;
  for (const Vec<D>& x : v) u.push_back(x[0]);
  for (const Mat<D>& found : element_gradients<D>(mesh, v)) EXPECT_LT((found - g).norm(), 1e-12);
  for (const Vec<D>& found : element_gradients<D>(mesh, u))
    EXPECT_LT((found - g.row(0).transpose()).norm(), 1e-12);
  const Mat<D> strain = 0.5 * (g + g.transpose());
  for (const double found : shear_rate<D>(mesh, v)) EXPECT_NEAR(found, strain.norm(), 1e-12);
  const auto acceleration = acceleration_norm<D>(mesh, v);
  for (std::size_t n = 1; n < v.size(); ++n) EXPECT_NEAR(acceleration[n], (g * v[n]).norm(), 1e-10);
}

TYPED_TEST(FlowIndicators, SizeTensorsMeasureEveryEdge) {
  constexpr int D = TypeParam::value;
  std::mt19937 rng(7);
  std::normal_distribution<double> any;
  for (int trial = 0; trial < 20; ++trial) {
    std::array<Vec<D>, D + 1> p;
    for (Vec<D>& x : p) x = Vec<D>::NullaryExpr([&] { return any(rng); });
    const Mat<D> n = size_tensor<D>(p);
    EXPECT_LT((n - n.transpose()).norm(), 1e-9 * n.norm());
    std::array<Vec<D>, D> f;
    for (int k = 0; k < D; ++k) f[k] = p[k];
    const Mat<D> on_facet = facet_size_tensor<D>(f);
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j) {
        const Vec<D> e = p[j] - p[i];
        EXPECT_NEAR(e.dot(n * e), std::pow(e.norm(), 4), 1e-7 * n.norm() * e.squaredNorm());
        if (j < D) {
          EXPECT_NEAR(e.dot(on_facet * e), std::pow(e.norm(), 4),
                      1e-7 * on_facet.norm() * e.squaredNorm());
        }
      }
    EXPECT_LT((on_facet * facet_normal<D>(f)).norm(),
              1e-9 * on_facet.norm() * facet_normal<D>(f).norm());
    // The equilateral simplex is as large in every direction.
    const auto equal = equilateral_simplex<D>(3);
    EXPECT_LT((size_tensor<D>(equal.corners(equal.elements[0])) - 9 * Mat<D>::Identity()).norm(),
              1e-10);
  }
}

TYPED_TEST(FlowIndicators, DirectionTurnsInAWhirlAndNotInAChannel) {
  constexpr int D = TypeParam::value;
  // Away from its axis a rigid rotation turns by 1/r a length.
  auto mesh = unit_box<D>(6);
  for (Vec<D>& x : mesh.points) x[0] += 3;
  Mat<D> whirl = Mat<D>::Zero();
  whirl(0, 1) = -1;
  whirl(1, 0) = 1;
  const auto turning = direction_change<D>(mesh, linear<D>(mesh, whirl, Vec<D>::Zero()));
  ASSERT_FALSE(turning.empty());
  for (std::size_t e = 0; e < turning.size(); ++e) {
    Vec<D> x = Vec<D>::Zero();
    for (const NodeId n : mesh.elements[e]) x += mesh.points[n] / (D + 1);
    EXPECT_NEAR(turning[e], 1 / x.template head<2>().norm(), 1e-9);
  }
  std::vector<Vec<D>> straight;
  for (const Vec<D>& x : mesh.points) straight.push_back(Vec<D>::Unit(0) * x[1] * (1 - x[1]));
  for (const double a : direction_change<D>(mesh, straight)) EXPECT_LT(a, 1e-12);
}

TYPED_TEST(FlowIndicators, RotationAndNumberingChangeNothing) {
  constexpr int D = TypeParam::value;
  const auto mesh = unit_box<D>(3);
  std::vector<Vec<D>> v;
  std::vector<double> p;
  for (const Vec<D>& x : mesh.points) {
    v.push_back(Vec<D>::Constant(std::sin(3 * x[0])) + Vec<D>::Unit(0) * x[1] * x[1]);
    p.push_back(std::cos(2 * x[1]) + x[0]);
  }
  Mat<D> turn = Mat<D>::Identity();
  turn.template topLeftCorner<2, 2>() = Eigen::Rotation2Dd(0.6).toRotationMatrix();
  auto turned = mesh;
  auto turned_v = v;
  for (Vec<D>& x : turned.points) x = turn * x;
  for (Vec<D>& x : turned_v) x = turn * x;
  std::reverse(turned.elements.begin(), turned.elements.end());
  const auto expect_same = [&](const std::vector<double>& a, std::vector<double> b) {
    std::reverse(b.begin(), b.end());
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t e = 0; e < a.size(); ++e) EXPECT_NEAR(a[e], b[e], 1e-9 * (1 + a[e]));
  };
  expect_same(*residual_indicator<D>(mesh, v, p, 2),
              *residual_indicator<D>(turned, turned_v, p, 2));
  expect_same(*directional_indicator<D>(mesh, v, p, 2),
              *directional_indicator<D>(turned, turned_v, p, 2));
  expect_same(direction_change<D>(mesh, v), direction_change<D>(turned, turned_v));
  expect_same(shear_rate<D>(mesh, v), shear_rate<D>(turned, turned_v));
}

// On equilateral elements all sizes are the diameter, and both indicators are one.
TEST(FlowIndicators2D, OnEquilateralElementsTheDirectionDoesNotMatter) {
  auto mesh = unit_box<2>(4);
  for (Vec<2>& x : mesh.points) x = Vec<2>(x[0] - 0.5 * x[1], std::sqrt(0.75) * x[1]);
  // Kuhn's diagonal runs from low to high: in this shear it is an edge of the same length.
  double shortest = 1, longest = 0;
  for (const auto& e : unique_edges<2>(mesh.elements, mesh.points.size())) {
    const double length = (mesh.points[e[0]] - mesh.points[e[1]]).norm();
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  ASSERT_NEAR(shortest, longest, 1e-12);
  std::vector<Vec<2>> v(mesh.points.size(), Vec<2>::Zero());
  std::vector<double> p;
  for (const Vec<2>& x : mesh.points) p.push_back(std::sin(3 * x[0]) + x[1]);
  const std::vector<Vec<2>> along(mesh.elements.size(), Vec<2>(0.6, 0.8));
  const auto plain = residual_indicator<2>(mesh, v, p, 1);
  const auto directed = directional_indicator<2>(mesh, v, p, 1, along);
  for (std::size_t e = 0; e < plain->size(); ++e) EXPECT_NEAR((*plain)[e], (*directed)[e], 1e-9);
}

double norm(const std::vector<double>& indicator) {
  return std::sqrt(std::inner_product(indicator.begin(), indicator.end(), indicator.begin(), 0.0));
}

// Section 5.2.2: refined across the flow only, the exact error falls; the diameters do not.
TEST(FlowIndicators2D, TheDirectionalOneFallsWithUnidirectionalRefinement) {
  std::vector<double> plain, directed, error;
  for (const int cells : {4, 8, 16, 32}) {
    auto mesh = box_mesh<2>({4, cells}, Vec<2>::Zero(), Vec<2>(4, 1));
    test::name_channel<2>(mesh);
    FlowCase<2> flow;
    flow.gates = {{"gate", 4.0, {}}};
    flow.vents = {"vent"};
    const auto found = solve_stokes<2>(mesh, flow);
    ASSERT_TRUE(found.ok());
    plain.push_back(norm(*residual_indicator<2>(mesh, found->velocity, found->pressure, 1)));
    directed.push_back(norm(*directional_indicator<2>(mesh, found->velocity, found->pressure, 1)));
    double square = 0;
    const auto gradients = element_gradients<2>(mesh, found->velocity);
    for (std::size_t e = 0; e < gradients.size(); ++e) {
      double y = 0;
      for (const NodeId n : mesh.elements[e]) y += mesh.points[n][1] / 3;
      square += signed_measure<2>(mesh.corners(mesh.elements[e])) *
                std::pow(gradients[e](0, 1) - (0.5 - y), 2);
    }
    error.push_back(std::sqrt(square));
  }
  EXPECT_GT(error[0] / error[3], 6);
  EXPECT_LT(plain[0] / plain[3], 1.3);
  EXPECT_GT(directed[0] / directed[3], 6);
  for (int k = 0; k < 3; ++k) EXPECT_GT(directed[k] / directed[k + 1], 1.6) << k;
}

TEST(FlowIndicators2D, CancelIsHeard) {
  const auto mesh = unit_box<2>(2);
  std::stop_source stop;
  stop.request_stop();
  const std::vector<Vec<2>> v(mesh.points.size(), Vec<2>::Zero());
  const std::vector<double> p(mesh.points.size(), 0);
  const auto r = residual_indicator<2>(mesh, v, p, 1, 0, Progress({}, stop.get_token()));
  ASSERT_FALSE(r.ok());
  EXPECT_EQ(r.error().code, Code::cancelled);
}

}  // namespace
}  // namespace lamella
