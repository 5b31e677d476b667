#include "core/io/medit_binary.h"

#include <gtest/gtest.h>

#include "core/base/atomic_file.h"
#include "core/io/medit.h"
#include "core/io/mesh_file.h"
#include "tests/support/foreign_program.h"
#include "tests/support/measures.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

/// Bytes as other programs write them, in one of the four versions.
class Bytes {
 public:
  explicit Bytes(std::int32_t version) : version_(version) {
    put<std::int32_t>(1);
    put(version);
  }
  template <class T>
  void put(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void integer(int value) { version_ < 4 ? put<std::int32_t>(value) : put<std::int64_t>(value); }
  void real(double value) { version_ < 2 ? put(static_cast<float>(value)) : put(value); }
  /// `write` puts what is between the keyword and the next one.
  template <class Write>
  void section(std::int32_t keyword, const Write& write) {
    put(keyword);
    const std::size_t place = bytes_.size();
    position(0);
    write();
    std::string after = bytes_.substr(place + (version_ < 3 ? 4 : 8));
    const std::size_t next = bytes_.size();
    bytes_.resize(place);
    position(next);
    bytes_ += after;
  }
  void end() {
    put<std::int32_t>(54);
    position(0);
  }
  const std::string& all() const { return bytes_; }

 private:
  void position(std::size_t at) {
    version_ < 3 ? put(static_cast<std::int32_t>(at)) : put(static_cast<std::int64_t>(at));
  }
  std::int32_t version_;
  std::string bytes_;
};

/// One tetrahedron, with a section that is of no use here before its points.
std::string one_tetrahedron(int version) {
  Bytes b(version);
  b.section(3, [&] { b.put<std::int32_t>(3); });
  b.section(13, [&] {  // corners
    b.integer(1);
    b.integer(4);
  });
  b.section(4, [&] {
    b.integer(4);
    for (const Vec<3>& x : {Vec<3>(0, 0, 0), Vec<3>(1.5, 0, 0), Vec<3>(0, 2, 0), Vec<3>(0, 0, 3)}) {
      for (int k = 0; k < 3; ++k) b.real(x[k]);
      b.integer(0);
    }
  });
  b.section(8, [&] {
    b.integer(1);
    for (const int v : {1, 2, 3, 4, 17}) b.integer(v);
  });
  b.end();
  return b.all();
}

TEST(MeditBinary, EveryVersionIsRead) {
  const test::TemporaryFolder folder;
  for (const int version : {1, 2, 3, 4}) {
    ASSERT_TRUE(write_file(folder / "m.meshb", one_tetrahedron(version)));
    const auto mesh = read_medit<3>(folder / "m.meshb");
    ASSERT_TRUE(mesh) << version << mesh.error().message;
    EXPECT_EQ(mesh->elements, (std::vector<SimplexMesh<3>::Element>{{1, 2, 3, 4}}));
    EXPECT_EQ(mesh->points[4], Vec<3>(0, 0, 3));
    EXPECT_EQ(mesh->bodies, std::vector<std::string>{"ref 17"});
  }
}

TEST(MeditBinary, ABinarySolutionIsRead) {
  const test::TemporaryFolder folder;
  Bytes b(2);
  b.section(3, [&] { b.put<std::int32_t>(3); });
  b.section(62, [&] {
    for (const int n : {2, 1, 3}) b.put<std::int32_t>(n);
    for (const double m : {4.0, 1.0, 9.0, 0.0, 0.5, 16.0, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0}) b.real(m);
  });
  b.end();
  ASSERT_TRUE(write_file(folder / "m.solb", b.all()));
  const auto metric = read_sol<3>(folder / "m.solb", 2);
  ASSERT_TRUE(metric) << metric.error().message;
  EXPECT_EQ((*metric)[1](0, 1), 1);
  EXPECT_EQ((*metric)[1](1, 1), 9);
  EXPECT_EQ((*metric)[1](2, 1), 0.5);
  EXPECT_EQ((*metric)[1](2, 2), 16);
}

TEST(MeditBinary, CutAnywhereItIsRefused) {
  const test::TemporaryFolder folder;
  const std::string whole = one_tetrahedron(3);
  for (std::size_t length = 1; length + 12 < whole.size(); ++length) {
    ASSERT_TRUE(write_file(folder / "m.meshb", whole.substr(0, length)));
    const auto mesh = read_medit(folder / "m.meshb");
    ASSERT_FALSE(mesh) << length;
    EXPECT_EQ(mesh.error().code, Code::bad_input);
  }
}

// With its sidecar the names come back; a program of others sees the references.
TEST(MeditBinary, IsTheSameMeshAsTheText) {
  const test::TemporaryFolder folder;
  const test::ThreeBodies made = test::three_different_bodies();
  MeshFormats formats;
  formats.add(own_formats());
  const MeshFormat& medit = **formats.of_file("m.meshb");
  const auto proof = write_mesh_file(medit, made.mesh, made.with_metric(), folder / "m.meshb");
  ASSERT_TRUE(proof) << proof.error().message;
  const Result<MeshContent> back = read_mesh_file(medit, folder / "m.meshb");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->mesh.bodies, made.mesh.bodies);
  EXPECT_EQ(back->mesh.groups, made.mesh.groups);
  EXPECT_EQ(back->mesh.points, made.mesh.points);
  EXPECT_EQ(back->metric.size(), made.metric.size());

  const std::string python = "/usr/bin/python3 ";
  if (test::output_of(folder.path(), python + "-c 'import meshio; print(1)'") != "1\n")
    GTEST_SKIP() << "meshio is not installed (python3-meshio): its reading of it is not tried";
  const std::string said = test::output_of(folder.path(), python + R"(-c '
import meshio, numpy
m = meshio.read("m.meshb")
for block, ref in zip(m.cells, m.cell_data["medit:ref"]):
    p = m.points[block.data]
    n = numpy.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    if block.type == "tetra":
        size = numpy.einsum("ij,ij->i", n, p[:, 3] - p[:, 0]) / 6
    else:
        size = numpy.linalg.norm(n, axis=1) / 2
    for r in sorted(set(ref)):
        print("%s %d = %.17g" % (block.type, r, size[ref == r].sum()))')");
  const test::Measures measures = test::measures_of(made.mesh);
  for (std::size_t b = 0; b < made.mesh.bodies.size(); ++b)
    EXPECT_NEAR(test::number_behind(said, "tetra " + std::to_string(b + 1) + " = ") /
                    measures.volumes.at(made.mesh.bodies[b]),
                1, 1e-9)
        << said;
  for (std::size_t g = 0; g < made.mesh.groups.size(); ++g)
    EXPECT_NEAR(test::number_behind(said, "triangle " + std::to_string(g + 1) + " = ") /
                    measures.areas.at(made.mesh.groups[g]),
                1, 1e-9);
}

}  // namespace
}  // namespace lamella
