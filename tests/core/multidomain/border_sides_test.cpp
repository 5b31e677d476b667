#include "core/multidomain/border_sides.h"

#include <gtest/gtest.h>

#include "core/mesh/sample_meshes.h"

namespace lamella {
namespace {

/// A box of two halves; elements below the middle are inside.
struct Halves {
  SimplexMesh<3> mesh = box_mesh<3>({2, 2, 2}, Vec<3>::Zero(), Vec<3>::Ones());
  Partition<3> partition{{{"low", half_space_zone<3>(Vec<3>(0, 0, 1), 0.5)}}};
  CutTopology topology{mesh,
                       MetricField<3>(mesh.points.size(), Metric<3>::Identity()),
                       partition,
                       CutParams{0.1},
                       {}};
  std::vector<char> below;

  Halves() {
    below.resize(static_cast<std::size_t>(topology.count()), 0);
    for (std::int32_t e = 0; e < topology.count(); ++e)
      if (topology.active(e)) below[e] = center(e)[2] < 0.5;
  }
  Vec<3> center(std::int32_t e) const {
    const auto p = topology.corners(topology.topo.elements[e]);
    return (p[0] + p[1] + p[2] + p[3]) / 4;
  }
  /// An element above the middle with one face in it.
  std::int32_t bump() const {
    const std::vector<char> sides = below;
    std::vector<char> copy = sides;
    const BorderSides s(topology, copy);
    for (std::int32_t e = 0; e < topology.count(); ++e) {
      if (!topology.active(e) || sides[e]) continue;
      int faces = 0, all = 0;
      for (int k = 0; k < 4; ++k) {
        const std::int32_t n = s.across(e, k);
        all += n >= 0;
        faces += n >= 0 && sides[n];
      }
      if (faces == 1 && all == 4) return e;
    }
    return -1;
  }
};

TEST(BorderSides, ABumpGoesBack) {
  const Halves h;
  const std::int32_t bump = h.bump();
  ASSERT_GE(bump, 0);
  std::vector<char> inside = h.below;
  inside[bump] = 1;
  BorderSides(h.topology, inside).settle(std::array{bump});
  EXPECT_EQ(inside, h.below);
}

TEST(BorderSides, APocketOfTwoElementsGoesBackAtOnce) {
  const Halves h;
  const std::int32_t first = h.bump();
  ASSERT_GE(first, 0);
  std::vector<char> inside = h.below;
  const BorderSides neighbors(h.topology, inside);
  std::int32_t second = -1;
  for (int k = 0; k < 4 && second < 0; ++k) {
    const std::int32_t n = neighbors.across(first, k);
    if (n >= 0 && !h.below[n]) second = n;
  }
  ASSERT_GE(second, 0);
  inside[first] = inside[second] = 1;
  BorderSides(h.topology, inside).settle(std::array{first, second});
  EXPECT_EQ(inside, h.below);
}

TEST(BorderSides, WhatCarriesAFeatureStays) {
  Halves h;
  const std::int32_t bump = h.bump();
  ASSERT_GE(bump, 0);
  // The apex is above the border only by the bump.
  for (NodeId n : h.topology.topo.elements[bump])
    if (h.topology.at(n)[2] > 0.6) h.topology.locked[n] = 1;
  std::vector<char> inside = h.below;
  inside[bump] = 1;
  const std::vector<char> before = inside;
  BorderSides(h.topology, inside).settle(std::array{bump});
  EXPECT_EQ(inside, before);
}

TEST(BorderSides, AFlatBorderStays) {
  const Halves h;
  std::vector<char> inside = h.below;
  std::vector<std::int32_t> all;
  for (std::int32_t e = 0; e < h.topology.count(); ++e)
    if (h.topology.active(e)) all.push_back(e);
  // Every element may change, but a smaller border than the plane would cost more than it saves.
  std::vector<std::int32_t> near;
  for (auto e : all)
    if (std::abs(h.center(e)[2] - 0.5) < 0.3) near.push_back(e);
  BorderSides(h.topology, inside).settle(near);
  EXPECT_EQ(inside, h.below);
}

}  // namespace
}  // namespace lamella
