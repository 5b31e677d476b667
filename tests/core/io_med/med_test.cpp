#include "core/io_med/med.h"

#include <sstream>

#include "tests/support/foreign_program.h"
#include "tests/support/format_contract.h"
#include "tests/support/measures.h"

namespace lamella {

namespace test {
INSTANTIATE_TEST_SUITE_P(Med, FormatContract, testing::Values(med_format()), format_name);
}

namespace {

class Med : public testing::Test {
 protected:
  const test::TemporaryFolder folder;
  const test::ThreeBodies made;

  void SetUp() override {
    ASSERT_TRUE(
        write_mesh_file(med_format(), made.mesh, made.with_metric(), folder / "m.med").ok());
  }
  std::string run(const std::string& command) { return test::output_of(folder.path(), command); }
};

TEST_F(Med, MedconformeFindsNothingWrong) {
  LAMELLA_NEEDS_PROGRAM("medconforme");
  const std::string said = run("medconforme m.med");
  EXPECT_NE(said.find("conforme au format HDF"), std::string::npos) << said;
  EXPECT_NE(said.find("conforme a la bibliothèque MED"), std::string::npos) << said;
  EXPECT_EQ(test::count_of(said, "n'est pas conforme") + test::count_of(said, "ERREUR"), 0) << said;
}

TEST_F(Med, MdumpShowsFamiliesGroupsAndFields) {
  LAMELLA_NEEDS_PROGRAM("mdump4");
  const std::string said = run("mdump4 m.med NODALE FULL_INTERLACE 0");
  for (const std::string text : {"cover|insert", "gate", "filling runner", "metric"})
    EXPECT_NE(said.find(text), std::string::npos) << text << '\n' << said;
}

// Coordinates of mdump4 have six decimals, as these have.
TEST(MedMeasures, MdumpShowsEveryNameWithItsAreaAndVolume) {
  LAMELLA_NEEDS_PROGRAM("mdump4");
  const test::TemporaryFolder folder;
  test::ThreeBodies made = test::three_different_bodies();
  for (Vec<3>& x : made.mesh.points)
    for (double& c : x) c = std::round(1e6 * c) / 1e6;
  ASSERT_TRUE(write_mesh_file(med_format(), made.mesh, {}, folder / "m.med").ok());
  const std::string said = test::output_of(folder.path(), "mdump4 m.med NODALE FULL_INTERLACE 0");
  // Lines "[ 7 ] : 1 2 3" behind a title, up to an empty line or the next title.
  const auto rows = [&](const std::string& title) {
    std::vector<std::vector<double>> all;
    std::istringstream text(said.substr(std::min(said.size(), said.find(title))));
    std::string line;
    std::getline(text, line);
    while (std::getline(text, line) && (line.find("] :") != line.npos || all.empty()))
      if (const auto at = line.find("] :"); at != line.npos)
        all.push_back(test::numbers_behind(line.substr(at), "] :", '\n'));
    return all;
  };
  std::map<int, std::string> names;
  for (auto at = said.find("et de numero "); at != said.npos;
       at = said.find("et de numero ", at + 1)) {
    const std::size_t name = said.find("gro = ", at), next = said.find("et de numero ", at + 1);
    if (name > next || name == said.npos) continue;
    std::string text = said.substr(name + 6, said.find('\n', name) - name - 6);
    text.erase(text.find_last_not_of(' ') + 1);
    names[static_cast<int>(test::number_behind(said.substr(at), "numero "))] = text;
  }
  const auto nodes = rows("- Coordonnees des noeuds");
  const auto node = [&](double id) {
    const auto& x = nodes.at(static_cast<std::size_t>(id) - 1);
    return Vec<3>(x.at(0), x.at(1), x.at(2));
  };
  test::Measures seen;
  for (const std::string type : {"MED_TRIA3", "MED_TETRA4"}) {
    const auto cells = rows("- Mailles de type " + type);
    const std::string behind = said.substr(said.find("- Mailles de type " + type));
    const std::size_t at = behind.find(" de familles :");
    const auto families = test::numbers_behind(behind.substr(at), ":", '(');
    ASSERT_GE(families.size(), cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const auto& v = cells[c];
      const std::string name = names[static_cast<int>(families[c])];
      if (v.size() == 3) seen.add_triangle(name, node(v[0]), node(v[1]), node(v[2]));
      // MED's tetrahedra are numbered the other way round.
      if (v.size() == 4) seen.add_tetrahedron(name, node(v[0]), node(v[2]), node(v[1]), node(v[3]));
    }
  }
  expect_measures(seen, test::measures_of(made.mesh));
}

}  // namespace
}  // namespace lamella
