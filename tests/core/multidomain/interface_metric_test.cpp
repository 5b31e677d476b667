#include "core/multidomain/interface_metric.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/mesh/sample_meshes.h"

namespace lamella {
namespace {

template <int D>
Filling fill(const SimplexMesh<D>& mesh, const Partition<D>& partition) {
  auto filling = filling_ratios<D>(mesh, partition);
  EXPECT_TRUE(filling.ok());
  return std::move(*filling);
}

template <int D>
MetricField<D> uniform(const SimplexMesh<D>& mesh, double h) {
  return MetricField<D>(mesh.points.size(), isotropic_metric<D>(h));
}

Partition<3> two_balls() {
  return Partition<3>({{"a", ball_zone<3>(Vec<3>(0.4, 0.5, 0.5), 0.22)},
                       {"b", ball_zone<3>(Vec<3>(0.62, 0.5, 0.5), 0.2)}});
}

TEST(InterfaceMetric, GradientsOfAllRegionsCancel) {
  const auto mesh = unit_box<3>(6);
  const auto gradients = filling_gradients<3>(mesh, fill<3>(mesh, two_balls()));
  ASSERT_FALSE(gradients.empty());
  std::vector<Vec<3>> sum(mesh.elements.size(), Vec<3>::Zero());
  double largest = 0;
  for (const auto& g : gradients) {
    sum[g.element] += g.gradient;
    largest = std::max(largest, g.gradient.norm());
  }
  for (const Vec<3>& s : sum) EXPECT_LT(s.norm(), 1e-5 * largest);
}

TEST(InterfaceMetric, GradientOfALayeredMeshIsNormalToTheLayers) {
  // Layers of squares, alternately full and empty at a plane between them: jumps of one.
  const auto mesh = box_mesh<2>({6, 6}, Vec<2>::Zero(), Vec<2>::Ones());
  const Partition<2> partition({{"low", half_space_zone<2>(Vec<2>(0, 1), 0.5)}});
  Vec<2> total = Vec<2>::Zero();
  for (const auto& g : filling_gradients<2>(mesh, fill<2>(mesh, partition)))
    if (g.region == 0)
      total += g.gradient * signed_measure<2>(mesh.corners(mesh.elements[g.element]));
  // A jump of -1 over the unit length, as the gradient of the characteristic function has it.
  EXPECT_NEAR(total[1], -1, 0.05);
  EXPECT_NEAR(total[0], 0, 0.05);
}

TEST(InterfaceMetric, InfiniteJumpSeesTheWallOfItsGroups) {
  auto mesh = unit_box<3>(4);
  mesh.groups = {"walls", "hot"};
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    mesh.facet_group[f] = mesh.facet_face[f] == 0 ? 1 : 0;
  const Partition<3> full({{"all", half_space_zone<3>(Vec<3>(1, 0, 0), 10)}});
  const Filling filling = fill<3>(mesh, full);
  EXPECT_TRUE(filling_gradients<3>(mesh, filling).empty());
  const auto gradients = filling_gradients<3>(mesh, filling, {1});
  ASSERT_FALSE(gradients.empty());
  for (const auto& g : gradients) {
    // Inwards: the body is empty beyond the wall x = 0.
    EXPECT_GT(g.gradient[0], 0);
    EXPECT_NEAR(g.gradient.tail(2).norm(), 0, 1e-9 * g.gradient[0]);
  }
  InterfaceParams params;
  params.h_min = {0.01, 0.01};
  params.jump = {1};
  const auto metric = interface_metric<3>(mesh, filling, uniform<3>(mesh, 0.2), params);
  ASSERT_TRUE(metric.ok());
  for (std::size_t n = 1; n < mesh.points.size(); ++n) {
    const bool at_wall = mesh.points[n][0] < 0.3;
    const double across = size_from_eigenvalue((*metric)[n](0, 0));
    if (mesh.points[n][0] == 0) {
      EXPECT_NEAR(across, 0.01, 1e-4);
    } else if (!at_wall) {
      EXPECT_NEAR(across, 0.2, 1e-9);
    }
    EXPECT_NEAR(size_from_eigenvalue((*metric)[n](1, 1)), 0.2, 1e-6);
  }
}

TEST(InterfaceMetric, IsTheSameAtEveryAzimuth) {
  // The maximum of components (6.23) mirrors the normal of one of the two.
  const auto mean_angle = [](double azimuth) {
    const double tilt = std::numbers::pi / 6, a = azimuth * std::numbers::pi / 180;
    const Vec<3> n(std::sin(tilt) * std::cos(a), std::sin(tilt) * std::sin(a), std::cos(tilt));
    const auto mesh = unit_box<3>(12);
    const Partition<3> partition({{"low", half_space_zone<3>(n, n.sum() / 2)}});
    InterfaceParams params;
    params.h_min = {0.01, 0.01};
    const auto metric =
        interface_metric<3>(mesh, fill<3>(mesh, partition), uniform<3>(mesh, 0.1), params);
    EXPECT_TRUE(metric.ok());
    double sum = 0, count = 0;
    for (std::size_t i = 1; i < mesh.points.size(); ++i) {
      const Spectrum<3> s = spectrum<3>((*metric)[i]);
      const Vec<3> inside = (mesh.points[i] - Vec<3>::Constant(0.5)).cwiseAbs();
      if (size_from_eigenvalue(s.values[2]) > 0.02 || inside.maxCoeff() > 0.35) continue;
      EXPECT_NEAR(size_from_eigenvalue(s.values[2]), 0.01, 1e-6);
      sum += std::acos(std::min(1.0, std::abs(s.vectors.col(2).dot(n))));
      ++count;
    }
    EXPECT_GT(count, 50);
    return sum / count * 180 / std::numbers::pi;
  };
  EXPECT_LT(mean_angle(35), 25);
  EXPECT_LT(mean_angle(125), 25);
}

TEST(InterfaceMetric, SizesComeDownByHalvesFromRoundToRound) {
  const auto mesh = unit_box<3>(4);
  const Partition<3> partition({{"low", half_space_zone<3>(Vec<3>(0, 0, 1), 0.5)}});
  const Filling filling = fill<3>(mesh, partition);
  InterfaceParams params;
  params.h_min = {0.02, 0.03};
  for (int round = 0; round < 6; ++round) {
    params.round = round;
    const auto metric = interface_metric<3>(mesh, filling, uniform<3>(mesh, 0.2), params);
    ASSERT_TRUE(metric.ok());
    double least = 1;
    for (std::size_t n = 1; n < mesh.points.size(); ++n)
      least = std::min(least, sizes<3>((*metric)[n])[0]);
    // Of two regions the smaller size counts.
    EXPECT_NEAR(least, std::max(0.02, 0.2 / std::pow(2, round + 1)), 1e-9);
  }
  params.h_min = {0.02, 0};
  EXPECT_EQ(interface_metric<3>(mesh, filling, uniform<3>(mesh, 0.2), params).error().code,
            Code::usage);
}

TEST(InterfaceMetric, DistanceFormGrowsFromThePlane) {
  const Partition<3> partition({{"low", half_space_zone<3>(Vec<3>(0, 0, 1), 0.5)}});
  const auto metric = interface_metric_at<3>(
      partition, [](const Vec<3>&) { return isotropic_metric<3>(0.2); }, {{0.01, 0.02}}, 0.25, 0.5);
  for (const double d : {0.0, 0.01, 0.05, 0.1, 0.3}) {
    const double asked = std::min(0.2, 0.01 + 0.5 * std::max(0.0, d - 0.02));
    for (const double side : {-1.0, 1.0}) {
      const Metric<3> m = metric(Vec<3>(0.3, 0.4, 0.5 + side * d));
      EXPECT_NEAR(size_from_eigenvalue(m(2, 2)), asked, 1e-9);
      EXPECT_NEAR(size_from_eigenvalue(m(0, 0)), 0.2, 1e-9);
      EXPECT_NEAR(m(0, 2), 0, 1e-9);
    }
  }
}

TEST(InterfaceMetric, WithoutASizeOfItsOwnABorderTakesAShareOfTheLayer) {
  const Partition<3> partition({{"low", half_space_zone<3>(Vec<3>(0, 0, 1), 0.5)}});
  // Layers that grow along the border.
  const auto layer = [](const Vec<3>& x) { return 0.1 + 0.2 * x[0]; };
  const auto metric = interface_metric_at<3>(
      partition, [&](const Vec<3>& x) { return isotropic_metric<3>(layer(x)); },
      {std::nullopt, std::nullopt}, 0.25, 0.5);
  for (const double along : {0.0, 0.5, 1.0}) {
    const Vec<3> x(along, 0.4, 0.5);
    EXPECT_NEAR(size_from_eigenvalue(metric(x)(2, 2)), 0.25 * layer(x), 1e-9);
  }
}

TEST(InterfaceMetric, DistanceFormIsFineInTwoDirectionsWhereThreeRegionsMeet) {
  const Partition<3> partition = two_balls();
  const auto metric = interface_metric_at<3>(
      partition, [](const Vec<3>&) { return isotropic_metric<3>(0.2); }, {{0.01, 0.01, 0.01}}, 0.25,
      1);
  // The circle where both spheres cross: |x - a| = .22, |x - b| = .2.
  const double along = (0.22 * 0.22 - 0.2 * 0.2 + 0.22 * 0.22) / (2 * 0.22);
  const double radius = std::sqrt(0.22 * 0.22 - along * along);
  const Vec<3> x(0.4 + along, 0.5, 0.5 + radius);
  const Vec<3> h = sizes<3>(metric(x));
  EXPECT_LT(h[0], 0.011);
  EXPECT_LT(h[1], 0.02);
  EXPECT_GT(h[2], 0.05);
}

}  // namespace
}  // namespace lamella
