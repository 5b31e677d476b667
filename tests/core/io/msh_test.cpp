#include "core/io/msh.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "core/base/atomic_file.h"
#include "core/io/export_certificate.h"
#include "tests/support/box_mesh.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

MetricField<3> some_metric(const SimplexMesh<3>& mesh) {
  MetricField<3> metric;
  for (const Vec<3>& x : mesh.points) {
    const Vec<3> v = x + Vec<3>(0.1, 0.2, 0.3);
    metric.push_back(v * v.transpose() + 2 * Metric<3>::Identity());
  }
  return metric;
}

class Msh : public testing::TestWithParam<bool> {
 protected:
  const test::TemporaryFolder folder;
  const SimplexMesh<3> mesh = test::box_mesh(2, 3, 2, true);
  const MetricField<3> metric = some_metric(mesh);
  const std::vector<double> thickness = std::vector<double>(mesh.points.size(), 1.0 / 3);

  void write() {
    MeshFields fields;
    fields.metric = &metric;
    fields.thickness = &thickness;
    ASSERT_TRUE(write_msh(mesh, fields, folder / "m.msh", {.binary = GetParam()}).ok());
  }
};

TEST_P(Msh, ReadsBackEverythingBitForBit) {
  write();
  const Result<MeshContent> back = read_msh(folder / "m.msh");
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->mesh.points, mesh.points);
  EXPECT_EQ(back->mesh.bodies, mesh.bodies);
  EXPECT_EQ(back->mesh.groups, mesh.groups);
  EXPECT_EQ(back->metric[5], metric[5]);
  EXPECT_EQ(back->thickness[5], thickness[5]);
  const ExportCertificate proof =
      certify("m.msh", "Gmsh MSH 4.1", summarize(mesh), summarize(back->mesh));
  EXPECT_TRUE(proof.agrees) << proof.finding;
  EXPECT_DOUBLE_EQ(proof.read_back.bodies[0].measure, 6);
  EXPECT_DOUBLE_EQ(proof.read_back.groups[1].measure, 6);
}

TEST_P(Msh, EveryTruncationIsRefused) {
  write();
  const std::string bytes = read_file(folder / "m.msh").value();
  for (const double share : {0.0, 0.001, 0.02, 0.3, 0.6, 0.9, 0.999}) {
    const auto length = static_cast<std::size_t>(share * static_cast<double>(bytes.size()));
    ASSERT_TRUE(write_file(folder / "cut.msh", bytes.substr(0, length)).ok());
    const Result<MeshContent> cut = read_msh(folder / "cut.msh");
    ASSERT_FALSE(cut.ok()) << share;
    EXPECT_EQ(cut.error().code, Code::bad_input);
    EXPECT_NE(cut.error().message.find("cut.msh"), std::string::npos);
  }
}

TEST_P(Msh, CancelLeavesNothingBehind) {
  std::stop_source stop;
  stop.request_stop();
  const Result<void> result =
      write_msh(mesh, {}, folder / "m.msh", {.binary = GetParam()}, Progress({}, stop.get_token()));
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, Code::cancelled);
  EXPECT_TRUE(folder.names().empty());
}

/// What a command prints, with its exit status.
std::pair<int, std::string> output_of(const std::string& command) {
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  std::string text;
  char buffer[4096];
  while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, n);
  return {::pclose(pipe), text};
}

TEST_P(Msh, GmshReadsTheNamesAndTheMetric) {
  if (output_of("command -v gmsh").first != 0) {
    // Gmsh is a witness from outside and need not be installed; the round trip above always runs.
    std::puts("gmsh is not installed: its reading of the file was not tried");
    return;
  }
  write();
  ASSERT_TRUE(write_file(folder / "names.geo",
                         "Merge \"m.msh\";\n"
                         "Printf(Str(Physical Volume{1}));\n"
                         "Printf(Str(Physical Volume{2}));\n"
                         "Printf(Str(Physical Surface{3}));\n"
                         "Printf(Str(Physical Surface{4}));\n"
                         "Printf(\"views %g\", PostProcessing.NbViews);\n")
                  .ok());
  const auto [status, text] =
      output_of("cd " + folder.path().string() + " && gmsh -parse_and_exit names.geo");
  EXPECT_EQ(status, 0);
  for (const std::string name : {"\nleft\n", "\nright\n", "\nwalls\n", "\ngate\n", "views 2"})
    EXPECT_NE(text.find(name), std::string::npos) << text;
  EXPECT_EQ(text.find("Error"), std::string::npos) << text;
  EXPECT_EQ(text.find("Warning"), std::string::npos) << text;
}

INSTANTIATE_TEST_SUITE_P(TextAndBinary, Msh, testing::Bool(),
                         [](const auto& p) { return p.param ? "Binary" : "Text"; });

TEST(MshRead, OtherVersionsAreRefusedWithAHint) {
  const test::TemporaryFolder folder;
  for (const std::string version : {"1.0 0 8", "2.2 1 8", "3.0 0 8", "4.0 0 8"}) {
    ASSERT_TRUE(
        write_file(folder / "old.msh", "$MeshFormat\n" + version + "\n$EndMeshFormat\n").ok());
    const Result<MeshContent> old = read_msh(folder / "old.msh");
    ASSERT_FALSE(old.ok());
    EXPECT_NE(old.error().hint.find("msh41"), std::string::npos) << version;
  }
}

TEST(MshRead, NodesNumberedWithGapsAreRenumberedInOrder) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_file(folder / "gaps.msh",
                         "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
                         "$Nodes\n1 4 7 40\n3 9 0 4\n40\n7\n10\n20\n"
                         "0 0 1\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n"
                         "$Elements\n1 1 1 1\n3 9 4 1\n1 7 10 20 40\n$EndElements\n")
                  .ok());
  const Result<MeshContent> back = read_msh(folder / "gaps.msh");
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->mesh.elements.at(0), (SimplexMesh<3>::Element{1, 2, 3, 4}));
  EXPECT_DOUBLE_EQ(signed_measure<3>(back->mesh.corners(back->mesh.elements[0])), 1.0 / 6);
  EXPECT_EQ(back->mesh.bodies, std::vector<std::string>{"body 9"});
}

TEST(Certificate, TellsWhatDiffers) {
  const SimplexMesh<3> mesh = test::box_mesh(2, 2, 1, true);
  SimplexMesh<3> other = mesh;
  other.bodies[1] = "wrong";
  other.points[1] += Vec<3>(0, 0, -1e-6);
  const ExportCertificate proof = certify("f", "x", summarize(mesh), summarize(other));
  EXPECT_FALSE(proof.agrees);
  EXPECT_NE(proof.finding.find("\"right\" reads back as \"wrong\""), std::string::npos);
  EXPECT_GT(proof.worst_difference, 1e-8);
}

TEST(Certificate, AGroupWithoutFacetsLeavesNoTraceWhereThereAreNoNames) {
  const SimplexMesh<3> mesh = test::box_mesh(2, 2, 1, true);
  SimplexMesh<3> other = mesh;
  other.groups.push_back("empty");
  EXPECT_FALSE(certify("f", "x", summarize(other), summarize(mesh)).agrees);
  EXPECT_TRUE(certify("f", "x", summarize(other), summarize(mesh), false).agrees);
}

// A tetrahedron of second order with a triangle of its boundary, as Gmsh writes them.
const char* const kSecondOrder = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
10
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 .5 0 0
6 .5 .5 0
7 0 .5 0
8 0 0 .5
9 0 .5 .5
10 .5 0 .5
$EndNodes
$Elements
2
1 9 2 7 1 1 3 2 7 6 5
2 11 2 3 1 1 2 3 4 5 6 7 8 9 10
$EndElements
$NodeData
1
"size"
1
0
3
0
1
10
1 .1
2 .2
3 .3
4 .4
5 9
6 9
7 9
8 9
9 9
10 9
$EndNodeData
)";

TEST(MshOfOthers, SecondOrderCountsByItsCorners) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_file(folder / "m.msh", kSecondOrder).ok());
  const Result<MeshContent> back = read_msh(folder / "m.msh");
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->mesh.node_count(), 4u);
  ASSERT_EQ(back->mesh.element_count(), 1u);
  EXPECT_NEAR(signed_measure<3>(back->mesh.corners(back->mesh.elements[0])), 1.0 / 6, 1e-15);
  ASSERT_EQ(back->mesh.facets.size(), 1u);
  EXPECT_EQ(back->mesh.groups, (std::vector<std::string>{"group 7"}));
  ASSERT_EQ(back->of_nodes.size(), 1u);
  EXPECT_EQ(back->of_nodes[0].values, (std::vector<double>{0, 0.1, 0.2, 0.3, 0.4}));
}

TEST(MshOfOthers, AViewWithValuesAtCornersIsAveragedAtTheNodes) {
  // As `Save View` of Gmsh writes one: the elements that are no tetrahedra have values too.
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_file(folder / "view.msh", R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
5
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 1 1 1
$EndNodes
$Elements
3
1 2 2 1 1 1 2 3
7 4 2 1 1 1 2 3 4
9 4 2 1 1 2 3 4 5
$EndElements
$ElementNodeData
1
"T"
1
0
3
0
1
3
1 3 100 100 100
7 4 1 2 3 4
9 4 4 3 8 6
$EndElementNodeData
)"));
  const Result<MeshContent> content = read_msh(folder / "view.msh");
  ASSERT_TRUE(content.ok()) << content.error().message;
  ASSERT_EQ(content->of_nodes.size(), 1u);
  EXPECT_EQ(content->of_nodes[0].name, "T");
  EXPECT_EQ(content->of_nodes[0].values, (std::vector<double>{0, 1, 3, 3, 6, 6}));
}

TEST(MshOfOthers, SolidsThatAreNoTetrahedraAreRefusedNotLost) {
  const test::TemporaryFolder folder;
  std::string text = kSecondOrder;
  const std::size_t at = text.find("2 11 2 3 1");
  text.replace(at, text.find('\n', at) - at, "2 5 2 3 1 1 2 3 4 5 6 7 8");
  ASSERT_TRUE(write_file(folder / "m.msh", text).ok());
  const Result<MeshContent> back = read_msh(folder / "m.msh");
  ASSERT_FALSE(back.ok());
  EXPECT_NE(back.error().message.find("hexahedra"), std::string::npos) << back.error().message;
}

}  // namespace
}  // namespace lamella
