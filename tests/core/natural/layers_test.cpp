#include "core/natural/layers.h"

#include <gtest/gtest.h>

#include "core/mesh/sample_meshes.h"
#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

using namespace lamella::testing;

TEST(Layers, StructuredLayersAreCountedExactlyHoweverStretched) {
  for (const int n : {1, 4, 7})
    for (const double t : {0.01, 0.1}) {
      const Mat<3> r = turn(0.4, {1, 1, 2});
      auto mesh = box_mesh<3>({5, 4, n}, {0, 0, 0}, {1, 1, t});
      for (auto& p : mesh.points) p = r * p;
      const auto surface = moved<3>(box_surface({1, 1, t}), r, {0, 0, 0});
      const auto layers = measure_layers(mesh, surface, n);
      ASSERT_TRUE(layers.ok());
      EXPECT_NEAR(layers->stats.mean, n, 1e-6);
      EXPECT_NEAR(layers->stats.p5, n, 1e-6);
      EXPECT_NEAR(layers->stats.p50, n, 1e-6);
      EXPECT_EQ(layers->stats.share_reached, 1);
      EXPECT_EQ(layers->stats.places, 5u * 4 * 2 * 2);  // top and bottom, not the narrow sides
      for (std::size_t i = 1; i < mesh.points.size(); ++i) {
        if (std::isnan(layers->at_node[i])) continue;
        EXPECT_NEAR(layers->at_node[i], n, 1e-6);
      }
      EXPECT_TRUE(std::isnan(layers->at_node[0]));
      ASSERT_EQ(layers->at_facet.size(), mesh.facets.size());
      for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
        const Vec<3> across = r.transpose() * facet_normal<3>(mesh.corners(mesh.facets[f]));
        const bool wall = std::abs(across[2]) > 0.5 * across.norm();
        EXPECT_EQ(std::isnan(layers->at_facet[f]), !wall);
        if (wall) {
          EXPECT_NEAR(layers->at_facet[f], n, 1e-6);
        }
      }
      EXPECT_EQ(measure_layers(mesh, surface, n + 1)->stats.share_reached, 0);
    }
}

TEST(Layers, QuantilesFollowTheAreaOfEachWall) {
  // A step: thickness .1 with 2 layers over three quarters, .2 with 4 layers on the last.
  SimplexMesh<3> mesh = box_mesh<3>({8, 4, 4}, {0, 0, 0}, {2, 1, 0.4});
  const auto kept = mesh.elements;
  mesh.elements.clear();
  for (const auto& e : kept) {
    Vec<3> c = Vec<3>::Zero();
    for (const auto v : e) c += mesh.points[v] / 4;
    if (c[0] > 1.5 || c[2] < 0.2) mesh.elements.push_back(e);
  }
  mesh.element_body.assign(mesh.elements.size(), 0);
  mesh.facets.clear();
  mesh.facet_group.clear();
  mesh.facet_face.clear();
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (int k = 0; k < 4; ++k) {
      const auto f = opposite_facet<3>(mesh.elements[e], k);
      auto nodes = f;
      std::sort(nodes.begin(), nodes.end());
      int uses = 0;
      for (const auto& other : mesh.elements) {
        int shared = 0;
        for (const auto v : other) shared += std::count(nodes.begin(), nodes.end(), v) > 0;
        uses += shared == 3;
      }
      if (uses == 1) mesh.facets.push_back(f);
    }
  mesh.facet_group.assign(mesh.facets.size(), 0);
  mesh.facet_face.assign(mesh.facets.size(), 0);
  const auto surface = cell_surface({std::vector{0.0, 1.5, 2.0}, {0.0, 1.0}, {0.0, 0.2, 0.4}},
                                    [](int i, int, int k) { return i == 1 || k == 0; });
  const auto layers = measure_layers(mesh, surface, 3);
  ASSERT_TRUE(layers.ok());
  EXPECT_NEAR(layers->stats.p5, 2, 1e-6);
  EXPECT_NEAR(layers->stats.p50, 2, 1e-6);
  EXPECT_GT(layers->stats.mean, 2.1);
  EXPECT_LT(layers->stats.mean, 2.6);
  EXPECT_NEAR(layers->stats.p95, 4, 1e-6);
  EXPECT_NEAR(layers->stats.share_reached, 0.25, 0.05);
  // Below 3: the floor and the ceiling of the thin part.
  ASSERT_EQ(layers->below.size(), 2u);
  double area = 0;
  for (const PlaceBelow& place : layers->below) {
    EXPECT_NEAR(place.layers, 2, 1e-6);
    EXPECT_LT(place.at[0], 1.5);
    EXPECT_NEAR(std::abs(place.at[2] - 0.1), 0.1, 1e-9);
    area += place.area;
  }
  EXPECT_NEAR(area, 2 * 1.5, 0.3);
  EXPECT_GE(layers->below[0].area, layers->below[1].area);
  EXPECT_TRUE(measure_layers(mesh, surface, 2)->below.empty());
}

TEST(Layers, OneTetrahedronHasNoOppositeWall) {
  const auto mesh = equilateral_simplex<3>(1);
  ReferenceSurface<3> surface;
  for (std::size_t i = 1; i < mesh.points.size(); ++i) surface.points.push_back(mesh.points[i]);
  for (const auto& f : mesh.facets) surface.facets.push_back({f[0] - 1, f[1] - 1, f[2] - 1});
  const auto layers = measure_layers(mesh, with_faces(surface), 1);
  ASSERT_TRUE(layers.ok());
  EXPECT_EQ(layers->stats.places, 0u);
  for (const double v : layers->at_node) EXPECT_TRUE(std::isnan(v));
}

TEST(Layers, ThreadsChangeNothingAndRequestsAreChecked) {
  const auto mesh = ball_mesh<3>(6, 1);
  const auto surface = sphere_surface(1, 3);
  const auto one = measure_layers(mesh, surface, 4, 1);
  const auto three = measure_layers(mesh, surface, 4, 3);
  ASSERT_TRUE(one.ok() && three.ok());
  EXPECT_GT(one->stats.places, 0u);
  EXPECT_EQ(one->stats.mean, three->stats.mean);
  EXPECT_EQ(one->stats.p5, three->stats.p5);
  EXPECT_EQ(measure_layers(mesh, surface, 0).error().code, Code::usage);
  EXPECT_EQ(measure_layers(mesh, {}, 1).error().code, Code::bad_input);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(measure_layers(mesh, surface, 1, 0, Progress({}, stop.get_token())).error().code,
            Code::cancelled);
}

TEST(Layers, WithinALargerMeshTheyAreCountedFromWallToWall) {
  // Ten layers in the block, four of them in the plate that it holds.
  const auto mesh = box_mesh<3>({10, 10, 10}, {0, 0, 0}, {2, 2, 1});
  const auto plate = moved<3>(box_surface({1.4, 1.4, 0.4}), Mat<3>::Identity(), {0.3, 0.3, 0.2});
  const auto layers = measure_layers_within(mesh, plate, 4);
  ASSERT_TRUE(layers.ok());
  ASSERT_GT(layers->stats.places, 20u);
  EXPECT_NEAR(layers->stats.mean, 4, 1e-5);
  EXPECT_NEAR(layers->stats.p95, 4, 1e-5);
  EXPECT_TRUE(layers->below.empty());
  for (std::size_t i = 1; i < mesh.points.size(); ++i) {
    const bool far = (mesh.points[i] - Vec<3>(1, 1, 0.4)).cwiseAbs().maxCoeff() > 0.95;
    EXPECT_TRUE(!far || std::isnan(layers->at_node[i]));
  }
  EXPECT_FALSE(measure_layers_within(mesh, plate, 5)->below.empty());
  // Of a body that something else takes the right half of, the left is measured.
  const auto left =
      measure_layers_within(mesh, plate, 4, 0, {}, [](const Vec<3>& x) { return x[0] < 1; });
  EXPECT_NEAR(left->stats.mean, 4, 1e-5);
  const auto all = static_cast<double>(layers->stats.places);
  EXPECT_NEAR(static_cast<double>(left->stats.places), all / 2, 0.15 * all);
  // What sticks out of the mesh is not measured.
  EXPECT_EQ(measure_layers_within(
                mesh, moved<3>(box_surface({1, 1, 0.4}), Mat<3>::Identity(), {9, 9, 0.2}), 4)
                ->stats.places,
            0u);
}

TEST(Layers, OfABoundaryLayerAreCountedToItsThickness) {
  const auto mesh = box_mesh<3>({5, 5, 10}, {0, 0, 0}, {2, 2, 1});
  const auto top = measure_boundary_layer(mesh, {5}, 0.3, 3);
  ASSERT_TRUE(top.ok());
  EXPECT_EQ(top->stats.places, 50u);
  EXPECT_NEAR(top->stats.mean, 3, 1e-6);
  EXPECT_NEAR(top->stats.p5, 3, 1e-6);
  EXPECT_EQ(measure_boundary_layer(mesh, {}, 0.3, 3)->stats.places, mesh.facets.size());
  EXPECT_EQ(measure_boundary_layer(mesh, {5}, 0, 3).error().code, Code::usage);
}

}  // namespace
}  // namespace lamella
