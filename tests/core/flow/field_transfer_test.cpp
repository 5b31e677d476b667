#include "core/flow/field_transfer.h"

#include <gtest/gtest.h>

#include "core/mesh/sample_meshes.h"
#include "core/study/measure.h"

namespace lamella {
namespace {

double linear(const Vec<3>& x) { return 1 + x.dot(Vec<3>(2, -3, 5)); }

std::vector<double> values_of(const SimplexMesh<3>& mesh) {
  std::vector<double> out;
  for (const Vec<3>& p : mesh.points) {
    out.push_back(linear(p));
    out.push_back(-linear(p));
    out.push_back(7);
  }
  return out;
}

SimplexMesh<3> box(int cells, const Vec<3>& low, const Vec<3>& high) {
  return box_mesh<3>({cells, cells, cells}, low, high);
}

TEST(FieldTransfer, IsExactForLinearFieldsBetweenMeshesOfOneBody) {
  const auto from = box(3, Vec<3>::Zero(), Vec<3>::Ones()),
             to = box(7, Vec<3>::Zero(), Vec<3>::Ones());
  const auto found = transfer_field(from, values_of(from), 3, to);
  ASSERT_TRUE(found.ok()) << found.error().message;
  const std::vector<double> expected = values_of(to);
  ASSERT_EQ(found->values.size(), expected.size());
  for (std::size_t i = 3; i < expected.size(); ++i)
    EXPECT_NEAR(found->values[i], expected[i], 1e-12);
  EXPECT_EQ(found->outside, 0u);
}

TEST(FieldTransfer, CountsNodesOutsideWhichTakeTheNearestPlace) {
  const auto from = box(3, Vec<3>::Zero(), Vec<3>(1, 1, 0.9)),
             to = box(4, Vec<3>::Zero(), Vec<3>::Ones());
  const auto found = transfer_field(from, values_of(from), 3, to);
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_EQ(found->outside, 25u);
  EXPECT_NEAR(found->farthest, 0.1, 1e-12);
  for (std::size_t n = 1; n < to.points.size(); ++n) {
    Vec<3> x = to.points[n];
    x[2] = std::min(x[2], 0.9);
    EXPECT_NEAR(found->values[3 * n], linear(x), 1e-12);
  }
}

TEST(FieldTransfer, RefusesAnotherUnitPlaceOrLength) {
  const auto to = box(2, Vec<3>::Zero(), Vec<3>::Ones());
  for (const double unit : {1e-3, 0.1, 10.0, 1000.0}) {
    const auto from = box(2, Vec<3>::Zero(), Vec<3>::Constant(unit));
    const auto found = transfer_field(from, values_of(from), 3, to);
    ASSERT_FALSE(found.ok()) << unit;
    EXPECT_EQ(found.error().code, Code::bad_input);
    EXPECT_NE(found.error().hint.find("unit"), std::string::npos);
  }
  const auto beside = box(2, Vec<3>::Constant(3), Vec<3>::Constant(4));
  EXPECT_FALSE(transfer_field(beside, values_of(beside), 3, to).ok());
  EXPECT_FALSE(transfer_field(to, {1, 2}, 1, to).ok());
}

TEST(FieldTransfer, TheHintSaysWhatUnitWouldFit) {
  const auto to = box(2, Vec<3>::Zero(), Vec<3>::Constant(50)),
             meters = box(2, Vec<3>::Zero(), Vec<3>::Constant(0.05));
  const auto found = transfer_field(meters, values_of(meters), 3, to);
  ASSERT_FALSE(found.ok());
  EXPECT_NE(found.error().hint.find("1000 times"), std::string::npos) << found.error().hint;
}

TEST(FieldTransfer, AShiftedPartIsRefusedWithItsDistance) {
  const auto to = box(4, Vec<3>::Zero(), Vec<3>::Constant(10)),
             shifted = box(4, Vec<3>(8, 0, 0), Vec<3>(18, 10, 10));
  const auto found = transfer_field(shifted, values_of(shifted), 3, to);
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(found.error().code, Code::bad_input);
  EXPECT_NE(found.error().message.find("up to 8 mm"), std::string::npos) << found.error().message;
  EXPECT_NE(found.error().hint.find("shifted"), std::string::npos);
  const auto surface = boundary_surface(to, 0);
  EXPECT_FALSE(check_place(shifted, surface, 17.3).ok());
  EXPECT_TRUE(check_place(to, surface, 17.3).ok());
}

TEST(FieldTransfer, AFieldOfTheWholeCoversASmallPartOfIt) {
  const auto whole = box(4, Vec<3>::Zero(), Vec<3>::Constant(100)),
             insert = box(2, Vec<3>::Constant(40), Vec<3>::Constant(45));
  EXPECT_FALSE(transfer_field(whole, values_of(whole), 3, insert).ok());
  const auto found = transfer_field(whole, values_of(whole), 3, insert, 0, {}, 173.2);
  ASSERT_TRUE(found.ok()) << found.error().message;
  for (std::size_t n = 1; n < insert.points.size(); ++n)
    EXPECT_NEAR(found->values[3 * n], linear(insert.points[n]), 1e-9);
}

}  // namespace
}  // namespace lamella
