#include "core/io/medit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "core/base/atomic_file.h"
#include "core/mesh/sample_meshes.h"
#include "core/mesh/validate.h"
#include "tests/support/random_metric.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

class MeditTest : public testing::Test {
 protected:
  test::TemporaryFolder folder;
  std::filesystem::path path(const std::string& name) const { return folder.path() / name; }
  std::filesystem::path text(const std::string& content) const {
    EXPECT_TRUE(write_file(path("in.mesh"), content).ok());
    return path("in.mesh");
  }
  /// Reading fails with this code and a message that contains these words and the file's name.
  void expect_refused(const std::string& content, Code code, const std::string& words) const {
    const auto result = read_medit(text(content));
    ASSERT_FALSE(result.ok()) << words;
    EXPECT_EQ(result.error().code, code);
    EXPECT_NE(result.error().message.find(words), std::string::npos) << result.error().message;
    EXPECT_NE(result.error().message.find("in.mesh"), std::string::npos);
  }
  template <int D>
  void round_trip(SimplexMesh<D> mesh, const char* name = "a.mesh") const {
    // Digits that need all 17 places, and references that are not 1, 2, 3.
    for (auto& x : mesh.points) x = x * (1 / 3.0) + Vec<D>::Constant(1e-17);
    mesh.groups = {"ref 4", "ref 7"};
    for (std::size_t i = 0; i < mesh.facets.size(); ++i) {
      mesh.facet_group[i] = mesh.facet_face[i] % 2;
      mesh.facet_face[i] = mesh.facet_group[i] == 1 ? 7 : 4;
    }
    mesh.bodies = {"ref 10", "ref 20"};
    ASSERT_TRUE(write_medit(mesh, path(name)).ok());
    const auto back = read_medit<D>(path(name));
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_TRUE(std::equal(mesh.points.begin() + 1, mesh.points.end(), back->points.begin() + 1));
    EXPECT_EQ(back->elements, mesh.elements);
    EXPECT_EQ(back->element_body, mesh.element_body);
    EXPECT_EQ(back->bodies, mesh.bodies);
    EXPECT_EQ(back->facets, mesh.facets);
    EXPECT_EQ(back->facet_group, mesh.facet_group);
    EXPECT_EQ(back->facet_face, mesh.facet_face);
    EXPECT_EQ(back->groups, mesh.groups);
    EXPECT_TRUE(validate(*back).ok());
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  }
};

const char kSquare[] =
    "MeshVersionFormatted 2\nDimension 2\nVertices\n4\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
    "Triangles\n2\n1 2 3 5\n1 3 4 5\n";

TEST_F(MeditTest, MeshesComeBackBitForBit) {
  round_trip<2>(two_body_box<2>(4));
  round_trip<3>(two_body_box<3>(2));
  round_trip<4>(two_body_box<4>(2));
}

TEST_F(MeditTest, BinaryMeshesComeBackBitForBit) {
  round_trip<2>(two_body_box<2>(4), "a.meshb");
  round_trip<3>(two_body_box<3>(2), "a.meshb");
  EXPECT_EQ(write_medit(two_body_box<4>(2), path("b.meshb")).error().code, Code::usage);
}

TEST_F(MeditTest, PentatopesAreTheElementsOf4D) {
  const std::string head =
      "MeshVersionFormatted 2\nDimension 4\nVertices\n5\n0 0 0 0 1\n1 0 0 0 1\n";
  const std::string points = head + "0 1 0 0 1\n0 0 1 0 1\n0 0 0 1 1\n";
  const auto mesh =
      read_medit<4>(text(points + "Tetrahedra\n1\n2 3 4 5 9\nPentatopes\n1\n1 2 3 4 5 7\nEnd\n"));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_TRUE(validate(*mesh).ok());
  EXPECT_EQ(mesh->points[5], Vec<4>::Unit(3));
  EXPECT_EQ(mesh->facets.size(), 5u);
  EXPECT_EQ(mesh->bodies, (std::vector<std::string>{"ref 7"}));
  EXPECT_EQ(mesh->groups, (std::vector<std::string>{"ref 0", "ref 9"}));
  EXPECT_EQ(std::count(mesh->facet_group.begin(), mesh->facet_group.end(), 1), 1);

  expect_refused(head, Code::bad_input, "truncated");
  expect_refused(points + "Tetrahedra\n1\n2 3 4 5 9\nEnd\n", Code::bad_input, "no pentatopes");
  expect_refused(points + "Pentatopes\n1\n1 2 3 4 6 7\n", Code::bad_input,
                 "node 6 of Pentatopes 1 is out of range");
  expect_refused(points + "Pentatopes\n1\n1 2 3 4 4 7\n", Code::bad_input, "same node twice");
  expect_refused(points + "Pentatopes\n1\n1 2 3 4 5\n", Code::bad_input, "truncated");
  expect_refused("MeshVersionFormatted 2\nDimension 4\nPentatopes\n1\n1 2 3 4 5 0\n",
                 Code::bad_input, "before Vertices");
  // As many words as a 3D file has: the shift is noticed.
  expect_refused("MeshVersionFormatted 2\nDimension 4\nVertices\n2\n0 0 0 1\n1 0 0 1\nEnd\n",
                 Code::bad_input, "'End' where");
  EXPECT_FALSE(read_medit<3>(text(points + "Pentatopes\n1\n1 2 3 4 5 7\nEnd\n")).ok());
}

TEST_F(MeditTest, NamesThatAreNoReferencesAreNumberedFromOne) {
  auto mesh = two_body_box<3>(2);
  mesh.groups = {"gate"};
  ASSERT_TRUE(write_medit(mesh, path("a.mesh")).ok());
  const auto back = read_medit<3>(path("a.mesh"));
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(back->bodies, (std::vector<std::string>{"ref 1", "ref 2"}));
  EXPECT_EQ(back->groups, (std::vector<std::string>{"ref 1"}));
}

TEST_F(MeditTest, ToleratesCommentsUnknownSectionsAndAMissingBoundary) {
  const auto mesh = read_medit<2>(
      text("# made by hand\nMeshVersionFormatted\n1\n Dimension\n2\n\nVertices 4\n0 0 1\n+1 0 1 # "
           "first\n"
           "1e0 1. 1\n0 1 1\nCorners\n4\n1 2 3 4\nNormals\n2\n1 0\n-.7 nan\nNonsense\n1 2 3 4 5\n"
           "Triangles\n2\n1 2 3 5\n1 3 4 5\nRequiredVertices 0\nEnd\n"));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_TRUE(validate(*mesh).ok());
  EXPECT_EQ(mesh->facets.size(), 4u);
  EXPECT_EQ(mesh->groups, (std::vector<std::string>{"walls"}));
  EXPECT_EQ(mesh->bodies, (std::vector<std::string>{"ref 5"}));
}

TEST_F(MeditTest, AddsFacesThatTheFileForgotAndDropsInnerOnes) {
  const auto mesh = read_medit<2>(text(std::string(kSquare) + "Edges\n2\n2 1 9\n1 3 8\nEnd\n"));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_TRUE(validate(*mesh).ok());  // the edge 2 1 was listed inward
  EXPECT_EQ(mesh->facets.size(), 4u);
  EXPECT_EQ(mesh->groups, (std::vector<std::string>{"ref 0", "ref 9"}));
  EXPECT_EQ(std::count(mesh->facet_group.begin(), mesh->facet_group.end(), 1), 1);
}

TEST_F(MeditTest, KeepsUnusedNodesSoThatSolutionsFit) {
  std::string content(kSquare);
  content.replace(content.find("Vertices\n4"), 10, "Vertices\n5\n7 7 0");
  for (const auto& [from, to] : {std::pair{"1 2 3 5", "2 3 4 5"}, {"1 3 4 5", "2 4 5 5"}})
    content.replace(content.find(from), 7, to);
  const auto mesh = read_medit<2>(text(content));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->node_count(), 5u);
  EXPECT_EQ(inspect(*mesh)->unused, 1u);
}

TEST_F(MeditTest, ReadsAPlanarMeshStoredIn3D) {
  const auto mesh = read_medit(
      text("MeshVersionFormatted 2\nDimension 3\nVertices\n3\n0 0 2 0\n1 0 2 0\n0 1 2 0\n"
           "Triangles\n1\n1 2 3 0\nEnd\n"));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_TRUE(std::holds_alternative<SimplexMesh<2>>(*mesh));
}

TEST_F(MeditTest, RefusesWithOneClearSentence) {
  const auto missing = read_medit(path("none.mesh"));
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, Code::io);
  EXPECT_EQ(read_medit(folder.path()).error().code, Code::io);

  const std::string head = "MeshVersionFormatted 2\nDimension 3\nVertices\n";
  const std::string points = head + "4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";
  expect_refused("", Code::bad_input, "empty");
  expect_refused(" \n # only a comment\n", Code::bad_input, "empty");
  expect_refused("solid cube\n", Code::bad_input, "not a Medit file");
  expect_refused(std::string("\1\0\0\0\3\0\0\0", 8), Code::bad_input, "truncated");
  expect_refused(std::string("\1\0\0\0\7\0\0\0", 8), Code::bad_input, "not a Medit file");
  expect_refused(std::string("\0\0\0\1\0\0\0\2", 8), Code::bad_input, "other byte order");
  expect_refused("MeshVersionFormatted 2\nDimension 5\n", Code::bad_input,
                 "5 instead of 2, 3 or 4");
  expect_refused("MeshVersionFormatted 2\nDimension 3\nEnd\n", Code::bad_input, "no vertices");
  expect_refused(head + "4\n0 0 0 0\n1 0 0", Code::bad_input, "truncated");
  expect_refused(head + "4\n0 0 0 0\n1 0 0 0\n0 x 0 0\n", Code::bad_input, "line 7: 'x'");
  expect_refused(head + "-1\n", Code::bad_input, "cannot be -1 vertices");
  expect_refused(head + "99999999999\n", Code::bad_input, "cannot be 99999999999 vertices");
  expect_refused(points + "End\n", Code::bad_input, "no tetrahedra");
  expect_refused(points + "Tetrahedra\n1\n1 2 3 5 0\n", Code::bad_input,
                 "line 11: node 5 of Tetrahedra 1 is out of range");
  expect_refused(points + "Tetrahedra\n1\n0 1 2 3 0\n", Code::bad_input, "node 0");
  expect_refused(points + "Tetrahedra\n1\n1 2 3 3 0\n", Code::bad_input, "same node twice");
  expect_refused(points + "Tetrahedra\n2\n1 2 3 4 0\n", Code::bad_input, "truncated");
  expect_refused(points + "Triangles\n1\n2 3 4 0\n", Code::bad_input, "surface");
  expect_refused("MeshVersionFormatted 2\nDimension 3\nTetrahedra\n1\n1 2 3 4 0\n", Code::bad_input,
                 "before Vertices");
  EXPECT_FALSE(read_medit<3>(text(kSquare)).ok());
}

template <int D>
void check_truncations(const std::filesystem::path& file, const char* boundary_section) {
  ASSERT_TRUE(write_medit(unit_box<D>(1), file).ok());
  const std::string whole = *read_file(file);
  const std::size_t end = whole.find(boundary_section);
  for (std::size_t length = 0; length < end; ++length) {
    ASSERT_TRUE(write_file(file, whole.substr(0, length)).ok());
    const auto mesh = read_medit(file);
    // Only the last reference can be cut without a trace: every element is there.
    if (!mesh.ok()) continue;
    EXPECT_EQ(std::get<SimplexMesh<D>>(*mesh).element_count(), std::size_t{factorial(D)}) << length;
  }
}

TEST_F(MeditTest, EveryTruncationIsRefusedOrLosesOnlyOptionalParts) {
  check_truncations<3>(path("box.mesh"), "Triangles");
  check_truncations<4>(path("box.mesh"), "Tetrahedra");
}

TEST_F(MeditTest, FailingToWriteLeavesNothingBehind) {
  const auto mesh = unit_box<3>(1);
  EXPECT_EQ(write_medit(mesh, path("no/such/folder.mesh")).error().code, Code::io);
  EXPECT_EQ(write_medit(mesh, folder.path()).error().code, Code::io);
  std::stop_source source;
  source.request_stop();
  const Progress stopped({}, source.get_token());
  EXPECT_EQ(write_medit(mesh, path("a.mesh"), stopped).error().code, Code::cancelled);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  ASSERT_TRUE(write_medit(mesh, path("a.mesh")).ok());
  EXPECT_EQ(read_medit(path("a.mesh"), stopped).error().code, Code::cancelled);
}

template <int D>
void check_sol(const std::filesystem::path& file) {
  std::mt19937 rng(5);
  MetricField<D> field(1, Metric<D>::Identity());
  for (int i = 0; i < 100; ++i) field.push_back(test::random_metric<D>(rng, 1e4));
  ASSERT_TRUE(write_sol<D>(field, file).ok());
  const auto back = read_sol<D>(file, 100);
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(*back, field);
}

TEST_F(MeditTest, MetricsComeBackBitForBit) {
  check_sol<2>(path("a.sol"));
  check_sol<3>(path("b.sol"));
  check_sol<4>(path("c.sol"));
}

TEST_F(MeditTest, MetricEntriesAreInMeditOrder) {
  Metric<3> m;
  m << 11, 2, 3, 2, 22, 4, 3, 4, 33;
  ASSERT_TRUE(write_sol<3>({Metric<3>::Identity(), m}, path("a.sol")).ok());
  EXPECT_NE(read_file(path("a.sol"))->find("1 3\n11 2 22 3 4 33\n"), std::string::npos);
  Metric<4> m4;
  m4 << 11, 2, 3, 5, 2, 22, 4, 6, 3, 4, 33, 7, 5, 6, 7, 44;
  ASSERT_TRUE(write_sol<4>({Metric<4>::Identity(), m4}, path("a.sol")).ok());
  EXPECT_NE(read_file(path("a.sol"))->find("1 3\n11 2 22 3 4 33 5 6 7 44\n"), std::string::npos);
}

TEST_F(MeditTest, ScalarSizesBecomeIsotropicMetrics) {
  const auto file =
      text("MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n2\n1 1\n0.5\n0.1\nEnd\n");
  const auto metric = read_sol<2>(file, 2);
  ASSERT_TRUE(metric.ok()) << metric.error().message;
  EXPECT_EQ((*metric)[1], isotropic_metric<2>(0.5));
  EXPECT_EQ((*metric)[2], isotropic_metric<2>(0.1));
}

TEST_F(MeditTest, RefusesSolutionsThatDoNotFit) {
  const std::string head = "MeshVersionFormatted 2\nDimension 3\n";
  const auto refused = [&](const std::string& content, const std::string& words) {
    const auto r = read_sol<3>(text(content), 1);
    ASSERT_FALSE(r.ok()) << words;
    EXPECT_EQ(r.error().code, Code::bad_input);
    EXPECT_NE(r.error().message.find(words), std::string::npos) << r.error().message;
  };
  refused(head + "SolAtVertices\n2\n1 3\n", "2 nodal values, the mesh has 1");
  refused(head + "SolAtVertices\n1\n2 1 1\n1 1\n", "2 fields");
  refused(head + "SolAtVertices\n1\n1 2\n1 1 1\n", "type 2");
  refused(head + "SolAtVertices\n1\n1 3\n1 0 1 0 0\n", "truncated");
  refused(head + "SolAtVertices\n1\n1 3\n1 2 1 0 0 1\n", "not positive definite");
  refused(head + "SolAtVertices\n1\n1 1\n-1\n", "not positive");
  refused(head + "End\n", "no section SolAtVertices");
  refused("MeshVersionFormatted 2\nDimension 2\n", "is for 2D");
  EXPECT_EQ(read_sol<3>(path("none.sol"), 1).error().code, Code::io);
}

}  // namespace
}  // namespace lamella
