#include <gtest/gtest.h>

#include <array>
#include <cctype>
#include <sstream>

#include "core/base/atomic_file.h"
#include "core/io/mesh_file.h"
#include "core/io/open_foam.h"
#include "tests/support/foreign_program.h"
#include "tests/support/measures.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

using test::Measures;

/// Three bodies with gate, vent and symmetry, measured by other programs: every name stays with its
/// own area and volume.
class ForeignMeasures : public testing::Test {
 protected:
  const test::TemporaryFolder folder;
  const test::ThreeBodies made = test::three_different_bodies();

  void write(const std::string& format, const std::string& name) {
    MeshFormats formats;
    formats.add(own_formats());
    const auto proof =
        write_mesh_file(**formats.called(format), made.mesh, made.with_metric(), folder / name);
    ASSERT_TRUE(proof.ok()) << proof.error().message;
  }
  std::string run(const std::string& command) { return test::output_of(folder.path(), command); }

  /// What Gmsh sees; with `entities` by the tags "volume K" and "surface K", for formats without
  /// names.
  Measures by_gmsh(const std::string& name, bool entities = false) {
    const std::string all = entities ? " -save_all" : "";
    const std::string said = run("gmsh " + name + all + " -save -format msh2 -o seen.msh -v 2");
    EXPECT_EQ(test::count_of(said, "Error"), 0) << said;
    Measures seen;
    std::map<std::pair<int, int>, std::string> names;
    std::map<int, Vec<3>> nodes;
    std::istringstream text(read_file(folder / "seen.msh").value());
    std::string line, section;
    while (std::getline(text, line)) {
      std::istringstream words(line);
      int id = 0, type = 0, tags = 0, physical = 0, entity = 0;
      if (line[0] == '$') {
        section = line;
      } else if (section == "$PhysicalNames" && words >> type >> physical) {
        std::getline(words >> std::ws, names[{type, physical}]);
      } else if (section == "$Nodes") {
        Vec<3> x;
        if (words >> id >> x[0] >> x[1] >> x[2]) nodes[id] = x;
      } else if (section == "$Elements" && words >> id >> type >> tags >> physical >> entity) {
        for (int k = 2; k < tags; ++k) words >> id;
        std::array<int, 4> v{};
        for (int k = 0; k < (type == 4 ? 4 : 3); ++k) words >> v[k];
        const int dimension = type == 4 ? 3 : 2;
        const auto known = names.find({dimension, physical});
        const bool named = !entities && known != names.end();
        std::string of = named ? known->second
                         : dimension == 3
                             ? "volume " + std::to_string(entities ? entity : physical)
                             : "surface " + std::to_string(entities ? entity : physical);
        if (of.front() == '"') of = of.substr(1, of.size() - 2);
        if (type == 4) seen.add_tetrahedron(of, nodes[v[0]], nodes[v[1]], nodes[v[2]], nodes[v[3]]);
        if (type == 2) seen.add_triangle(of, nodes[v[0]], nodes[v[1]], nodes[v[2]]);
      }
    }
    return seen;
  }

  /// The measures of the mesh, under the numbers that bodies and groups have in a file from 1 on.
  Measures numbered(int first_group) const {
    Measures all = test::measures_of(made.mesh), by_number;
    for (std::size_t b = 0; b < made.mesh.bodies.size(); ++b)
      by_number.volumes["volume " + std::to_string(b + 1)] = all.volumes[made.mesh.bodies[b]];
    for (std::size_t g = 0; g < made.mesh.groups.size(); ++g)
      by_number.areas["surface " + std::to_string(first_group + static_cast<int>(g))] =
          all.areas[made.mesh.groups[g]];
    return by_number;
  }

  /// What OpenFOAM integrates over cell zones, patches and, of a case of ours, face zones.
  Measures by_open_foam(bool own_case) {
    const Measures made_of = test::measures_of(made.mesh, 1000, '_');
    std::string functions;
    const auto ask = [&](const char* type, const char* operation, const char* region,
                         const std::string& name, const char* field) {
      functions += "of_" + name + " { type " + type + "; libs (fieldFunctionObjects); fields (" +
                   field + "); operation " + operation + "; regionType " + region + "; name " +
                   name + "; writeFields false; log true; }\n";
    };
    for (const auto& [name, volume] : made_of.volumes)
      ask("volFieldValue", "volIntegrate", "cellZone", name, "one");
    // A field of cells has no value on faces between bodies, one of faces has.
    for (const auto& [name, area] : made_of.areas)
      if (name.find('_') == name.npos)
        ask("surfaceFieldValue", "areaIntegrate", "patch", name, "one");
      else if (own_case)
        ask("surfaceFieldValue", "areaIntegrate", "faceZone", name, "faceOne");
    const auto head = [](const char* type, const char* object) {
      return std::string("FoamFile { version 2.0; format ascii; class ") + type + "; object " +
             object + "; }\n";
    };
    std::filesystem::create_directories(folder / "0");
    EXPECT_TRUE(write_file(folder / "system/controlDict",
                           head("dictionary", "controlDict") +
                               "startFrom startTime; startTime 0; stopAt endTime; endTime 1; "
                               "deltaT 1; writeControl timeStep; writeInterval 1; "
                               "writePrecision 14;\nfunctions {\n" +
                               functions + "}\n"));
    const std::string symmetry =
        own_case ? "symmetry { type symmetry; value uniform 1; } " : std::string();
    const std::string uniform = "dimensions [0 0 0 0 0 0 0]; internalField uniform 1;\n";
    EXPECT_TRUE(write_file(folder / "0/one", head("volScalarField", "one") + uniform +
                                                 "boundaryField { " + symmetry +
                                                 "\".*\" { type zeroGradient; } }\n"));
    EXPECT_TRUE(write_file(folder / "0/faceOne",
                           head("surfaceScalarField", "faceOne") + uniform + "boundaryField { " +
                               symmetry + "\".*\" { type calculated; value uniform 1; } }\n"));
    const std::string said = run(test::open_foam("postProcess -fields '(one faceOne)'"));
    Measures seen;
    for (const auto& [name, volume] : made_of.volumes)
      seen.volumes[name] = test::number_behind(said, "volIntegrate(" + name + ") of one =");
    for (const auto& [name, area] : made_of.areas)
      if (name.find('_') == name.npos || own_case)
        seen.areas[name] =
            test::number_behind(said, "areaIntegrate(" + name + ") of " +
                                          (name.find('_') == name.npos ? "one =" : "faceOne ="));
    if (testing::Test::HasFailure()) ADD_FAILURE() << said;
    return seen;
  }
  Measures in_meters(bool own_case) const {
    Measures measures = test::measures_of(made.mesh, 1000, '_');
    if (!own_case)
      std::erase_if(measures.areas,
                    [](const auto& area) { return area.first.find('_') != std::string::npos; });
    return measures;
  }
};

TEST_F(ForeignMeasures, GmshOfMsh41) {
  LAMELLA_NEEDS_PROGRAM("gmsh");
  write("msh", "m.msh");
  expect_measures(by_gmsh("m.msh"), test::measures_of(made.mesh));
}

TEST_F(ForeignMeasures, GmshOfMsh22) {
  LAMELLA_NEEDS_PROGRAM("gmsh");
  write("msh22", "m22.msh");
  expect_measures(by_gmsh("m22.msh"), test::measures_of(made.mesh));
}

TEST_F(ForeignMeasures, GmshOfUnv) {
  LAMELLA_NEEDS_PROGRAM("gmsh");
  write("unv", "m.unv");
  // Gmsh numbers the groups of elements and names those of faces, whose triangles it lists twice.
  Measures seen = by_gmsh("m.unv"), expected = test::measures_of(made.mesh, 1, '_');
  std::erase_if(seen.areas, [](const auto& area) { return area.first.starts_with("surface "); });
  expected.volumes = numbered(4).volumes;
  expect_measures(seen, expected);
}

TEST_F(ForeignMeasures, GmshOfNastran) {
  LAMELLA_NEEDS_PROGRAM("gmsh");
  write("nastran", "m.bdf");
  expect_measures(by_gmsh("m.bdf", true), numbered(4));
}

TEST_F(ForeignMeasures, GmshOfMedit) {
  LAMELLA_NEEDS_PROGRAM("gmsh");
  write("medit", "m.mesh");
  expect_measures(by_gmsh("m.mesh", true), numbered(1));
}

TEST_F(ForeignMeasures, OpenFoamOfItsCase) {
  LAMELLA_NEEDS_PROGRAM("postProcess");
  write("openfoam", "m.foam");
  expect_measures(by_open_foam(true), in_meters(true));
}

TEST_F(ForeignMeasures, OpenFoamOfMsh22) {
  LAMELLA_NEEDS_PROGRAM("gmshToFoam");
  write("openfoam", "m.foam");  // for its system folder
  write("msh22", "m.msh2");
  EXPECT_EQ(run(test::open_foam("gmshToFoam m.msh2")).find("FATAL"), std::string::npos);
  // The file is in mm, and OpenFOAM takes its numbers for meters.
  Measures seen = by_open_foam(false);
  for (auto& [name, volume] : seen.volumes) volume *= 1e-9;
  for (auto& [name, area] : seen.areas) area *= 1e-6;
  expect_measures(seen, in_meters(false));
}

TEST_F(ForeignMeasures, OpenFoamOfUnv) {
  LAMELLA_NEEDS_PROGRAM("ideasUnvToFoam");
  write("openfoam", "m.foam");
  write("unv", "m.unv");
  EXPECT_EQ(run(test::open_foam("ideasUnvToFoam m.unv")).find("FATAL"), std::string::npos);
  expect_measures(by_open_foam(false), in_meters(false));
}

// The resultant of a unit pressure on a plane surface is its area, and ccx sums the volumes of
// element sets; it prints seven digits. Loads on nodes that are held would be lost, so these are
// others.
TEST_F(ForeignMeasures, CalculixOfAbaqus) {
  LAMELLA_NEEDS_PROGRAM("ccx");
  write("abaqus", "m.inp");
  std::string far_side = "*NSET, NSET=FAR\n";
  for (std::size_t v = 1; v < made.mesh.points.size(); ++v)
    if (made.mesh.points[v][1] > 4) far_side += std::to_string(v) + ",\n";
  Measures seen;
  for (const auto& [group, held] : std::map<std::string, std::string>{{"gate", "vent"},
                                                                      {"vent", "gate"},
                                                                      {"symmetry", "FAR"},
                                                                      {"cover_insert", "vent"},
                                                                      {"insert_runner", "gate"}}) {
    std::string deck = "*INCLUDE, INPUT=m.inp\n" + far_side +
                       "*MATERIAL, NAME=STEEL\n*ELASTIC\n1000., 0.3\n"
                       "*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL\n*STEP\n*STATIC\n*BOUNDARY\n" +
                       held + ", 1, 3\n*DSLOAD\n" + group + ", P, 1.\n*NODE PRINT, NSET=" + held +
                       ", TOTALS=ONLY\nRF\n";
    if (group == "gate")
      for (const std::string& body : made.mesh.bodies)
        deck += "*EL PRINT, ELSET=" + body + ", TOTALS=ONLY\nEVOL\n";
    ASSERT_TRUE(write_file(folder / "deck.inp", deck + "*END STEP\n"));
    const std::string said = run("ccx deck");
    EXPECT_EQ(said.find("*ERROR"), std::string::npos) << said;
    const std::string data = read_file(folder / "deck.dat").value();
    Vec<3> force = Vec<3>::Zero();
    std::istringstream(data.substr(data.find('\n', data.find("total force")))) >> force[0] >>
        force[1] >> force[2];
    seen.areas[group] = force.norm();
    if (group != "gate") continue;
    for (const std::string& body : made.mesh.bodies) {
      std::string set = body;
      for (char& c : set) c = static_cast<char>(std::toupper(c));
      const std::size_t at = data.find("total volume for set " + set);
      ASSERT_NE(at, std::string::npos) << data;
      seen.volumes[body] = std::strtod(data.c_str() + data.find('\n', at), nullptr);
    }
  }
  Measures expected = test::measures_of(made.mesh, 1, '_');
  expected.areas.erase("walls");  // is not plane
  expect_measures(seen, expected, 1e-6, 1e-6);
}

}  // namespace
}  // namespace lamella
