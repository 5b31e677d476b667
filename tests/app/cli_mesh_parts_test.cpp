#include <map>
#include <set>

#include "core/io/msh.h"
#include "core/mesh/validate.h"
#include "tests/support/cli_fixture.h"
#include "tests/support/three_bodies.h"

namespace lamella {
namespace {

class CliMeshParts : public Cli {
 protected:
  void SetUp() override {
    const test::ThreeBodies three;
    ASSERT_TRUE(write_msh(three.mesh, {}, folder / "three.msh").ok());
  }
};

TEST_F(CliMeshParts, AConformingMeshIsMeshedAnewWithItsInterfacesAndNames) {
  ASSERT_EQ(run("mesh three.msh --domain bodies -n 3 --iterations 2 -o new.msh") & ~4, 0) << err;
  const Result<MeshContent> read = read_msh(folder / "new.msh");
  ASSERT_TRUE(read.ok()) << read.error().message;
  const SimplexMesh<3>& mesh = read->mesh;
  EXPECT_EQ(mesh.bodies, (Names{"cover", "insert", "runner"}));
  EXPECT_TRUE(validate<3>(mesh).ok());
  std::map<std::int32_t, double> volume;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    volume[mesh.element_body[e]] += signed_measure<3>(mesh.corners(mesh.elements[e]));
  for (const auto& [body, v] : volume) EXPECT_NEAR(v, 16, 1e-6) << mesh.bodies.at(body);
  std::map<std::string, double> area;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    area[mesh.groups.at(mesh.facet_group[f])] +=
        facet_normal<3>(mesh.corners(mesh.facets[f])).norm() / 2;
  EXPECT_NEAR(area["gate"], 8, 1e-6);
  EXPECT_NEAR(area["vent"], 8, 1e-6);
  EXPECT_NEAR(area["symmetry"], 12, 1e-6);
  EXPECT_NEAR(area["cover|insert"], 8, 1e-6);
  EXPECT_NEAR(area["insert|runner"], 8, 1e-6);
}

TEST_F(CliMeshParts, InfoListsTheBodiesOfAMesh) {
  ASSERT_EQ(run("info three.msh --faces"), 0) << err;
  for (const char* text : {"body \"cover\"", "body \"runner\"", "gate", "symmetry"})
    EXPECT_NE(out.find(text), std::string::npos) << text << '\n' << out;
}

TEST_F(CliMeshParts, ADamagedMeshIsBadInput) {
  write("bad.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 ");
  EXPECT_EQ(run("mesh bad.msh -n 3 -o new.msh"), 3);
  EXPECT_EQ(run("info bad.msh"), 3);
}

}  // namespace
}  // namespace lamella
