#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/mesh/interfaces.h"
#include "core/mesh/sample_meshes.h"
#include "core/mesh/validate.h"
#include "core/metric/analytic.h"
#include "core/natural/boundary_distance.h"
#include "core/optimize/adapt.h"
#include "tests/support/solids.h"

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

/// The boundary of the mesh, without its interfaces.
ReferenceSurface<3> walls_of(const SimplexMesh<3>& mesh) {
  ReferenceSurface<3> s;
  s.points = mesh.points;
  s.facets.assign(mesh.facets.begin(), mesh.facets.end());
  s.facet_face = mesh.facet_face;
  return s;
}

TEST(AdaptFeatures, InterfacesAreAdaptedAndHeldUnderAnOuterSurfaceToo) {
  // A ball around the core of a box: a plane interface that meets the wall, and one curved and
  // closed inside.
  const auto plane = two_body_box<3>(4);
  auto nested = unit_box<3>(8);
  nested.bodies = {"shell", "core"};
  for (std::size_t e = 0; e < nested.elements.size(); ++e) {
    Vec<3> center = Vec<3>::Zero();
    for (NodeId n : nested.elements[e]) center += nested.points[n] / 4;
    nested.element_body[e] = (center - Vec<3>::Constant(0.5)).lpNorm<Eigen::Infinity>() < 0.25;
  }
  for (auto& x : nested.points) {
    // Blows the inner cube up to a ball; the wall stays.
    const Vec<3> y = x - Vec<3>::Constant(0.5);
    const double m = y.lpNorm<Eigen::Infinity>();
    if (m > 0 && m < 0.499) x = Vec<3>::Constant(0.5) + y * (1 + (m / y.norm() - 1) * (1 - 2 * m));
  }
  for (const auto& mesh : {plane, nested}) {
    SCOPED_TRACE(mesh.bodies[0]);
    std::vector<Vec<3>> corners;
    for (int i = 0; i < 8; ++i) corners.push_back(Vec<3>(i & 1, i >> 1 & 1, i >> 2));
    const auto surface = test::featured_surface(mesh, corners);
    const MetricFunction<3> metric = uniform<3>(mesh.bodies[0] == "shell" ? 0.07 : 0.12);
    AdaptParams params;
    params.chord_tolerance = 0.02;
    const auto r =
        adapt<3>(mesh, sample_metric<3>(metric, mesh.points), &surface, params, {}, metric);
    ASSERT_TRUE(r.ok());
    ASSERT_TRUE(validate<3>(r->mesh).ok());
    const auto interface_of = [](const SimplexMesh<3>& m) {
      SimplexMesh<3> inner = with_interfaces(m);
      inner.facets.erase(inner.facets.begin(),
                         inner.facets.begin() + static_cast<std::ptrdiff_t>(m.facets.size()));
      inner.facet_face.assign(inner.facets.size(), 0);
      return walls_of(inner);
    };
    const auto before = interface_of(mesh), after = interface_of(r->mesh);
    EXPECT_GT(after.facets.size(), 3 * before.facets.size() / 2);
    EXPECT_LE(farthest_point(after, before)->distance, 0.02);
    EXPECT_LE(farthest_point(before, after)->distance, 0.02);
    EXPECT_LE(boundary_distance(r->mesh, surface)->largest(), 1e-9);
  }
}

TEST(AdaptFeatures, TheBorderOfAGroupOnASmoothWallIsRefined) {
  auto mesh = unit_box<3>(4);
  mesh.groups = {"walls", "gate"};
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const auto p = mesh.corners(mesh.facets[f]);
    if (mesh.facet_face[f] == 5 && ((p[0] + p[1] + p[2]) / 3)[0] < 0.5) mesh.facet_group[f] = 1;
  }
  const auto border = [](const SimplexMesh<3>& m) {
    std::map<std::array<NodeId, 2>, int> sides;
    for (std::size_t f = 0; f < m.facets.size(); ++f)
      for (int k = 0; k < 3 && m.facet_group[f] == 1; ++k) {
        std::array<NodeId, 2> e{m.facets[f][k], m.facets[f][(k + 1) % 3]};
        std::sort(e.begin(), e.end());
        ++sides[e];
      }
    std::pair<int, double> found{0, 0};
    for (const auto& [e, count] : sides) {
      const Vec<3>&a = m.points[e[0]], &b = m.points[e[1]];
      if (count != 1 || a[0] != 0.5 || b[0] != 0.5) continue;
      ++found.first;
      found.second += (a - b).norm();
    }
    return found;
  };
  ASSERT_EQ(border(mesh).first, 4);
  const auto r = adapted<3>(mesh, uniform<3>(0.1));
  EXPECT_GE(border(r.mesh).first, 8);
  EXPECT_NEAR(border(r.mesh).second, 1, 1e-12);
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
