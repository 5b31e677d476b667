#include "core/io/msh.h"
#include "tests/support/cli_fixture.h"

namespace lamella {
namespace {

/// Meshes from elsewhere whose files say what they want to be adapted to.
class CliField : public Cli {
 protected:
  const SimplexMesh<3> mesh = box_mesh<3>({4, 4, 4}, Vec<3>::Zero(), Vec<3>::Ones());

  void write_with(const MeshFields& fields) {
    ASSERT_TRUE(write_msh(mesh, fields, folder / "m.msh").ok());
  }
  NodeField at_nodes(const std::string& name, std::vector<double> value) const {
    NodeField field{name, static_cast<int>(value.size()), {}};
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
      field.values.insert(field.values.end(), value.begin(), value.end());
    return field;
  }
  double elements_after(const std::string& options) {
    EXPECT_EQ(run("adapt m.msh --iterations 1 --json -o a.msh " + options), 0) << err;
    for (const json& line : lines())
      if (line["phase"] == "iteration") return line["elements"];
    return 0;
  }
};

TEST_F(CliField, SizesAtNodesOrInElementsAskForTheSameMeshAsTheirMetric) {
  MeshFields fields;
  fields.of_nodes = {at_nodes("size", {0.2})};
  fields.of_elements = {{"h", std::vector<double>(mesh.elements.size(), 0.2)}};
  write_with(fields);
  const double analytic = elements_after("--metric uniform:h=0.2");
  EXPECT_GT(analytic, 500);
  EXPECT_NEAR(elements_after("--field size") / analytic, 1, 0.1);
  EXPECT_NEAR(elements_after("--field h") / analytic, 1, 0.1);
}

TEST_F(CliField, TheOnlyTensorNeedsNoName) {
  MeshFields fields;
  fields.of_nodes = {at_nodes("asked", {25, 0, 0, 0, 25, 0, 0, 0, 100}), at_nodes("p", {1})};
  write_with(fields);
  const double analytic = elements_after("--metric constaniso:hx=0.2,hy=0.2,hz=0.1");
  EXPECT_NEAR(elements_after("") / analytic, 1, 0.1);
  EXPECT_NEAR(elements_after("--field asked") / analytic, 1, 0.1);
}

TEST_F(CliField, WhatIsNoMetricIsRefusedByItsPlace) {
  MeshFields fields;
  fields.of_nodes = {at_nodes("size", {0.2}), at_nodes("v", {1, 2, 3}),
                     at_nodes("skew", {1, 0, 0, 0, -1, 0, 0, 0, 1})};
  fields.of_nodes[0].values[7] = 0;
  write_with(fields);
  for (const auto& [field, words] :
       std::map<std::string, std::string>{{"size", "the size of node 7 is not positive"},
                                          {"skew", "the matrix of node 1 is not positive definite"},
                                          {"v", "no field \"v\" of sizes or of tensors"},
                                          {"T", "no field \"T\" of sizes or of tensors"}}) {
    EXPECT_EQ(run("adapt m.msh -o a.msh --field " + field), 3);
    EXPECT_NE(err.find(words), std::string::npos) << err;
  }
  EXPECT_NE(err.find("\"skew\", \"size\""), std::string::npos) << "it names those there are";
  write_with({});
  EXPECT_EQ(run("adapt m.msh -o a.msh"), 3);
  EXPECT_NE(err.find("no metric"), std::string::npos) << err;
}

}  // namespace
}  // namespace lamella
