#include "core/mesh/boundary.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/mesh/sample_meshes.h"
#include "core/mesh/validate.h"

namespace lamella {
namespace {

template <class T>
class BoundaryTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                  std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(BoundaryTest, Dimensions);

TYPED_TEST(BoundaryTest, FacetsPointAwayFromTheirElement) {
  constexpr int D = TypeParam::value;
  const auto mesh = l_shape<D>(1);
  for (const auto& b : boundary_faces<D>(mesh.elements, mesh.points.size())) {
    const auto p = mesh.corners(b.facet);
    Vec<D> center = Vec<D>::Zero();
    for (const NodeId v : mesh.elements[b.element]) center += mesh.points[v] / (D + 1);
    EXPECT_LT(facet_normal<D>(p).dot(center - p[0]), 0);
  }
}

TYPED_TEST(BoundaryTest, RebuildKeepsGroupsOfKnownFacetsWhateverTheirWinding) {
  constexpr int D = TypeParam::value;
  auto mesh = unit_box<D>(2);
  const std::size_t count = mesh.facets.size();
  mesh.groups = {"walls", "gate"};
  for (std::size_t i = 0; i < count; ++i) mesh.facet_group[i] = mesh.facet_face[i] == 1 ? 1 : 0;
  const auto gates = std::count(mesh.facet_group.begin(), mesh.facet_group.end(), 1);
  std::reverse(mesh.facets.begin(), mesh.facets.end());
  std::reverse(mesh.facet_group.begin(), mesh.facet_group.end());
  std::reverse(mesh.facet_face.begin(), mesh.facet_face.end());
  for (auto& f : mesh.facets) std::swap(f[0], f[1]);
  rebuild_facets(mesh);
  EXPECT_TRUE(validate(mesh).ok());
  EXPECT_EQ(mesh.facets.size(), count);
  EXPECT_EQ(std::count(mesh.facet_group.begin(), mesh.facet_group.end(), 1), gates);
  for (std::size_t i = 0; i < count; ++i)
    EXPECT_EQ(mesh.facet_group[i], mesh.facet_face[i] == 1 ? 1 : 0);
}

TYPED_TEST(BoundaryTest, CompactRemovesUnusedNodesAndMovesFieldsAlong) {
  constexpr int D = TypeParam::value;
  const auto good = unit_box<D>(2);
  auto mesh = good;
  // Two loose nodes, in front and in the middle.
  mesh.points.insert(mesh.points.begin() + 4, Vec<D>::Constant(9));
  mesh.points.insert(mesh.points.begin() + 1, Vec<D>::Constant(8));
  const auto shift = [](NodeId v) { return v + (v >= 4 ? 2 : 1); };
  for (auto& e : mesh.elements) std::transform(e.begin(), e.end(), e.begin(), shift);
  for (auto& f : mesh.facets) std::transform(f.begin(), f.end(), f.begin(), shift);
  EXPECT_EQ(inspect(mesh)->unused, 2u);
  std::vector<Vec<D>> field = mesh.points;
  const auto new_id = compact_nodes(mesh);
  EXPECT_EQ(std::count(new_id.begin(), new_id.end(), -1), 2);
  EXPECT_EQ(mesh.elements, good.elements);
  EXPECT_EQ(mesh.facets, good.facets);
  EXPECT_EQ(mesh.points, good.points);
  compact_field(new_id, field);
  EXPECT_EQ(field, good.points);
}

}  // namespace
}  // namespace lamella
