#include "core/optimize/adapt.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/mesh/sample_meshes.h"
#include "core/mesh/validate.h"

namespace lamella {
namespace {

template <int D>
MetricField<D> sample(const SimplexMesh<D>& mesh, const MetricFunction<D>& f) {
  MetricField<D> field(mesh.points.size(), Metric<D>::Identity());
  for (std::size_t n = 1; n < mesh.points.size(); ++n) field[n] = f(mesh.points[n]);
  return field;
}

/// Adapts `rounds` times, the metric sampled anew on each mesh.
template <int D>
Adapted<D> rounds(SimplexMesh<D> mesh, const MetricFunction<D>& f, int count,
                  const AdaptParams& params = {}, const ReferenceSurface<D>* surface = nullptr) {
  Adapted<D> out;
  for (int i = 0; i < count; ++i) {
    auto r = adapt<D>(mesh, sample<D>(mesh, f), surface, params);
    EXPECT_TRUE(r.ok()) << (r.ok() ? "" : r.error().message);
    out = std::move(*r);
    mesh = out.mesh;
  }
  return out;
}

template <int D>
double share_of_unit_edges(const SimplexMesh<D>& mesh, const MetricFunction<D>& f) {
  std::size_t good = 0, all = 0;
  for (const auto& e : mesh.elements)
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j) {
        const Vec<D> v = mesh.points[e[j]] - mesh.points[e[i]];
        const double l = 0.5 * (std::sqrt(v.dot(f(mesh.points[e[i]]) * v)) +
                                std::sqrt(v.dot(f(mesh.points[e[j]]) * v)));
        good += l > std::sqrt(0.5) && l < std::sqrt(2.0);
        ++all;
      }
  return static_cast<double>(good) / static_cast<double>(all);
}

template <int D>
MetricFunction<D> constant(const Vec<D>& sizes) {
  const Metric<D> m = sizes.cwiseAbs2().cwiseInverse().asDiagonal();
  return [m](const Vec<D>&) { return m; };
}

template <class T>
class AdaptAnyDimension : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                  std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(AdaptAnyDimension, Dimensions);

TYPED_TEST(AdaptAnyDimension, KeepsTheVolumeOfABoxAndReachesUnitEdges) {
  constexpr int D = TypeParam::value;
  const auto f = constant<D>(Vec<D>::Constant(D == 4 ? 0.5 : 0.2));
  const auto out = rounds<D>(unit_box<D>(2), f, D == 4 ? 1 : 2);
  EXPECT_TRUE(validate(out.mesh).ok()) << validate(out.mesh).error().message;
  const auto report = inspect(out.mesh);
  EXPECT_NEAR(report->volume, 1, 1e-12);
  EXPECT_NEAR(report->boundary_area, 2.0 * D, 1e-11);
  EXPECT_GT(share_of_unit_edges<D>(out.mesh, f), D == 4 ? 0.8 : 0.9);
}

TYPED_TEST(AdaptAnyDimension, CoarsensToTheCornersOfTheBox) {
  constexpr int D = TypeParam::value;
  const auto f = constant<D>(Vec<D>::Constant(1));
  const auto out = rounds<D>(unit_box<D>(D == 4 ? 2 : 4), f, 2);
  EXPECT_TRUE(validate(out.mesh).ok());
  EXPECT_NEAR(inspect(out.mesh)->volume, 1, 1e-12);
  // Corners must stay; little else is needed for size 1.
  EXPECT_GE(out.mesh.node_count(), std::size_t{1} << D);
  EXPECT_LE(out.mesh.node_count(), std::size_t{2} << D);
}

TEST(Adapt, FollowsAnAnisotropicMetric) {
  const auto f = constant<3>({0.02, 0.4, 0.4});
  const auto out = rounds<3>(box_mesh<3>({2, 6, 6}, Vec<3>::Zero(), {0.1, 1, 1}), f, 3);
  EXPECT_TRUE(validate(out.mesh).ok());
  EXPECT_NEAR(inspect(out.mesh)->volume, 0.1, 1e-13);
  EXPECT_GT(share_of_unit_edges<3>(out.mesh, f), 0.85);
  // An isotropic mesh of size 0.02 has more than 15 000 nodes here.
  EXPECT_LT(out.mesh.node_count(), 400u);
}

TEST(Adapt, KeepsConcaveEdgesAndFaces) {
  const auto f = constant<3>(Vec<3>::Constant(0.3));
  const auto out = rounds<3>(l_shape<3>(2), f, 2);
  EXPECT_TRUE(validate(out.mesh).ok());
  const auto report = inspect(out.mesh);
  EXPECT_NEAR(report->volume, 3, 1e-11);
  EXPECT_NEAR(report->boundary_area, 14, 1e-10);
  // CAD faces are carried: each keeps its own area.
  std::vector<double> area(8, 0);
  for (std::size_t i = 0; i < out.mesh.facets.size(); ++i)
    area[out.mesh.facet_face[i]] +=
        facet_normal<3>(out.mesh.corners(out.mesh.facets[i])).norm() / 2;
  std::sort(area.begin(), area.end());
  const std::vector<double> expected{1, 1, 1, 1, 2, 2, 3, 3};
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(area[i], expected[i], 1e-10);
}

TEST(Adapt, RefinesABallOntoItsSphereAndNeverLosesVolumeByCoarsening) {
  const auto fine = ball_mesh<3>(8, 1.0);
  ReferenceSurface<3> sphere;
  for (std::size_t n = 1; n < fine.points.size(); ++n) sphere.points.push_back(fine.points[n]);
  for (const auto& t : fine.facets) sphere.facets.push_back({t[0] - 1, t[1] - 1, t[2] - 1});
  sphere.facet_face.assign(sphere.facets.size(), 0);
  sphere.faces.resize(1);
  AdaptParams params;
  params.chord_tolerance = 0.02;
  const double volume = inspect(fine)->volume;
  const auto coarse = rounds<3>(fine, constant<3>(Vec<3>::Constant(1)), 4, params, &sphere);
  EXPECT_TRUE(validate(coarse.mesh).ok());
  // A chord tolerance of 0.02 bounds the loss by 0.02 times the area.
  EXPECT_NEAR(inspect(coarse.mesh)->volume, volume, 0.02 * 4 * std::numbers::pi);
  EXPECT_LT(coarse.mesh.node_count(), fine.node_count());
}

TEST(Adapt, KeepsTheInterfaceOfTwoBodies) {
  const auto out = rounds<3>(two_body_box<3>(4), constant<3>(Vec<3>::Constant(0.15)), 2);
  EXPECT_TRUE(validate(out.mesh).ok());
  double volume[2] = {0, 0};
  for (std::size_t e = 0; e < out.mesh.elements.size(); ++e)
    volume[out.mesh.element_body[e]] += signed_measure<3>(out.mesh.corners(out.mesh.elements[e]));
  EXPECT_NEAR(volume[0], 0.5, 1e-12);
  EXPECT_NEAR(volume[1], 0.5, 1e-12);
}

TEST(Adapt, GivesTheSameMeshTwice) {
  const auto f = constant<3>({0.1, 0.3, 0.3});
  const auto a = rounds<3>(unit_box<3>(3), f, 2), b = rounds<3>(unit_box<3>(3), f, 2);
  EXPECT_EQ(a.mesh.elements, b.mesh.elements);
  EXPECT_EQ(a.mesh.points, b.mesh.points);
}

TEST(Adapt, AnotherSeedGivesAnotherMeshAsGood) {
  const auto f = constant<3>({0.1, 0.3, 0.3});
  AdaptParams params;
  params.seed = 7;
  const auto a = rounds<3>(unit_box<3>(3), f, 2), b = rounds<3>(unit_box<3>(3), f, 2, params);
  EXPECT_NE(a.mesh.points, b.mesh.points);
  EXPECT_TRUE(validate(b.mesh).ok());
  EXPECT_GT(share_of_unit_edges<3>(b.mesh, f), 0.85);
}

TEST(Adapt, EveryMetricMeanReachesTheSameSizes) {
  const MetricFunction<2> f = [](const Vec<2>& x) {
    const double h = 0.02 + 0.3 * std::abs(x[0] - 0.5);
    return Metric<2>(Vec<2>(1 / (h * h), 25).asDiagonal());
  };
  for (auto mean : {MetricMean::m, MetricMean::root, MetricMean::size, MetricMean::log}) {
    AdaptParams params;
    params.mean = mean;
    const auto out = rounds<2>(unit_box<2>(4), f, 5, params);
    EXPECT_TRUE(validate(out.mesh).ok());
    EXPECT_GT(share_of_unit_edges<2>(out.mesh, f), 0.85) << static_cast<int>(mean);
  }
}

TEST(Adapt, FindsAThinLayerThatNoNodeHasSeen) {
  // A layer a fiftieth of the first mesh size wide, away from every node of it.
  const MetricFunction<2> f = [](const Vec<2>& x) {
    const double h = 0.01 + 0.5 * std::abs(x[0] - 0.37);
    return Metric<2>(Vec<2>(1 / (h * h), 16).asDiagonal());
  };
  SimplexMesh<2> mesh = unit_box<2>(2);
  for (int i = 0; i < 4; ++i) {
    auto r = adapt<2>(mesh, sample<2>(mesh, f), nullptr, {}, {}, f);
    ASSERT_TRUE(r.ok());
    for (std::size_t n = 1; n < r->mesh.points.size(); ++n)
      EXPECT_TRUE(r->metric[n].allFinite() && r->metric[n].determinant() > 0);
    mesh = std::move(r->mesh);
  }
  EXPECT_TRUE(validate(mesh).ok());
  EXPECT_GT(share_of_unit_edges<2>(mesh, f), 0.9);
}

TEST(Adapt, TellsAWrongMetric) {
  const auto mesh = unit_box<3>(2);
  MetricField<3> metric(mesh.points.size(), Metric<3>::Identity());
  metric[3] = -Metric<3>::Identity();
  auto bad = adapt<3>(mesh, metric);
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().code, Code::bad_input);
  metric.pop_back();
  bad = adapt<3>(mesh, metric);
  ASSERT_FALSE(bad.ok());
}

}  // namespace
}  // namespace lamella
