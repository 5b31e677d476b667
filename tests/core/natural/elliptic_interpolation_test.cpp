#include "core/natural/elliptic_interpolation.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "core/mesh/sample_meshes.h"
#include "tests/support/random_metric.h"
#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

using namespace lamella::testing;

template <int D>
struct Hull {
  std::vector<Vec<D>> points;
  std::vector<std::array<std::int32_t, D>> faces;

  template <class Map>
  Hull mapped(const Map& map) const {
    Hull h = *this;
    for (auto& p : h.points) p = map(p);
    return h;
  }
};

constexpr std::array kAll = {Interpolation::m1, Interpolation::m2, Interpolation::m3,
                             Interpolation::m4};

/// Regular polygon with its center at the origin.
Hull<2> polygon(int n, double radius) {
  Hull<2> h;
  for (int i = 0; i < n; ++i) {
    const double phi = 2 * std::numbers::pi * i / n + 0.1;
    h.points.push_back(radius * Vec<2>(std::cos(phi), std::sin(phi)));
    h.faces.push_back({i, (i + 1) % n});
  }
  return h;
}

Hull<3> icosahedron(int levels = 0) {
  const auto s = sphere_surface(1, levels);
  return {s.points, s.facets};
}

/// Boundary of a box of n cells a side, centered at the origin.
template <int D>
Hull<D> box_hull(const std::array<int, D>& cells, const Vec<D>& size) {
  const SimplexMesh<D> mesh = box_mesh<D>(cells, -0.5 * size, 0.5 * size);
  Hull<D> h;
  std::vector<std::int32_t> id(mesh.points.size(), -1);
  for (const auto& f : mesh.facets) {
    std::array<std::int32_t, D> face;
    for (int k = 0; k < D; ++k) {
      if (id[f[k]] < 0) {
        id[f[k]] = static_cast<std::int32_t>(h.points.size());
        h.points.push_back(mesh.points[f[k]]);
      }
      face[k] = id[f[k]];
    }
    h.faces.push_back(face);
  }
  return h;
}

template <int D>
EllipticInterpolation<D> of(const Hull<D>& hull, const EllipticParams& params = {}) {
  EllipticInterpolation<D> e(params);
  e.set(hull.points, hull.faces);
  return e;
}

template <int D>
void expect_near(const Mat<D>& a, const Mat<D>& b, double relative) {
  EXPECT_LT((a - b).norm(), relative * b.norm()) << a << "\n\n" << b;
}

/// Points anywhere on a random ellipsoid around the center: least squares finds it. The sizes
/// differ by up to a thousand.
template <int D>
void least_squares_is_exact() {
  std::mt19937 rng(7);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 50; ++trial) {
    const Metric<D> exact = test::random_metric<D>(rng, 1e3);
    const Vec<D> center = Vec<D>::Constant(5);
    const Mat<D> root = metric_power<D>(exact, -0.5);
    Hull<D> h;
    for (int i = 0; i < 40; ++i) {
      Vec<D> u;
      for (int k = 0; k < D; ++k) u[k] = normal(rng);
      h.points.push_back(center + root * u.normalized());
    }
    EllipticInterpolation<D> e({PointWeights::uniform, false, 1e3});
    e.set(h.points, h.faces, center);
    const auto fit = e.fit(Interpolation::m1);
    ASSERT_TRUE(fit);
    EXPECT_FALSE(fit->projected);
    EXPECT_LT(fit->error, 1e-6);
    EXPECT_LT((root * fit->metric * root - Mat<D>::Identity()).norm(), 1e-6);
  }
}

TEST(EllipticInterpolation, LeastSquaresIsExactOnEllipsoids) {
  least_squares_is_exact<2>();
  least_squares_is_exact<3>();
  least_squares_is_exact<4>();
}

TEST(EllipticInterpolation, TensorIsExactOnLinearImagesOfRegularBodies) {
  std::mt19937 rng(3);
  for (int trial = 0; trial < 20; ++trial) {
    const auto check = [&]<int D>(const Hull<D>& regular) {
      const Metric<D> exact = test::random_metric<D>(rng, 1e3);
      const Mat<D> root = metric_power<D>(exact, -0.5);
      const auto e = of<D>(regular.mapped([&](const Vec<D>& p) { return Vec<D>(root * p); }),
                           {PointWeights::uniform, false, 0});
      const auto fit = e.fit(Interpolation::m2);
      ASSERT_TRUE(fit);
      EXPECT_LT(fit->error, 1e-7);
      EXPECT_LT((root * fit->metric * root - Mat<D>::Identity()).norm(), 1e-7);
    };
    check(polygon(7, 1));
    check(icosahedron());
    check(box_hull<4>({1, 1, 1, 1}, Vec<4>::Ones()));
  }
}

TEST(EllipticInterpolation, StarOfAHexagonIsMadeOfUnitElements) {
  for (const auto method : {Interpolation::m3, Interpolation::m4}) {
    const auto fit = of<2>(polygon(6, 0.3)).fit(method);
    ASSERT_TRUE(fit);
    expect_near<2>(fit->metric, isotropic_metric<2>(0.3), 1e-9);
  }
}

TEST(EllipticInterpolation, AllButM4AreIsotropicOnRegularBodies) {
  // M4 averages sorted sizes, whatever direction each belongs to.
  for (const auto method : {Interpolation::m1, Interpolation::m2, Interpolation::m3})
    for (const bool middles : {false, true})
      for (const auto weights : {PointWeights::area, PointWeights::uniform}) {
        const auto flat = of<2>(polygon(5, 2), {weights, middles, 0}).fit(method);
        const auto round = of<3>(icosahedron(1), {weights, middles, 0}).fit(method);
        ASSERT_TRUE(flat && round);
        expect_near<2>(flat->metric, flat->metric(0, 0) * Mat<2>::Identity(), 1e-9);
        expect_near<3>(round->metric, round->metric(0, 0) * Mat<3>::Identity(), 1e-9);
      }
}

TEST(EllipticInterpolation, AllTurnAndScaleWithTheHull) {
  const Mat<3> r = turn(0.7, {1, 2, 3});
  const double scale = 250;
  const Vec<3> shift{10, -20, 30};
  const Hull<3> hull = box_hull<3>({2, 3, 1}, {2, 1, 0.3}).mapped([](Vec<3> p) {
    p[0] += 0.3 * p[1] * p[1];  // no symmetry left to hide behind
    return p;
  });
  const Hull<3> moved =
      hull.mapped([&](const Vec<3>& p) { return Vec<3>(scale * (r * p) + shift); });
  for (const auto method : kAll)
    for (const bool middles : {false, true})
      for (const auto weights : {PointWeights::area, PointWeights::uniform}) {
        const auto here = of<3>(hull, {weights, middles, 0}).fit(method);
        const auto there = of<3>(moved, {weights, middles, 0}).fit(method);
        ASSERT_TRUE(here && there);
        EXPECT_NEAR(here->error, there->error, 1e-7 * (1 + here->error));
        expect_near<3>(scale * scale * r.transpose() * there->metric * r, here->metric, 1e-7);
      }
}

TEST(EllipticInterpolation, SlabsAreThinAcross) {
  // A disc-like slab: the walls pull the short axis, whatever the method.
  const auto e = of<3>(box_hull<3>({6, 6, 1}, {6, 6, 0.2}));
  for (const auto method : kAll) {
    const auto fit = e.fit(method);
    ASSERT_TRUE(fit);
    const auto s = spectrum<3>(fit->metric);
    EXPECT_NEAR(std::abs(s.vectors(2, 2)), 1, 0.01);
    EXPECT_GT(s.values[2], 25 * s.values[1]);
  }
}

TEST(EllipticInterpolation, CubeWithFaceCentersGivesEightThirteenths) {
  Hull<3> cube = box_hull<3>({1, 1, 1}, Vec<3>::Ones());
  cube.faces.clear();
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-0.5, 0.5}) {
      const auto center = static_cast<std::int32_t>(cube.points.size());
      Vec<3> c = Vec<3>::Zero();
      c[axis] = side;
      cube.points.push_back(c);
      // Four triangles from the center to the corners of its side, which neighbor at distance 1.
      for (std::int32_t a = 0; a < 8; ++a)
        for (std::int32_t b = a + 1; b < 8; ++b)
          if (std::abs(cube.points[a][axis] - side) < 0.1 &&
              std::abs(cube.points[b][axis] - side) < 0.1 &&
              (cube.points[a] - cube.points[b]).norm() < 1.1)
            cube.faces.push_back({center, a, b});
    }
  ASSERT_EQ(cube.faces.size(), 24u);
  const auto uniform = of<3>(cube, {PointWeights::uniform, false, 0});
  const auto area = of<3>(cube);
  for (const auto method : {Interpolation::m1, Interpolation::m2}) {
    EXPECT_NEAR(uniform.fit(method)->error, 8.0 / 13, 1e-9);
    EXPECT_NEAR(area.fit(method)->error, 12.0 / 19, 1e-9);  // .6316, the weights of (4.8)
  }
}

TEST(EllipticInterpolation, AreaWeightsDoNotSeeHowWallsAreCut) {
  // One side of a box cut four times finer draws the center with uniform weights only.
  Hull<2> box{{{0, 0}, {2, 0}, {2, 1}, {0, 1}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
  Hull<2> fine{{{0, 0}, {2, 0}, {2, 1}, {1.5, 1}, {1, 1}, {0.5, 1}, {0, 1}},
               {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {6, 0}}};
  EXPECT_LT((of<2>(fine).center() - of<2>(box).center()).norm(), 1e-12);
  EXPECT_GT((of<2>(fine, {PointWeights::uniform, false, 0}).center() - of<2>(box).center()).norm(),
            0.1);
}

TEST(EllipticInterpolation, EdgeMiddlesWithAreaWeightsAreTheHullCutAtThem) {
  const auto coarse = of<4>(box_hull<4>({1, 1, 1, 1}, {1, 2, 3, 4}), {PointWeights::area, true, 0});
  EXPECT_LT(coarse.center().norm(), 1e-12);
  // In 2D the cut hull can be written down.
  const Hull<2> square{{{0, 0}, {2, 0}, {2, 1}, {0, 1}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
  const Hull<2> cut{{{0, 0}, {1, 0}, {2, 0}, {2, .5}, {2, 1}, {1, 1}, {0, 1}, {0, .5}},
                    {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {6, 7}, {7, 0}}};
  const auto middles = of<2>(square, {PointWeights::area, true, 0});
  for (const auto method : {Interpolation::m1, Interpolation::m2})
    expect_near<2>(middles.fit(method)->metric, of<2>(cut).fit(method)->metric, 1e-12);
}

TEST(EllipticInterpolation, ProjectionKeepsTheEigenvaluesAboveTheBound) {
  // Points on a hyperbola: least squares finds it, with a negative eigenvalue.
  Hull<2> h;
  for (const double s : {-1.0, 1.0})
    for (double t = -1; t <= 1; t += 0.25) h.points.push_back({s * std::cosh(t), std::sinh(t)});
  EllipticInterpolation<2> e({PointWeights::uniform, false, 8});
  e.set(h.points, h.faces, Vec<2>::Zero());
  const Mat<2> raw = *e.least_squares();
  EXPECT_NEAR(raw(0, 0), 1, 1e-9);
  EXPECT_NEAR(raw(1, 1), -1, 1e-9);
  const auto fit = e.fit(Interpolation::m1);
  ASSERT_TRUE(fit);
  EXPECT_TRUE(fit->projected);
  const Vec<2> h_asked = sizes<2>(fit->metric);
  EXPECT_NEAR(h_asked[0], 1, 1e-9);
  EXPECT_NEAR(h_asked[1], 8, 1e-6);
}

TEST(EllipticInterpolation, PointsInAPlaneFallBackToLeastSquares) {
  Hull<3> h;
  for (int i = 0; i < 8; ++i)
    h.points.push_back(
        {2 * std::cos(i * std::numbers::pi / 4), std::sin(i * std::numbers::pi / 4), 0});
  for (int i = 1; i + 1 < 8; ++i) h.faces.push_back({0, i, i + 1});
  const Mat<3> r = turn(0.4, {3, 1, 2});
  const auto e = of<3>(h.mapped([&](const Vec<3>& p) { return Vec<3>(r * p); }),
                       {PointWeights::uniform, false, 50});
  EXPECT_FALSE(e.fit(Interpolation::m2));
  EXPECT_FALSE(e.fit(Interpolation::m3));
  EXPECT_FALSE(e.fit(Interpolation::m4));
  const auto fit = e.fit();
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->method, Interpolation::m1);
  EXPECT_TRUE(fit->projected);
  EXPECT_LT(fit->error, 1e-9);
  const Vec<3> h_asked = sizes<3>(fit->metric);
  EXPECT_NEAR(h_asked[0], 1, 1e-6);
  EXPECT_NEAR(h_asked[1], 2, 1e-6);
  EXPECT_NEAR(h_asked[2], 50, 1e-6);
}

TEST(EllipticInterpolation, WhatTheTensorDoesNotSeeFallsBackToTheStar) {
  // All but a speck of the area lies in a plane with the center. The tensor weighs by area and
  // does not see the speck; the star counts elements.
  Hull<3> h{{{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const double speck = 1e-4;
  for (const Vec<3>& p : {Vec<3>(1, 0, 1), Vec<3>(0, 1, 1), Vec<3>(-1, -1, 1)})
    h.points.push_back(speck * p);
  h.faces.push_back({4, 5, 6});
  EllipticInterpolation<3> e;
  e.set(h.points, h.faces, Vec<3>::Zero());
  EXPECT_FALSE(e.fit(Interpolation::m2));
  const auto fit = e.fit();
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->method, Interpolation::m4);
  EXPECT_TRUE(is_spd<3>(fit->metric));
}

TEST(EllipticInterpolation, APointIsNoHull) {
  EllipticInterpolation<2> e;
  e.set({}, {});
  EXPECT_FALSE(e.fit());
  const std::vector<Vec<2>> twice(3, Vec<2>(1, 2));
  EllipticInterpolation<2> uniform({PointWeights::uniform, false, 1});
  uniform.set(twice, {});
  EXPECT_FALSE(uniform.fit());
}

}  // namespace
}  // namespace lamella
