#include "core/mesh/adjacency.h"

#include <gtest/gtest.h>

#include "core/mesh/sample_meshes.h"

namespace lamella {
namespace {

template <int D>
void check_adjacency(std::size_t cells) {
  const auto mesh = unit_box<D>(static_cast<int>(cells));
  const auto uses = face_uses<D>(mesh.elements, mesh.points.size());
  EXPECT_EQ(uses.size(), mesh.element_count() * (D + 1));
  std::size_t single = 0;
  for_each_face<D>(uses, [&](std::size_t i, std::size_t j) {
    ASSERT_LE(j - i, 2u);
    if (j - i == 1) {
      ++single;
    } else {
      EXPECT_TRUE(FaceUse<D>::opposed(uses[i], uses[i + 1]));
      EXPECT_LT(uses[i].element, uses[i + 1].element);
    }
    if (i > 0) {
      EXPECT_LT(uses[i - 1].nodes, uses[i].nodes);
    }
  });
  EXPECT_EQ(single, mesh.facets.size());
  // Kuhn: an edge leaves each node along every non-empty subset of the axes that stays inside.
  std::size_t edges = 0;
  for (unsigned subset = 1; subset < 1u << D; ++subset) {
    std::size_t count = 1;
    for (int k = 0; k < D; ++k) count *= (subset >> k & 1) != 0 ? cells : cells + 1;
    edges += count;
  }
  const auto unique = unique_edges<D>(mesh.elements, mesh.points.size());
  EXPECT_EQ(unique.size(), edges);
  for (std::size_t i = 0; i < unique.size(); ++i) {
    EXPECT_LT(unique[i][0], unique[i][1]);
    if (i > 0) {
      EXPECT_LT(unique[i - 1], unique[i]);
    }
  }
}

TEST(Adjacency, FacesMeetInPairsAndEdgesAreListedOnce) {
  check_adjacency<2>(5);
  check_adjacency<3>(3);
  check_adjacency<4>(2);
}

}  // namespace
}  // namespace lamella
