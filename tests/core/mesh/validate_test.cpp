#include "core/mesh/validate.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/mesh/boundary.h"
#include "core/mesh/sample_meshes.h"

namespace lamella {
namespace {

template <class T>
class ValidateTest : public testing::Test {
 protected:
  static constexpr int D = T::value;
  SimplexMesh<D> mesh = unit_box<D>(2);

  MeshReport report() const { return *inspect(mesh); }
  void expect_refused(const std::string& words) const {
    const auto result = validate(mesh);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, Code::bad_input);
    EXPECT_NE(result.error().message.find(words), std::string::npos) << result.error().message;
  }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                  std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(ValidateTest, Dimensions);

TYPED_TEST(ValidateTest, AcceptsABoxAndBothVolumesAgree) {
  const MeshReport r = this->report();
  EXPECT_TRUE(r.valid()) << r.first_finding;
  EXPECT_NEAR(r.volume, 1, 1e-12);
  EXPECT_NEAR(r.volume_boundary, 1, 1e-12);
  EXPECT_NEAR(r.boundary_area, 2 * this->D, 1e-12);
  // Each element has D + 1 faces; interior ones are counted twice.
  EXPECT_EQ(2 * r.faces_interior + r.faces_boundary, r.elements * (this->D + 1));
  EXPECT_TRUE(validate(this->mesh).ok());
}

TYPED_TEST(ValidateTest, BothVolumesAgreeFarFromTheOrigin) {
  for (auto& x : this->mesh.points) x.array() += 1e4;
  EXPECT_TRUE(this->report().valid()) << this->report().first_finding;
}

TYPED_TEST(ValidateTest, FindsAnInvertedElement) {
  std::swap(this->mesh.elements[0][0], this->mesh.elements[0][1]);
  EXPECT_EQ(this->report().inverted, 1u);
  EXPECT_GT(this->report().misoriented, 0u);
  EXPECT_FALSE(this->report().conforming());
  this->expect_refused("Elements 0 and");
}

TYPED_TEST(ValidateTest, FindsAFlatElement) {
  auto& e = this->mesh.elements[0];
  this->mesh.points[e[0]] = this->mesh.points[e[1]];
  EXPECT_GE(this->report().inverted, 1u);
}

TYPED_TEST(ValidateTest, FindsAFaceOfThreeElements) {
  this->mesh.elements.push_back(this->mesh.elements[0]);
  this->mesh.element_body.push_back(0);
  // Inside, the copy makes faces of three elements; on the boundary, pairs on the same side.
  EXPECT_EQ(this->report().faces_shared + this->report().misoriented, this->D + 1u);
  EXPECT_GT(this->report().faces_shared, 0u);
  EXPECT_FALSE(this->report().conforming());
}

TYPED_TEST(ValidateTest, FindsElementsThatCoverEachOther) {
  // A node pulled through the opposite side: volumes of (1.22) and (1.23) part.
  this->mesh = unit_box<TypeParam::value>(3);
  for (auto& x : this->mesh.points)
    if ((x.array() > 0.3).all() && (x.array() < 0.4).all()) x.array() += 0.9;
  const MeshReport r = this->report();
  EXPECT_GT(r.inverted, 0u);
  EXPECT_FALSE(r.volumes_agree());
  EXPECT_GT(r.volume, r.volume_boundary * 1.01);
  EXPECT_NEAR(r.volume_boundary, 1, 1e-12);
}

TYPED_TEST(ValidateTest, FindsMissingExtraAndInwardFacets) {
  const auto facet = this->mesh.facets.back();
  this->mesh.facets.pop_back();
  this->mesh.facet_group.pop_back();
  this->mesh.facet_face.pop_back();
  EXPECT_EQ(this->report().facets_missing, 1u);
  this->expect_refused("not listed as a facet");

  this->mesh.facets.push_back(facet);
  this->mesh.facets.push_back(facet);
  this->mesh.facet_group.insert(this->mesh.facet_group.end(), 2, 0);
  this->mesh.facet_face.insert(this->mesh.facet_face.end(), 2, 0);
  EXPECT_EQ(this->report().facets_extra, 1u);
  this->expect_refused("listed twice");

  this->mesh.facets.pop_back();
  this->mesh.facet_group.pop_back();
  this->mesh.facet_face.pop_back();
  std::swap(this->mesh.facets[0][0], this->mesh.facets[0][1]);
  EXPECT_EQ(this->report().facets_inward, 1u);
  EXPECT_TRUE(this->report().conforming());
  this->expect_refused("points inward");
}

TYPED_TEST(ValidateTest, FindsUnusedNodes) {
  this->mesh.points.push_back(Vec<TypeParam::value>::Constant(0.4));
  EXPECT_EQ(this->report().unused, 1u);
  this->expect_refused("belongs to no element");
}

TYPED_TEST(ValidateTest, FindsBrokenArraysBeforeFollowingThem) {
  const auto good = this->mesh;
  this->mesh.elements[1][0] = 100000;
  EXPECT_EQ(this->report().bad_indices, 1u);
  this->mesh = good;
  this->mesh.elements[1][0] = 0;  // the virtual node is part of no stored element
  EXPECT_EQ(this->report().bad_indices, 1u);
  this->mesh = good;
  this->mesh.elements[1][0] = this->mesh.elements[1][1];
  EXPECT_EQ(this->report().bad_indices, 1u);
  this->mesh = good;
  this->mesh.element_body.pop_back();
  EXPECT_EQ(this->report().bad_arrays, 1u);
  this->mesh = good;
  this->mesh.facet_group[0] = 7;
  EXPECT_EQ(this->report().bad_arrays, 1u);
  this->mesh = good;
  this->mesh.points[3][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(this->report().bad_points, 1u);
  EXPECT_FALSE(this->report().valid());
}

TYPED_TEST(ValidateTest, CanBeCancelled) {
  std::stop_source source;
  source.request_stop();
  const auto r = inspect(this->mesh, Progress({}, source.get_token()));
  ASSERT_FALSE(r.ok());
  EXPECT_EQ(r.error().code, Code::cancelled);
}

}  // namespace
}  // namespace lamella
