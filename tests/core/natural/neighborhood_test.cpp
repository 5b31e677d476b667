#include "core/natural/neighborhood.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "core/mesh/boundary.h"
#include "core/mesh/sample_meshes.h"
#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

using lamella::testing::turn;

/// The elements whose center is wanted.
template <int D, class Wanted>
SimplexMesh<D> kept(SimplexMesh<D> mesh, Wanted wanted) {
  std::vector<typename SimplexMesh<D>::Element> elements;
  for (const auto& e : mesh.elements) {
    Vec<D> center = Vec<D>::Zero();
    for (const NodeId n : e) center += mesh.points[n] / (D + 1);
    if (wanted(center)) elements.push_back(e);
  }
  mesh.elements = std::move(elements);
  mesh.element_body.assign(mesh.elements.size(), 0);
  rebuild_facets(mesh);
  compact_nodes(mesh);
  return mesh;
}

/// Cells of 1 along x and the last axis, fans around a node in the middle of each (and in the
/// middle of every side where D = 3): hulls of cells have all their symmetries. A T of a stem and
/// two arms of `reach` cells each, the joint around the origin.
template <int D>
SimplexMesh<D> tee(int reach) {
  SimplexMesh<D> mesh;
  std::map<std::array<int, D>, NodeId> ids;  // in half cells
  const auto id = [&](const std::array<int, D>& c) {
    const auto [it, fresh] = ids.try_emplace(c, static_cast<NodeId>(mesh.points.size()));
    if (fresh) {
      Vec<D> p;
      for (int k = 0; k < D; ++k) p[k] = 0.5 * c[k];
      mesh.points.push_back(p);
    }
    return it->second;
  };
  const auto add = [&](typename SimplexMesh<D>::Element e) {
    if (signed_measure<D>(mesh.corners(e)) < 0) std::swap(e[0], e[1]);
    mesh.elements.push_back(e);
  };
  for (int i = -reach; i <= reach; ++i)
    for (int k = -reach; k <= 0; ++k) {
      if (i != 0 && k != 0) continue;
      std::array<int, D> c{};
      c[0] = 2 * i;
      c[D - 1] = 2 * k;
      for (int axis = 0; axis < D; ++axis)
        for (const int side : {-1, 1}) {
          // The corners of one side, in turn.
          auto at = c;
          at[axis] += side;
          const int b = (axis + 1) % D, d = (axis + 2) % D;
          if constexpr (D == 2) {
            auto p = at, q = at;
            --p[b], ++q[b];
            add({id(c), id(p), id(q)});
          } else {
            std::array<NodeId, 4> ring;
            for (int t = 0; t < 4; ++t) {
              auto p = at;
              p[b] += t == 1 || t == 2 ? 1 : -1;
              p[d] += t >= 2 ? 1 : -1;
              ring[t] = id(p);
            }
            // One diagonal, the same from both cells: through the corner of least coordinates.
            add({id(c), ring[0], ring[1], ring[2]});
            add({id(c), ring[0], ring[2], ring[3]});
          }
        }
    }
  mesh.element_body.assign(mesh.elements.size(), 0);
  rebuild_facets(mesh);
  return mesh;
}

template <int D>
NodeId node_at(const SimplexMesh<D>& mesh, const Vec<D>& x) {
  NodeId best = 1;
  for (std::size_t n = 1; n < mesh.points.size(); ++n)
    if ((mesh.points[n] - x).norm() < (mesh.points[best] - x).norm()) best = static_cast<NodeId>(n);
  return best;
}

template <int D>
NeighborhoodField<D> field_of(const SimplexMesh<D>& mesh, const NaturalParams& params = {},
                              const NeighborhoodParams& growth = {}) {
  auto field = neighborhood_field<D>(mesh, params, growth);
  EXPECT_TRUE(field.ok());
  return std::move(*field);
}

TEST(LayerNumbers, CountHalfTheLayersOfAPlate) {
  for (const int layers : {2, 3, 4, 7}) {
    const auto mesh = box_mesh<3>({16, 16, layers}, Vec<3>::Zero(), Vec<3>(16, 16, layers));
    const auto k = layer_numbers(mesh);
    // 2 k - 1 is the number of layers, or one more, all across the plate.
    const int expected = layers / 2 + 1;
    for (int z = 0; z <= layers; ++z) EXPECT_EQ(k[node_at<3>(mesh, {8, 8, double(z)})], expected);
  }
}

TEST(LayerNumbers, AreOneWhereAllNodesAreOnTheBoundary) {
  const auto mesh = unit_box<2>(1);
  EXPECT_EQ(layer_numbers(mesh), (std::vector<int>{0, 1, 1, 1, 1}));
  EXPECT_EQ(average_layers(layer_numbers(mesh)), 0.5);  // (B.2)
}

TEST(LayerNumbers, StayWithTheirWall) {
  // A thick block, 8 layers, carries a fin of 2: away from the joint each has its own number.
  const auto mesh = kept(box_mesh<2>({24, 8}, Vec<2>::Zero(), Vec<2>(24, 8)),
                         [](const Vec<2>& c) { return c[0] < 8 || (c[1] > 3 && c[1] < 5); });
  const auto k = layer_numbers(mesh);
  EXPECT_EQ(k[node_at<2>(mesh, {20, 4})], 2);
  EXPECT_EQ(k[node_at<2>(mesh, {20, 3})], 2);
  EXPECT_EQ(k[node_at<2>(mesh, {4, 4})], 5);
}

/// Table 4.2: at the center of the joint the first hull is an ellipse, the following are not, and
/// growth ends as soon as (B.1) allows.
template <int D>
void tee_stops_at_the_joint() {
  const auto mesh = tee<D>(4);
  const NodeId center = node_at<D>(mesh, Vec<D>::Zero());
  std::vector<double> errors;
  for (int order = 1; order <= 3; ++order) {
    // The T of `order - 1` cells is the hull of that order around the center.
    const auto hull = tee<D>(order - 1);
    std::vector<Vec<D>> points;
    for (std::size_t n = 1; n < hull.points.size(); ++n) points.push_back(hull.points[n]);
    std::vector<std::array<std::int32_t, D>> faces;
    for (const auto& f : hull.facets) {
      faces.push_back(f);
      for (auto& v : faces.back()) --v;
    }
    // Centers of cells are no points of the hull.
    std::vector<std::int32_t> id(points.size(), -1);
    std::vector<Vec<D>> used;
    for (auto& f : faces)
      for (auto& v : f) {
        if (id[v] < 0) {
          id[v] = static_cast<std::int32_t>(used.size());
          used.push_back(points[v]);
        }
        v = id[v];
      }
    EllipticInterpolation<D> corners({PointWeights::uniform, false, 0});
    corners.set(used, faces);
    EllipticInterpolation<D> middles({PointWeights::area, true, 0});
    middles.set(used, faces);
    const double error = middles.fit()->error;
    if (order == 1) {
      EXPECT_NEAR(corners.fit()->error, 0, 1e-12);
      EXPECT_LT(error, NeighborhoodParams{}.threshold);
    } else {
      EXPECT_GT(error, NeighborhoodParams{}.threshold);
      EXPECT_GT(error, errors.back());
      EXPECT_GT(corners.fit()->error, 0.6);
    }
    errors.push_back(error);
  }
  const auto field = field_of<D>(mesh);
  const int order = field.order[center];
  EXPECT_EQ(order, field.least_order[center]);
  ASSERT_LE(order, 3);
  // Growth found the hull that was built by hand above.
  EXPECT_NEAR(field.error[center], errors[order - 1], 1e-9);
  EXPECT_EQ(field.failures, 0u);
}

TEST(Neighborhood, TableFourTwoInThePlane) { tee_stops_at_the_joint<2>(); }
TEST(Neighborhood, TableFourTwoInSpace) { tee_stops_at_the_joint<3>(); }

TEST(Neighborhood, CubesAndSquaresAreTakenAsWhole) {
  // The lower bound of the threshold: one cell is not torn apart.
  const auto check = [&]<int D>(const SimplexMesh<D>& cell) {
    const auto field = field_of<D>(cell);
    const NodeId center = node_at<D>(cell, Vec<D>::Zero());
    EXPECT_LT(field.error[center], NeighborhoodParams{}.threshold);
    const Vec<D> h = sizes<D>(field.metric[center]);
    EXPECT_LT(h[D - 1] / h[0], 1.2);
  };
  check(tee<2>(0));
  check(tee<3>(0));
}

TEST(Neighborhood, PlatesGetTheirThicknessDirection) {
  const Mat<3> r = turn(0.7, {1, 2, 3});
  for (const int layers : {1, 2, 4}) {
    auto mesh = box_mesh<3>({12, 12, layers}, Vec<3>::Zero(), Vec<3>(12, 12, 1));
    for (std::size_t n = 1; n < mesh.points.size(); ++n) mesh.points[n] = r * mesh.points[n];
    const auto field = field_of<3>(mesh);
    EXPECT_EQ(field.failures, 0u);
    for (int i = 4; i <= 8; ++i) {
      const NodeId n = node_at<3>(mesh, r * Vec<3>(i, 6, i % 2));
      EXPECT_NEAR(std::abs(field.direction[n].dot(r.col(2))), 1, 0.05);
      // An ellipsoid through two walls is thicker than they are apart: by 1.3 at the most.
      EXPECT_GT(field.thickness[n], 0.5);
      EXPECT_LT(field.thickness[n], 1.3);
      const Vec<3> h = sizes<3>(field.metric[n]);
      EXPECT_NEAR(h[0], field.thickness[n] / 4, 1e-9);
      EXPECT_GT(h[1], 4 * h[0]);
    }
  }
}

TEST(Neighborhood, MostNodesOfSquareAndCubeAreIsotropic) {
  const auto square = unit_box<2>(8);
  const Vec<2> in_square = sizes<2>(field_of<2>(square).metric[node_at<2>(square, {0.5, 0.5})]);
  EXPECT_LT(in_square[1] / in_square[0], 1.3);
  const auto cube = unit_box<3>(4);
  const Vec<3> in_cube = sizes<3>(field_of<3>(cube).metric[node_at<3>(cube, {0.5, 0.5, 0.5})]);
  EXPECT_LT(in_cube[2] / in_cube[0], 1.5);
}

TEST(Neighborhood, FollowsRotationAndScale) {
  const auto mesh = kept(box_mesh<3>({8, 3, 8}, Vec<3>::Zero(), Vec<3>(8, 3, 8)),
                         [](const Vec<3>& c) { return c[0] < 2 || c[2] < 2; });
  const Mat<3> r = turn(1.1, {3, -1, 2});
  const double scale = 40;
  auto moved = mesh;
  for (std::size_t n = 1; n < mesh.points.size(); ++n)
    moved.points[n] = scale * (r * mesh.points[n]) + Vec<3>(5, 6, 7);
  NaturalParams params;
  params.h_max = 50;
  const auto here = field_of<3>(mesh, params);
  params.h_max *= scale;
  const auto there = field_of<3>(moved, params);
  for (std::size_t n = 1; n < mesh.points.size(); ++n) {
    // Where two sizes are at the limit of the division, rounding decides.
    const Vec<3> h = sizes<3>(here.metric[n]);
    EXPECT_EQ(here.order[n], there.order[n]);
    EXPECT_NEAR(here.error[n], there.error[n], 1e-7 * (1 + here.error[n]));
    EXPECT_NEAR(there.thickness[n] / (scale * here.thickness[n]), 1, 1e-7);
    EXPECT_GT(h[0], 0);
  }
}

TEST(Neighborhood, DoesNotDependOnThreadsOrOnTheOrderOfElements) {
  const auto mesh = kept(box_mesh<3>({6, 3, 6}, Vec<3>::Zero(), Vec<3>(6, 3, 6)),
                         [](const Vec<3>& c) { return c[0] < 2 || c[2] < 2; });
  NaturalParams params;
  params.threads = 1;
  const auto one = field_of<3>(mesh, params);
  params.threads = 4;
  const auto four = field_of<3>(mesh, params);
  auto shuffled = mesh;
  std::mt19937 rng(5);
  for (std::size_t i = shuffled.elements.size(); i > 1; --i)
    std::swap(shuffled.elements[i - 1], shuffled.elements[rng() % i]);
  const auto other = field_of<3>(shuffled, params);
  for (std::size_t n = 1; n < mesh.points.size(); ++n) {
    EXPECT_EQ(one.metric[n], four.metric[n]);
    EXPECT_EQ(one.order[n], other.order[n]);
    EXPECT_NEAR(one.thickness[n], other.thickness[n], 1e-9);
  }
}

TEST(Neighborhood, HoldsInFourDimensions) {
  const auto mesh = box_mesh<4>({4, 4, 4, 1}, Vec<4>::Zero(), Vec<4>(4, 4, 4, 0.5));
  const auto field = field_of<4>(mesh);
  const NodeId n = node_at<4>(mesh, {2, 2, 2, 0.5});
  EXPECT_NEAR(std::abs(field.direction[n][3]), 1, 0.05);
  for (std::size_t i = 1; i < mesh.points.size(); ++i) EXPECT_TRUE(is_spd<4>(field.metric[i]));
}

TEST(Neighborhood, TheLimitEndsGrowthAndIsCounted) {
  const auto mesh = unit_box<3>(8);
  NeighborhoodParams growth;
  growth.largest = 200;
  const auto field = field_of<3>(mesh, {}, growth);
  growth.largest = 100000;
  const auto free = field_of<3>(mesh, {}, growth);
  EXPECT_EQ(free.bounded, 0u);
  EXPECT_GT(field.bounded, 0u);
  for (std::size_t n = 1; n < mesh.points.size(); ++n) {
    EXPECT_TRUE(is_spd<3>(field.metric[n]));
    EXPECT_GE(field.order[n], 1);
    EXPECT_LE(field.order[n], free.order[n]);
  }
}

TEST(Neighborhood, SizesStayWithinTheirBounds) {
  const auto mesh = box_mesh<3>({12, 12, 2}, Vec<3>::Zero(), Vec<3>(12, 12, 0.5));
  NaturalParams params;
  params.h_min = 0.2;
  params.h_max = 0.7;
  const auto field = field_of<3>(mesh, params);
  for (std::size_t n = 1; n < mesh.points.size(); ++n) {
    const Vec<3> h = sizes<3>(field.metric[n]);
    EXPECT_GE(h[0], 0.2 - 1e-9);
    EXPECT_LE(h[2], 0.7 + 1e-9);
  }
}

TEST(Neighborhood, RefusesWhatMakesNoSenseAndStopsWhenAsked) {
  const NeighborhoodDetector detector;
  NaturalParams none;
  none.layers = 0;
  EXPECT_EQ(detector.field(unit_box<3>(1), none).error().code, Code::usage);
  EXPECT_EQ(detector.field({}, {}).error().code, Code::bad_input);
  NeighborhoodParams growth;
  growth.threshold = 0;
  EXPECT_EQ(NeighborhoodDetector(growth).field(unit_box<3>(1), {}).error().code, Code::usage);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(detector.field(unit_box<3>(2), {}, Progress({}, stop.get_token())).error().code,
            Code::cancelled);
  EXPECT_FALSE(detector.function({}));
}

}  // namespace
}  // namespace lamella
