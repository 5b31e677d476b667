#include "core/mesh/interfaces.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/mesh/boundary.h"
#include "core/mesh/sample_meshes.h"
#include "core/mesh/validate.h"

namespace lamella {
namespace {

template <int D>
double measure_of(const SimplexMesh<D>& mesh, std::int32_t group) {
  double sum = 0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    if (mesh.facet_group[f] == group)
      sum += facet_normal<D>(mesh.corners(mesh.facets[f])).norm() / factorial(D - 1);
  return sum;
}

template <int D>
void lists_what_is_not_listed() {
  const auto mesh = two_body_box<D>(4);
  const auto all = list_interfaces(mesh);
  EXPECT_EQ(all.outer, mesh.facets.size());
  EXPECT_EQ(all.given, mesh.facets.size());
  EXPECT_NEAR(measure_of(all.mesh, static_cast<std::int32_t>(mesh.groups.size())), 1, 1e-12);
  EXPECT_TRUE(validate(all.mesh).ok());
}

TEST(Interfaces, AreListedOnceInAGroupOfTheirBodies) {
  lists_what_is_not_listed<2>();
  lists_what_is_not_listed<3>();
  lists_what_is_not_listed<4>();
}

TEST(Interfaces, AFaceOfTheLargestNumberLeavesOthersToTheInterfaces) {
  auto mesh = two_body_box<3>(4);
  const std::int32_t largest = std::numeric_limits<std::int32_t>::max();
  for (std::int32_t& face : mesh.facet_face) face = face == 0 ? 0 : largest;
  const auto all = list_interfaces(mesh);
  EXPECT_TRUE(validate(all.mesh).ok());
  ASSERT_GT(all.mesh.facets.size(), all.outer);
  for (std::size_t f = all.outer; f < all.mesh.facets.size(); ++f)
    EXPECT_EQ(all.mesh.facet_face[f], 1) << "the least number that is free";
}

TEST(Interfaces, WhatIsListedKeepsItsGroupAndFace) {
  auto mesh = with_interfaces(two_body_box<3>(4));
  const std::size_t outer = two_body_box<3>(4).facets.size();
  // One of them first, from its other side, in a group of its own; one not listed.
  mesh.groups.push_back("mine");
  std::swap(mesh.facets.front(), mesh.facets.back());
  std::swap(mesh.facets.front()[0], mesh.facets.front()[1]);
  std::swap(mesh.facet_face.front(), mesh.facet_face.back());
  std::swap(mesh.facet_group.front(), mesh.facet_group.back());
  mesh.facet_group.front() = static_cast<std::int32_t>(mesh.groups.size()) - 1;
  mesh.facet_face.front() = 17;
  ASSERT_TRUE(validate(mesh).ok());
  const std::size_t count = mesh.facets.size();
  mesh.facets.erase(mesh.facets.begin() + static_cast<std::ptrdiff_t>(outer));
  mesh.facet_group.erase(mesh.facet_group.begin() + static_cast<std::ptrdiff_t>(outer));
  mesh.facet_face.erase(mesh.facet_face.begin() + static_cast<std::ptrdiff_t>(outer));
  const auto all = list_interfaces(mesh);
  EXPECT_EQ(all.outer, outer);
  EXPECT_EQ(all.given, count - 1);
  ASSERT_EQ(all.mesh.facets.size(), count);
  EXPECT_EQ(std::count(all.mesh.facet_face.begin(), all.mesh.facet_face.end(), 17), 1);
  for (std::size_t f = outer; f < count; ++f)
    EXPECT_GT(facet_normal<3>(all.mesh.corners(all.mesh.facets[f]))[0], 0) << "outward from body 0";
}

TEST(Interfaces, AFaceWithinABodyIsNoFacet) {
  auto mesh = two_body_box<3>(4);
  mesh.facets.push_back(opposite_facet<3>(mesh.elements[0], 0));
  mesh.facet_group.push_back(0);
  mesh.facet_face.push_back(0);
  EXPECT_FALSE(validate(mesh).ok());
  auto twice = with_interfaces(two_body_box<3>(4));
  twice.facets.push_back(twice.facets.back());
  twice.facet_group.push_back(0);
  twice.facet_face.push_back(0);
  EXPECT_FALSE(validate(twice).ok());
}

TEST(Interfaces, DroppingABodyMakesThemBoundary) {
  const auto mesh = with_interfaces(two_body_box<3>(4));
  for (std::int32_t body : {0, 1}) {
    std::vector<NodeId> new_id;
    const auto rest = drop_body(mesh, body, &new_id);
    ASSERT_TRUE(validate(rest).ok());
    EXPECT_EQ(rest.bodies, std::vector<std::string>{mesh.bodies[1 - body]});
    EXPECT_NEAR(measure_of(rest, static_cast<std::int32_t>(mesh.groups.size()) - 1), 1, 1e-12);
    std::vector<Vec<3>> points = mesh.points;
    compact_field(new_id, points);
    EXPECT_EQ(points, rest.points);
  }
}

TEST(Interfaces, BetweenBodiesThatRemainStayListed) {
  auto three = two_body_box<3>(4);
  three.bodies.push_back("top");
  for (std::size_t e = 0; e < three.elements.size(); ++e) {
    Vec<3> center = Vec<3>::Zero();
    for (NodeId n : three.elements[e]) center += three.points[n] / 4;
    if (center[2] > 0.5) three.element_body[e] = 2;
  }
  const auto rest = drop_body(with_interfaces(three), 2);
  ASSERT_TRUE(validate(rest).ok());
  const auto all = list_interfaces(rest);
  EXPECT_EQ(all.given, all.mesh.facets.size());
  EXPECT_GT(all.given, all.outer);
}

}  // namespace
}  // namespace lamella
