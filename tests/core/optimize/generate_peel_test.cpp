#include "core/optimize/generate_peel.h"

#include <gtest/gtest.h>

#include <map>

#include "core/geometry/soup.h"
#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

using namespace lamella::testing;

double volume_of(const FoldedMesh<3>& mesh, const std::array<NodeId, 4>& e) {
  return signed_measure<3>(
      {mesh.point(e[0]), mesh.point(e[1]), mesh.point(e[2]), mesh.point(e[3])});
}

/// Every face of elements and rest is shared by two, with opposite windings, or is of the surface.
void expect_topology(const Bridged<3>& peeled, const ReferenceSurface<3>& surface) {
  std::map<std::array<NodeId, 3>, int> faces;  // sorted -> winding, summed
  std::map<std::array<NodeId, 3>, int> uses;
  const auto add = [&](std::array<NodeId, 3> f, int sign) {
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2 - i; ++j)
        if (f[j] > f[j + 1]) std::swap(f[j], f[j + 1]), sign = -sign;
    faces[f] += sign;
    ++uses[f];
  };
  for (const auto& e : peeled.elements)
    for (int k = 0; k < 4; ++k) add(opposite_facet<3>(e, k), 1);
  // What is left is filled later: its inside takes the place of an element.
  for (const auto& f : peeled.facets) add(f, 1);
  for (const auto& f : surface.facets) add({f[0] + 1, f[1] + 1, f[2] + 1}, -1);
  for (const auto& [f, sum] : faces) EXPECT_EQ(sum, 0);
  for (const auto& [f, n] : uses) EXPECT_EQ(n, 2);
}

void expect_sound(const ReferenceSurface<3>& surface) {
  FoldedMesh<3> mesh(surface);
  const Bridged<3> peeled = peel(bridge_shells<3>(surface), mesh, Locator<3>(surface), 1, {});
  EXPECT_LT(peeled.facets.size(), surface.facets.size() / 4);
  expect_topology(peeled, surface);
  ReferenceSurface<3> rest;
  rest.points.resize(static_cast<std::size_t>(mesh.node_end()));
  for (NodeId n = 1; n < mesh.node_end(); ++n) rest.points[n] = mesh.point(n);
  for (const auto& f : peeled.facets) rest.facets.push_back({f[0], f[1], f[2]});
  double sum = 0;
  std::size_t inverted = 0;
  for (const auto& e : peeled.elements) {
    const double v = volume_of(mesh, e);
    sum += v;
    inverted += v <= 0;
  }
  const double whole = enclosed_measure(surface);
  EXPECT_NEAR((sum + enclosed_measure(rest)) / whole, 1, 1e-9);
  EXPECT_LT(inverted, peeled.elements.size() / 20);
}

TEST(Peel, ABoxLeavesLittle) { expect_sound(box_surface({1, 1, 1}, {6, 6, 6})); }
TEST(Peel, APlateLeavesLittle) { expect_sound(box_surface({8, 8, 0.4}, {20, 20, 1})); }
TEST(Peel, ASphereLeavesLittle) { expect_sound(sphere_surface(1, 4)); }

TEST(Peel, TheSameSeedPeelsTheSame) {
  const auto surface = box_surface({3, 2, 0.5}, {9, 6, 2});
  const auto once = [&](std::uint64_t seed) {
    FoldedMesh<3> mesh(surface);
    return peel(bridge_shells<3>(surface), mesh, Locator<3>(surface), seed, {}).elements;
  };
  EXPECT_EQ(once(3), once(3));
}

}  // namespace
}  // namespace lamella
