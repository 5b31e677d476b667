#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>

#include "core/base/atomic_file.h"
#include "core/io/mesh_file.h"
#include "core/io/open_foam.h"
#include "core/mesh/fitness.h"
#include "core/mesh/sample_meshes.h"
#include "tests/support/foreign_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/three_bodies.h"

namespace lamella {
namespace {

/// Files of three bodies as other programs see them.
class ForeignReader : public testing::Test {
 protected:
  const test::TemporaryFolder folder;
  const test::ThreeBodies made;

  ExportCertificate write(const std::string& format, const std::string& name) {
    MeshFormats formats;
    formats.add(own_formats());
    const auto proof =
        write_mesh_file(**formats.called(format), made.mesh, made.with_metric(), folder / name);
    EXPECT_TRUE(proof.ok()) << proof.error().message;
    return proof ? *proof : ExportCertificate{};
  }
  std::string run(const std::string& command) { return test::output_of(folder.path(), command); }

  /// Physical groups of a file by what Gmsh makes of it: elements by (type, tag), the tag being the
  /// physical one or that of the entity, and its names with their dimension.
  struct GmshView {
    std::map<std::pair<int, int>, int> elements;
    std::map<std::string, int> names;
    std::string said;
  };
  GmshView gmsh(const std::string& name, bool entities = false) {
    GmshView view;
    const std::string all = entities ? " -save_all" : "";  // what has no physical group too
    view.said = run("gmsh " + name + all + " -save -format msh2 -o seen.msh -v 3");
    const Result<std::string> seen = read_file(folder / "seen.msh");
    if (!seen) return view;
    std::istringstream text(*seen);
    std::string line, section;
    while (std::getline(text, line)) {
      if (line[0] == '$') section = line;
      std::istringstream words(line);
      int a = 0, b = 0, tags = 0, physical = 0, entity = 0;
      if (section == "$PhysicalNames" && words >> a >> b)
        view.names[line.substr(line.find('"'))] = a;
      if (section == "$Elements" && words >> a >> b >> tags >> physical >> entity)
        ++view.elements[{b, entities ? entity : physical}];
    }
    return view;
  }
};

constexpr int kTriangle = 2, kTetrahedron = 4;

TEST_F(ForeignReader, GmshSeesBodiesGroupsAndFieldsOfBothMshVersions) {
  LAMELLA_NEEDS_PROGRAM("gmsh");
  for (const auto& [format, name] : {std::pair("msh", "m.msh"), std::pair("msh22", "m22.msh")}) {
    write(format, name);
    const GmshView view = gmsh(name);
    EXPECT_EQ(test::count_of(view.said, "Error") + test::count_of(view.said, "Warning"), 0)
        << view.said;
    for (std::size_t b = 0; b < 3; ++b)
      EXPECT_EQ(view.elements.at({kTetrahedron, static_cast<int>(b + 1)}), 144);
    EXPECT_EQ(view.elements.at({kTriangle, 5}), 24) << "gate";
    EXPECT_EQ(view.elements.at({kTriangle, 8}), 24) << "cover|insert";
    EXPECT_EQ(view.names.at("\"insert\""), 3);
    EXPECT_EQ(view.names.at("\"cover|insert\""), 2);
    ASSERT_TRUE(
        write_file(folder / "views.geo", std::string("Merge \"") + name + "\";\n" +
                                             "Printf(\"views %g\", PostProcessing.NbViews);")
            .ok());
    // The metric and three filling ratios.
    EXPECT_EQ(test::number_behind(run("gmsh -parse_and_exit views.geo"), "views "), 4);
  }
}

TEST_F(ForeignReader, GmshSeesTheGroupsOfUnv) {
  LAMELLA_NEEDS_PROGRAM("gmsh");
  write("unv", "m.unv");
  const GmshView view = gmsh("m.unv");
  EXPECT_EQ(test::count_of(view.said, "Error"), 0) << view.said;
  EXPECT_EQ(view.elements.at({kTetrahedron, 2}), 144);
  EXPECT_EQ(view.elements.at({kTriangle, 5}), 24);
  EXPECT_EQ(view.names.at("\"gate\""), 2);
  EXPECT_EQ(view.names.at("\"cover_insert\""), 2);
}

TEST_F(ForeignReader, GmshSeesThePropertiesOfNastran) {
  LAMELLA_NEEDS_PROGRAM("gmsh");
  write("nastran", "m.bdf");
  const GmshView view = gmsh("m.bdf", true);
  EXPECT_EQ(test::count_of(view.said, "Error"), 0) << view.said;
  for (int property = 1; property <= 3; ++property)
    EXPECT_EQ(view.elements.at({kTetrahedron, property}), 144);
  EXPECT_EQ(view.elements.at({kTriangle, 5}), 24);
}

TEST_F(ForeignReader, GmshSeesTheReferencesOfMedit) {
  LAMELLA_NEEDS_PROGRAM("gmsh");
  write("medit", "m.mesh");
  const GmshView view = gmsh("m.mesh", true);
  EXPECT_EQ(view.elements.at({kTetrahedron, 3}), 144);
  EXPECT_EQ(view.elements.at({kTriangle, 2}), 24);
}

void expect_patches(const std::string& said) {
  EXPECT_EQ(test::number_behind(said, "    walls "), 132) << said;
  EXPECT_EQ(test::number_behind(said, "    gate "), 24);
  EXPECT_EQ(test::number_behind(said, "    vent "), 24);
  EXPECT_EQ(test::number_behind(said, "    symmetry "), 36);
}

TEST_F(ForeignReader, CheckMeshFindsTheCaseSound) {
  LAMELLA_NEEDS_PROGRAM("checkMesh");
  const ExportCertificate proof = write("openfoam", "m.foam");
  const std::string said = run(test::open_foam("checkMesh -allTopology"));
  EXPECT_NE(said.find("Upper triangular ordering OK"), std::string::npos) << said;
  EXPECT_NE(said.find("Mesh OK."), std::string::npos) << said;
  EXPECT_NE(said.find("Number of regions: 1 (OK)"), std::string::npos);
  EXPECT_EQ(test::number_behind(said, "cell zones:"), 3);
  EXPECT_EQ(test::number_behind(said, "face zones:"), 2);
  EXPECT_NEAR(test::number_behind(said, "Total volume ="), 48e-9, 1e-14);
  expect_patches(said);
  // The export said the same before.
  ASSERT_EQ(proof.notes.size(), 1u);
  EXPECT_NEAR(test::number_behind(proof.notes[0], "largest "),
              test::number_behind(said, "non-orthogonality Max:"), 0.06);
  EXPECT_NEAR(test::number_behind(proof.notes[0], "mean "), test::number_behind(said, "average:"),
              0.06);
}

TEST_F(ForeignReader, OpenFoamIntegratesTheFillingRatios) {
  LAMELLA_NEEDS_PROGRAM("postProcess");
  write("openfoam", "m.foam");
  ASSERT_TRUE(write_file(folder / "system/filled",
                         "filled { type volFieldValue; libs (fieldFunctionObjects);\n"
                         "fields (alpha.insert); operation volIntegrate; regionType all;\n"
                         "writeFields false; log true; }\n")
                  .ok());
  const std::string said =
      run(test::open_foam("postProcess -funcs '(filled)' -fields '(alpha.insert)'"));
  double filled = 0;
  for (std::size_t e = 0; e < made.mesh.elements.size(); ++e)
    filled += made.fields.of_elements[1].values[e] *
              signed_measure<3>(made.mesh.corners(made.mesh.elements[e]));
  EXPECT_NEAR(test::number_behind(said, "of alpha.insert ="), 1e-9 * filled, 1e-13) << said;
}

TEST_F(ForeignReader, ThinTetrahedraAreToldBeforeTheSolverTells) {
  LAMELLA_NEEDS_PROGRAM("checkMesh");
  const SimplexMesh<3> thin = box_mesh<3>({4, 4, 4}, Vec<3>(0, 0, 0), Vec<3>(90, 90, 1));
  ASSERT_TRUE(write_open_foam(thin, {}, folder / "thin.foam").ok());
  const auto found = fitness(thin);
  const std::string said = run(test::open_foam("checkMesh"));
  EXPECT_GT(found->non_orthogonality, 80);
  EXPECT_NEAR(found->non_orthogonality, test::number_behind(said, "non-orthogonality Max:"), 1e-3)
      << said;
  EXPECT_NEAR(found->non_orthogonality_mean, test::number_behind(said, "average:"), 1e-3);
  EXPECT_EQ(found->beyond_70, static_cast<std::size_t>(test::number_behind(
                                  said, "severely non-orthogonal (> 70 degrees) faces:")));
  EXPECT_NEAR(std::max(found->skewness.max, found->boundary_skewness),
              test::number_behind(said, "Max skewness ="), 1e-4)
      << said;
}

TEST_F(ForeignReader, GmshToFoamReadsMsh22) {
  LAMELLA_NEEDS_PROGRAM("gmshToFoam");
  write("openfoam", "m.foam");  // for its system folder
  write("msh22", "m.msh2");
  const std::string said = run(test::open_foam("gmshToFoam m.msh2"));
  EXPECT_EQ(said.find("FATAL"), std::string::npos) << said;
  const std::string checked = run(test::open_foam("checkMesh -allTopology"));
  EXPECT_NE(checked.find("Mesh OK."), std::string::npos) << checked;
  EXPECT_EQ(test::number_behind(checked, "cell zones:"), 3);
  expect_patches(checked);
}

TEST_F(ForeignReader, IdeasUnvToFoamReadsGroupsAndUnits) {
  LAMELLA_NEEDS_PROGRAM("ideasUnvToFoam");
  write("openfoam", "m.foam");
  write("unv", "m.unv");
  const std::string said = run(test::open_foam("ideasUnvToFoam m.unv"));
  EXPECT_EQ(said.find("FATAL"), std::string::npos) << said;
  EXPECT_NE(said.find("insert is cellZone"), std::string::npos) << said;
  const std::string checked = run(test::open_foam("checkMesh -allTopology"));
  EXPECT_NE(checked.find("Mesh OK."), std::string::npos) << checked;
  EXPECT_NEAR(test::number_behind(checked, "Total volume ="), 48e-9, 1e-14) << "mm became m";
  expect_patches(checked);
}

// The resultant of a unit pressure on a flat gate is its area: the surface has all its faces, once,
// on the right sides, and the node set of the vent holds what it should.
TEST_F(ForeignReader, CalculixFeelsTheAreaOfTheGate) {
  LAMELLA_NEEDS_PROGRAM("ccx");
  write("abaqus", "m.inp");
  ASSERT_TRUE(write_file(folder / "deck.inp",
                         "*INCLUDE, INPUT=m.inp\n*MATERIAL, NAME=STEEL\n*ELASTIC\n1000., 0.3\n"
                         "*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL\n*STEP\n*STATIC\n"
                         "*BOUNDARY\nvent, 1, 3\n*DSLOAD\ngate, P, 1.\n"
                         "*NODE PRINT, NSET=vent, TOTALS=ONLY\nRF\n*END STEP\n")
                  .ok());
  const std::string said = run("ccx deck");
  EXPECT_EQ(said.find("*ERROR"), std::string::npos) << said;
  const Result<std::string> data = read_file(folder / "deck.dat");
  ASSERT_TRUE(data.ok()) << said;
  const std::size_t at = data->find('\n', data->find("total force"));
  double force[3] = {0, 0, 0};
  std::istringstream(data->substr(at)) >> force[0] >> force[1] >> force[2];
  EXPECT_NEAR(std::abs(force[0]), 8, 8e-6) << *data;
  EXPECT_NEAR(force[1], 0, 1e-6);
  EXPECT_NEAR(force[2], 0, 1e-6);
}

// Names that CalculiX could not read are replaced by some that it can.
TEST_F(ForeignReader, CalculixTakesEveryNameThatIsWritten) {
  LAMELLA_NEEDS_PROGRAM("ccx");
  const test::ThreeBodies odd = test::three_bodies_of_odd_names();
  MeshFormats formats;
  formats.add(own_formats());
  ASSERT_TRUE(write_mesh_file(**formats.called("abaqus"), odd.mesh, {}, folder / "m.inp").ok());
  std::string deck = "*INCLUDE, INPUT=m.inp\n*MATERIAL, NAME=STEEL\n*ELASTIC\n1000., 0.3\n";
  const std::string text = read_file(folder / "m.inp").value();
  std::vector<std::string> sets;
  for (auto at = text.find("*ELSET, ELSET="); at != std::string::npos;
       at = text.find("*ELSET, ELSET=", at + 1))
    sets.push_back(text.substr(at + 14, text.find('\n', at) - at - 14));
  ASSERT_EQ(sets.size(), 3u);
  for (const std::string& set : sets) deck += "*SOLID SECTION, ELSET=" + set + ", MATERIAL=STEEL\n";
  ASSERT_TRUE(write_file(folder / "deck.inp", deck + "*STEP\n*STATIC\n*END STEP\n").ok());
  const std::string said = run("ccx deck");
  EXPECT_EQ(said.find("*ERROR"), std::string::npos) << said;
}

}  // namespace
}  // namespace lamella
