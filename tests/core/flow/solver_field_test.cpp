#include "core/flow/solver_field.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/mesh/sample_meshes.h"

namespace lamella {
namespace {

/// A cube of 2 units with the number "T" and the vector "U" at its nodes.
MeshContent cube() {
  MeshContent content;
  content.mesh = box_mesh<3>({2, 2, 2}, Vec<3>::Zero(), Vec<3>::Constant(2));
  content.of_nodes = {{"T", 1, std::vector<double>(content.mesh.points.size(), 7)},
                      {"U", 3, std::vector<double>(3 * content.mesh.points.size(), 1)}};
  return content;
}

TEST(SolverField, LengthsBecomeMillimeters) {
  const Result<SolverField> found = solver_field(cube(), "U", 1000, "f.vtu");
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_EQ(found->field.name, "U");
  EXPECT_EQ(found->field.components, 3);
  EXPECT_NEAR(diagonal_of_nodes(found->mesh), 2000 * std::sqrt(3.0), 1e-9);
}

TEST(SolverField, AFieldThatIsNotThereIsToldWithThoseThatAre) {
  const Result<SolverField> found = solver_field(cube(), "p", 1, "f.vtu");
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(found.error().code, Code::usage);
  EXPECT_NE(found.error().hint.find("T, U"), std::string::npos) << found.error().hint;
}

TEST(SolverField, PlacesWithoutANumberAreCountedWhereElementsAre) {
  MeshContent content = cube();
  content.mesh.points.push_back({9, 9, 9});  // of no element, as readers of other cells leave it
  content.of_nodes[0].values.push_back(std::numeric_limits<double>::quiet_NaN());
  content.of_nodes[1].values.insert(content.of_nodes[1].values.end(), 3, 1);
  EXPECT_TRUE(solver_field(content, "T", 1, "f.vtu").ok());
  content.of_nodes[0].values[3] = std::numeric_limits<double>::quiet_NaN();
  content.of_nodes[0].values[4] = std::numeric_limits<double>::infinity();
  const Result<SolverField> found = solver_field(content, "T", 1, "f.vtu");
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(found.error().code, Code::bad_input);
  EXPECT_NE(found.error().message.find("2 of 27 nodes"), std::string::npos)
      << found.error().message;
  EXPECT_TRUE(solver_field(content, "U", 1, "f.vtu").ok());
}

TEST(SolverField, NumbersOfElementsComeToTheNodes) {
  MeshContent content = cube();
  std::vector<double> x;
  for (const auto& e : content.mesh.elements) {
    double sum = 0;
    for (const NodeId n : e) sum += content.mesh.points[n][0] / 4;
    x.push_back(sum);
  }
  content.of_elements = {{"x", x}, {"T", std::vector<double>(x.size(), 0)}};
  elements_to_nodes(content);
  ASSERT_EQ(content.of_nodes.size(), 3u);
  EXPECT_EQ(content.of_nodes[0].values[1], 7) << "the nodes have it already";
  for (std::size_t n = 1; n < content.mesh.points.size(); ++n)
    EXPECT_NEAR(content.of_nodes[2].values[n], content.mesh.points[n][0], 0.6);
}

TEST(SolverField, TheUnitIsTheOneThatFits) {
  EXPECT_EQ(likely_unit(100, 101).name, "mm");
  EXPECT_EQ(likely_unit(0.1, 101).name, "m");
  EXPECT_EQ(likely_unit(4, 101).name, "inch");
  EXPECT_EQ(likely_unit(10, 101).name, "cm");
}

}  // namespace
}  // namespace lamella
