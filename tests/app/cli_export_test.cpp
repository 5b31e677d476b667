#include <cmath>

#include "core/io/mesh_file.h"
#include "tests/support/cli_fixture.h"
#include "tests/support/three_bodies.h"

namespace lamella {
namespace {

class CliExport : public Cli {
 protected:
  const test::ThreeBodies made = test::three_bodies_of_odd_names();

  void SetUp() override {
    MeshFormats formats;
    formats.add(own_formats());
    ASSERT_TRUE(
        write_mesh_file(**formats.called("msh"), made.mesh, made.with_metric(), folder / "in.msh")
            .ok());
  }
  MeshContent read(const std::string& format, const std::string& name) {
    MeshFormats formats;
    formats.add(own_formats());
    Result<MeshContent> content = read_mesh_file(**formats.called(format), folder / name);
    EXPECT_TRUE(content.ok()) << content.error().message;
    return content ? std::move(*content) : MeshContent{};
  }
};

// From one format to the next and back to the first: nothing is lost on the way.
TEST_F(CliExport, AChainOfFormatsKeepsNamesMeasuresMetricAndRatios) {
  std::string from = "in.msh";
  for (const std::string to :
       {"a.inp", "b.foam", "c.unv", "d.vtu", "e.bdf", "f.exo", "g.mesh", "h.msh2", "out.msh"}) {
    ASSERT_EQ(run("export " + from + " " + to + " --json"), 0) << to << err;
    EXPECT_EQ(lines().back()["phase"], "written");
    EXPECT_EQ(lines().back()["nodes"], made.mesh.node_count());
    from = to;
  }
  const MeshContent last = read("msh", "out.msh");
  const ExportCertificate proof =
      certify("out.msh", "Gmsh MSH 4.1", summarize(made.mesh), summarize(last.mesh));
  EXPECT_TRUE(proof.agrees) << proof.finding;
  ASSERT_EQ(last.metric.size(), made.metric.size());
  EXPECT_LE((last.metric[7] - made.metric[7]).norm(), 1e-9 * made.metric[7].norm());
  EXPECT_EQ(last.of_elements.size(), 3u);
}

TEST_F(CliExport, ACaseIsAFolderAndTellsItsOrthogonality) {
  ASSERT_EQ(run("export in.msh case --format openfoam"), 0) << err;
  EXPECT_NE((out + err).find("non-orthogonality: largest"), std::string::npos) << out << err;
  EXPECT_TRUE(std::filesystem::exists(folder / "case/constant/polyMesh/owner"));
  EXPECT_TRUE(std::filesystem::exists(folder / "case/case.foam"));
  ASSERT_EQ(run("export case back.vtu"), 0) << err;
  ASSERT_EQ(run("check case --json"), 0) << err;
  EXPECT_NEAR(lines().at(0)["volume"], 48, 1e-9);
}

TEST_F(CliExport, MetersAreToldAndReadBackAsMillimeters) {
  ASSERT_EQ(run("export in.msh m.inp --unit m"), 0) << err;
  const std::string text = read_file(folder / "m.inp").value();
  EXPECT_NE(text.find("lengths in m\n"), std::string::npos);
  EXPECT_EQ(json::parse(read_file(folder / "m.inp.json").value())["unit"], "m");
  ASSERT_EQ(run("check m.inp --json"), 0) << err;
  EXPECT_NEAR(lines().at(0)["volume"], 48, 1e-9);
}

TEST_F(CliExport, TheOriginOfAMeshGoesAlong) {
  write("box.stl", box_stl(12, 10, 1));
  const int status = run("mesh box.stl -n 2 --iterations 1 -o p.vtu");
  ASSERT_TRUE(status == 0 || status == 4) << err;
  ASSERT_EQ(run("export p.vtu p.unv"), 0) << err;
  const json sidecar = json::parse(read_file(folder / "p.unv.json").value());
  EXPECT_EQ(sidecar["bodies"][0]["layers"], 2);
  EXPECT_EQ(sidecar["inputs"][0]["path"], "box.stl");
  EXPECT_EQ(std::string(sidecar["inputs"][0]["sha256"]).size(), 64u);
  EXPECT_EQ(std::string(sidecar["program"]).substr(0, 8), "Lamella ");
}

TEST_F(CliExport, WhatCannotBeIsToldWithTheRightStatus) {
  EXPECT_EQ(run("export in.msh out.xyz"), 2);
  EXPECT_NE(err.find(".unv (I-deas universal)"), std::string::npos) << err;
  EXPECT_EQ(run("export in.msh out.msh --format nothing"), 2);
  EXPECT_EQ(run("export in.msh out.msh --unit mile"), 2);
  EXPECT_EQ(run("export missing.msh out.inp"), 3);
  EXPECT_EQ(run("export in.msh no/such/folder/out.inp"), 2);
  write("box.stl", box_stl(1, 1, 1));
  EXPECT_EQ(run("export box.stl out.inp"), 3);
  EXPECT_FALSE(std::filesystem::exists(folder / "out.inp"));
}

}  // namespace
}  // namespace lamella
