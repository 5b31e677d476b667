#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/mesh/interfaces.h"
#include "core/mesh/sample_meshes.h"
#include "core/mesh/validate.h"
#include "core/metric/analytic.h"
#include "core/optimize/adapt.h"

namespace lamella {
namespace {

template <int D>
Adapted<D> adapted(const SimplexMesh<D>& mesh, const MetricFunction<D>& f,
                   const AdaptParams& params = {}) {
  auto r = adapt<D>(mesh, sample_metric<D>(f, mesh.points), nullptr, params, {}, f);
  if (!r) throw std::runtime_error(r.error().message);
  EXPECT_TRUE(validate<D>(r->mesh).ok());
  return std::move(*r);
}

template <int D>
MetricFunction<D> uniform(double h) {
  return [h](const Vec<D>&) { return isotropic_metric<D>(h); };
}

/// Elements of a body as sets of corner coordinates.
template <int D>
std::set<std::vector<std::vector<double>>> elements_of(const SimplexMesh<D>& mesh,
                                                       std::int32_t body) {
  std::set<std::vector<std::vector<double>>> all;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    if (mesh.element_body[e] != body) continue;
    std::vector<std::vector<double>> corners;
    for (NodeId n : mesh.elements[e]) {
      const Vec<D>& x = mesh.points[n];
      corners.emplace_back(x.data(), x.data() + D);
    }
    std::sort(corners.begin(), corners.end());
    all.insert(corners);
  }
  return all;
}

template <int D>
void interface_is_adapted_and_held() {
  const auto mesh = two_body_box<D>(4);
  const auto r = adapted<D>(mesh, uniform<D>(D == 2 ? 0.06 : 0.12));
  double volume[2] = {0, 0};
  for (std::size_t e = 0; e < r.mesh.elements.size(); ++e)
    volume[r.mesh.element_body[e]] += signed_measure<D>(r.mesh.corners(r.mesh.elements[e]));
  EXPECT_NEAR(volume[0], 0.5, 1e-12);
  EXPECT_NEAR(volume[1], 0.5, 1e-12);
  const auto before = with_interfaces(mesh), after = with_interfaces(r.mesh);
  ASSERT_EQ(after.groups.size(), mesh.groups.size() + 1);
  const std::size_t own = r.mesh.facets.size();
  // Finer than it was: the interface takes part in the adaption.
  EXPECT_GT(after.facets.size() - own, before.facets.size() - mesh.facets.size());
  double area = 0;
  for (std::size_t f = own; f < after.facets.size(); ++f) {
    for (NodeId n : after.facets[f]) EXPECT_NEAR(after.points[n][0], 0.5, 1e-12);
    area += facet_normal<D>(after.corners(after.facets[f])).norm() / factorial(D - 1);
  }
  EXPECT_NEAR(area, 1, 1e-12);
}

TEST(AdaptFeatures, AnInterfaceBetweenBodiesIsAdaptedAndStaysInItsPlane) {
  interface_is_adapted_and_held<2>();
  interface_is_adapted_and_held<3>();
}

TEST(AdaptFeatures, AFrozenBodyKeepsItsElementsAndTheOtherIsAdapted) {
  const auto mesh = two_body_box<3>(4);
  AdaptParams params;
  params.frozen_bodies = {0};
  const auto r = adapted<3>(mesh, uniform<3>(0.1), params);
  EXPECT_EQ(elements_of(r.mesh, 0), elements_of(mesh, 0));
  EXPECT_GT(elements_of(r.mesh, 1).size(), 2 * elements_of(mesh, 1).size());
}

TEST(AdaptFeatures, AFrozenGroupKeepsItsFacets) {
  auto mesh = unit_box<3>(3);
  mesh.groups = {"walls", "gate"};
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    if (mesh.facet_face[f] == 0) mesh.facet_group[f] = 1;
  AdaptParams params;
  params.frozen_groups = {1};
  const auto r = adapted<3>(mesh, uniform<3>(0.12), params);
  const auto gate = [](const SimplexMesh<3>& m) {
    std::set<std::vector<std::vector<double>>> all;
    for (std::size_t f = 0; f < m.facets.size(); ++f) {
      if (m.facet_group[f] != 1) continue;
      std::vector<std::vector<double>> corners;
      for (NodeId n : m.facets[f]) corners.emplace_back(m.points[n].data(), m.points[n].data() + 3);
      std::sort(corners.begin(), corners.end());
      all.insert(corners);
    }
    return all;
  };
  EXPECT_EQ(gate(r.mesh), gate(mesh));
  EXPECT_GT(r.mesh.facets.size(), 2 * mesh.facets.size());
}

TEST(AdaptFeatures, BlockingFacesAreFoundAndOpened) {
  // One cell across: every face reaches from wall to wall.
  const auto slab = box_mesh<3>({1, 4, 4}, Vec<3>(0, 0, 0), Vec<3>(0.1, 1, 1));
  EXPECT_FALSE(blocking_faces(slab).empty());
  const MetricFunction<3> across = [](const Vec<3>&) {
    return metric_from_sizes<3>(Mat<3>::Identity(), Vec<3>(0.1, 0.25, 0.25));
  };
  const auto plain = adapted<3>(slab, across);
  EXPECT_FALSE(blocking_faces(plain.mesh).empty());
  AdaptParams params;
  params.treat_blocking = true;
  const auto open = adapted<3>(slab, across, params);
  EXPECT_TRUE(blocking_faces(open.mesh).empty());
  EXPECT_EQ(open.report.blocking, 0u);
  EXPECT_GT(open.report.blocking_treated, 0u);
  // A face between two bodies is a wall, none that blocks.
  auto pair = unit_box<2>(1);
  pair.bodies = {"a", "b"};
  pair.element_body = {0, 1};
  EXPECT_TRUE(blocking_faces(pair).empty());
  pair.element_body = {0, 0};
  EXPECT_EQ(blocking_faces(pair).size(), 1u);
}

TEST(AdaptFeatures, TheMemoryLimitIsRespectedWithAForecast) {
  const auto mesh = unit_box<3>(2);
  const auto f = uniform<3>(0.02);
  AdaptParams params;
  params.memory_limit = 20;
  const auto refused = adapt<3>(mesh, sample_metric<3>(f, mesh.points), nullptr, params, {}, f);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, Code::memory);
  EXPECT_NE(refused.error().message.find("20 MB"), std::string::npos);
  params.memory_limit = 200;
  const auto coarse = adapted<3>(mesh, uniform<3>(0.1), params);
  // (1.34) of a constant metric is exact in elements of unit measure.
  const double units = 1 / (unit_simplex_measure(3) * 1e-3);
  EXPECT_NEAR(coarse.report.forecast_nodes, units / 5.5, 1e-6 * units);
  EXPECT_GT(coarse.report.forecast_memory, 0);
}

TEST(AdaptFeatures, EveryMeanReachesTheSizesOfAConstantMetric) {
  // All means of equal metrics are that metric, in new nodes and in elements.
  const auto mesh = unit_box<2>(4);
  const Metric<2> m = metric_from_sizes<2>(Mat<2>::Identity(), Vec<2>(0.1, 0.1));
  const MetricField<2> field(mesh.points.size(), m);
  for (MetricMean mean :
       {MetricMean::m, MetricMean::root, MetricMean::size, MetricMean::log, MetricMean::h})
    for (SizeAverage average : {SizeAverage::l2, SizeAverage::l1}) {
      AdaptParams params;
      params.mean = params.element_mean = mean;
      params.size_average = average;
      const auto r = adapt<2>(mesh, field, nullptr, params);
      ASSERT_TRUE(r.ok());
      for (std::size_t n = 1; n < r->metric.size(); ++n)
        EXPECT_LT((r->metric[n] - m).norm(), 1e-9 * m.norm());
      EXPECT_GT(r->mesh.node_count(), 100u);
      EXPECT_LT(r->mesh.node_count(), 170u);
    }
}

}  // namespace
}  // namespace lamella
