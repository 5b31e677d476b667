#include <numbers>

#include "core/geometry/locator.h"
#include "core/natural/boundary_distance.h"
#include "tests/support/adapt_cases.h"

/// Curved boundaries: the mesh lies on its reference.
namespace lamella::test {
namespace {

template <int D>
std::vector<NodeId> boundary_nodes(const SimplexMesh<D>& mesh) {
  std::vector<NodeId> nodes;
  for (const auto& f : mesh.facets) nodes.insert(nodes.end(), f.begin(), f.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// Largest distance of a boundary node from the surface.
template <int D>
double nodes_off(const SimplexMesh<D>& mesh, const Locator<D>& surface) {
  double off = 0;
  for (NodeId n : boundary_nodes<D>(mesh))
    off = std::max(off, std::sqrt(surface.nearest(mesh.points[n])->distance2));
  return off;
}

/// Largest distance of a lattice of points on the facets of one surface from the other.
template <int D>
double facets_off(const ReferenceSurface<D>& from, const Locator<D>& to) {
  constexpr int order = 4;
  double off = 0;
  const auto look = [&](const Vec<D>& x) {
    off = std::max(off, std::sqrt(to.nearest(x)->distance2));
  };
  for (const auto& f : from.facets)
    for (int i = 0; i <= order; ++i) {
      if constexpr (D == 2) {
        look((i * from.points[f[0]] + (order - i) * from.points[f[1]]) / order);
      } else {
        for (int j = 0; i + j <= order; ++j)
          look((i * from.points[f[0]] + j * from.points[f[1]] +
                (order - i - j) * from.points[f[2]]) /
               order);
      }
    }
  return off;
}

/// Nodes lie on the reference, facets within the tolerance of it, and it within that of them.
template <int D>
void expect_on(const SimplexMesh<D>& mesh, const ReferenceSurface<D>& reference, double tolerance) {
  const Locator<D> to_reference(reference);
  const auto own = boundary_surface<D>(mesh);
  EXPECT_LT(nodes_off<D>(mesh, to_reference), 1e-9);
  EXPECT_LE(facets_off<D>(own, to_reference), tolerance * (1 + 1e-9));
  if constexpr (D == 3) {
    EXPECT_LE(boundary_distance(mesh, reference)->largest(), tolerance * (1 + 1e-9));
  }
}

template <class T>
class AdaptBoundary : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(AdaptBoundary, Dimensions);

template <int D>
MetricFunction<D> uniform_metric(double h) {
  return [h](const Vec<D>&) { return isotropic_metric<D>(h); };
}

/// Distance of the ball's facets to the unit sphere.
template <int D>
double sagitta(const SimplexMesh<D>& ball) {
  double most = 0;
  for (const auto& f : ball.facets) most = std::max(most, 1 - center_of<D>(ball, f).norm());
  return most;
}

template <int D>
double unit_ball_volume() {
  return D == 2 ? std::numbers::pi : 4 * std::numbers::pi / 3;
}

TYPED_TEST(AdaptBoundary, ABallIsItsOwnReference) {
  constexpr int D = TypeParam::value;
  const auto ball = ball_mesh<D>(D == 2 ? 12 : 6, 1);
  const auto reference = boundary_surface<D>(ball);
  const double lost = unit_ball_volume<D>() - volumes(ball)[0];
  AdaptParams params;
  params.chord_tolerance = 0.25 * sagitta<D>(ball);
  params.feature_angle = 1.2;  // between the facets of so coarse a ball there are no features
  for (const double h : {0.1, 0.2, 0.5}) {
    SCOPED_TRACE(h);
    const auto out = adapted<D>(ball, uniform_metric<D>(h), params);
    expect_valid(out.mesh);
    expect_on<D>(out.mesh, reference, *params.chord_tolerance);
    EXPECT_LE(std::abs(volumes(out.mesh)[0] - volumes(ball)[0]), lost);
  }
}

TEST(AdaptCurved, ACoarseBallGoesOntoAFineReference) {
  constexpr int D = 3;
  // Its nodes are nodes of the reference too.
  const auto coarse = ball_mesh<D>(4, 1), fine = ball_mesh<D>(16, 1);
  const auto reference = boundary_surface<D>(fine);
  const Locator<D> locator(reference);
  AdaptParams params;
  params.chord_tolerance = 1.2 * sagitta<D>(coarse);
  auto mesh = coarse;
  for (int i = 0; i < 2; ++i)
    mesh = adapted<D>(mesh, uniform_metric<D>(0.1), params, &reference).mesh;
  expect_valid(mesh);
  EXPECT_LT(nodes_off<D>(mesh, locator), 1e-9);
  const double before = facets_off<D>(boundary_surface<D>(coarse), locator);
  EXPECT_LT(facets_off<D>(boundary_surface<D>(mesh), locator), 0.25 * before);
  const double volume = volumes(fine)[0];
  EXPECT_LT(std::abs(volumes(mesh)[0] - volume), 0.1 * (volume - volumes(coarse)[0]));
}

TYPED_TEST(AdaptBoundary, AToleranceBelowTheChordErrorOfTheFirstMeshIsReached) {
  constexpr int D = TypeParam::value;
  const auto coarse = ball_mesh<D>(D == 2 ? 8 : 4, 1), fine = ball_mesh<D>(D == 2 ? 96 : 24, 1);
  const auto reference = boundary_surface<D>(fine);
  AdaptParams params;
  params.chord_tolerance = (D == 2 ? 0.05 : 0.15) * sagitta<D>(coarse);
  auto mesh = coarse;
  for (int i = 0; i < 3; ++i)
    mesh = adapted<D>(mesh, uniform_metric<D>(D == 2 ? 0.04 : 0.12), params, &reference).mesh;
  expect_valid(mesh);
  expect_on<D>(mesh, reference, *params.chord_tolerance);
}

TEST(AdaptCurved, WhatIsFarFromTheSurfaceNeverGetsFarther) {
  // Too coarse a size for the tolerance: the boundary may improve, and stays as it is elsewhere.
  const auto coarse = ball_mesh<3>(4, 1), fine = ball_mesh<3>(16, 1);
  const auto reference = boundary_surface<3>(fine);
  AdaptParams params;
  params.chord_tolerance = 0.01 * sagitta<3>(coarse);
  const double before = boundary_distance(coarse, reference)->to_surface.distance;
  const auto out = adapted<3>(coarse, uniform_metric<3>(0.5), params, &reference);
  expect_valid(out.mesh);
  EXPECT_LE(boundary_distance(out.mesh, reference)->to_surface.distance, before * (1 + 1e-9));
}

TYPED_TEST(AdaptBoundary, AFineBallKeepsTheToleranceAtEverySize) {
  constexpr int D = TypeParam::value;
  const auto fine = ball_mesh<D>(D == 2 ? 48 : 12, 1);
  const auto reference = boundary_surface<D>(fine);
  const double lost = unit_ball_volume<D>() - volumes(fine)[0];
  AdaptParams params;
  params.chord_tolerance = 0.5 * sagitta<D>(fine);
  for (const double h : {D == 2 ? 0.05 : 0.1, 0.3, 1.0}) {
    SCOPED_TRACE(h);
    const auto out = adapted<D>(fine, uniform_metric<D>(h), params, &reference);
    expect_valid(out.mesh);
    expect_on<D>(out.mesh, reference, *params.chord_tolerance);
    EXPECT_LE(std::abs(volumes(out.mesh)[0] - volumes(fine)[0]), lost);
  }
}

TYPED_TEST(AdaptBoundary, ALooseToleranceLetsTheBallBecomeCoarse) {
  constexpr int D = TypeParam::value;
  const auto fine = ball_mesh<D>(D == 2 ? 48 : 12, 1);
  const auto reference = boundary_surface<D>(fine);
  AdaptParams params;
  params.chord_tolerance = 0.05;
  const auto out = adapted<D>(fine, uniform_metric<D>(0.6), params, &reference);
  expect_valid(out.mesh);
  expect_on<D>(out.mesh, reference, 0.05);
  EXPECT_LT(out.mesh.facets.size(), fine.facets.size() / 4);
}

TYPED_TEST(AdaptBoundary, AnAnisotropicMetricKeepsTheToleranceToo) {
  constexpr int D = TypeParam::value;
  const auto fine = ball_mesh<D>(D == 2 ? 24 : 10, 1);
  const auto reference = boundary_surface<D>(fine);
  AdaptParams params;
  params.chord_tolerance = 0.02;
  std::mt19937 rng(D);
  for (const auto& [name, metric] : metrics<D>(0.3, rng)) {
    SCOPED_TRACE(name);
    const auto out = adapted<D>(fine, metric, params, &reference);
    expect_valid(out.mesh);
    expect_on<D>(out.mesh, reference, 0.02);
  }
}

TYPED_TEST(AdaptBoundary, TheBorderOfAGroupStaysOnACurvedSide) {
  constexpr int D = TypeParam::value;
  const auto ball =
      with_gate<D>(ball_mesh<D>(D == 2 ? 24 : 10, 1), [](const Vec<D>& x) { return x[0] > 0; });
  const auto reference = boundary_surface<D>(ball);
  AdaptParams params;
  params.chord_tolerance = 0.02;
  params.feature_angle = 1.2;
  for (const double h : {0.08, 0.4}) {
    SCOPED_TRACE(h);
    const auto out = adapted<D>(ball, uniform_metric<D>(h), params);
    expect_valid(out.mesh);
    expect_on<D>(out.mesh, reference, 0.02);
    for (const auto& [side, area] : areas(out.mesh))
      EXPECT_NEAR(area, areas(ball).at(side), 0.02 * 2 * std::numbers::pi);
    // The border lies in the plane x = 0.
    for (std::size_t f = 0; f < out.mesh.facets.size(); ++f)
      for (NodeId n : out.mesh.facets[f]) {
        const double x = out.mesh.points[n][0];
        EXPECT_TRUE(out.mesh.facet_group[f] == 1 ? x > -0.02 : x < 0.02) << x;
      }
  }
}

/// A cylinder of n sides along z: two feature circles and, no corners.
ReferenceSurface<3> cylinder(SimplexMesh<3>& mesh, int n) {
  mesh = box_mesh<3>({n, n, n / 2}, {-1, -1, 0}, {1, 1, 1});
  for (auto& x : mesh.points) {
    const double largest = x.head<2>().lpNorm<Eigen::Infinity>();
    if (largest > 0) x.head<2>() *= largest / x.head<2>().norm();
  }
  for (auto& face : mesh.facet_face) face = face < 4 ? 0 : face - 3;
  auto s = boundary_surface<3>(mesh);
  std::map<std::array<std::int32_t, 2>, std::int32_t> side;
  for (std::size_t f = 0; f < s.facets.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      std::array<std::int32_t, 2> e{s.facets[f][k], s.facets[f][(k + 1) % 3]};
      std::sort(e.begin(), e.end());
      const auto [it, added] = side.emplace(e, s.facet_face[f]);
      if (!added && it->second != s.facet_face[f]) s.feature_edges.push_back(e);
    }
  return s;
}

TEST(AdaptCurved, TheRimsOfACylinderStayInTheirPlanesAndOnTheirCircles) {
  SimplexMesh<3> mesh;
  const auto reference = cylinder(mesh, 12);
  ASSERT_FALSE(reference.feature_edges.empty());
  AdaptParams params;
  params.chord_tolerance = 0.01;
  for (const double h : {0.12, 0.35}) {
    SCOPED_TRACE(h);
    const auto out = adapted<3>(mesh, uniform_metric<3>(h), params, &reference);
    expect_valid(out.mesh);
    expect_on<3>(out.mesh, reference, 0.01);
    const auto before = areas(mesh), after = areas(out.mesh);
    for (const int lid : {1, 2}) {
      // A rim within the tolerance of the old one changes the lid by no more than its length times
      // the tolerance.
      EXPECT_NEAR(after.at({0, lid}), before.at({0, lid}), 0.01 * 2 * std::numbers::pi);
      for (std::size_t f = 0; f < out.mesh.facets.size(); ++f)
        for (NodeId n : out.mesh.facets[f])
          if (out.mesh.facet_face[f] == lid) {
            EXPECT_NEAR(out.mesh.points[n][2], lid - 1, 1e-12);
          }
    }
  }
}

}  // namespace
}  // namespace lamella::test
