#include "core/io_vtk/vtk_formats.h"

#include "tests/support/foreign_program.h"
#include "tests/support/format_contract.h"
#include "tests/support/measures.h"

namespace lamella {

namespace test {
INSTANTIATE_TEST_SUITE_P(Vtk, FormatContract, testing::ValuesIn(vtk_formats()), format_name);
}

namespace {

TEST(Exodus, NcdumpShowsBlocksSideSetsAndVariables) {
  LAMELLA_NEEDS_PROGRAM("ncdump");
  const test::TemporaryFolder folder;
  const test::ThreeBodies made;
  MeshFormats formats;
  formats.add(vtk_formats());
  ASSERT_TRUE(
      write_mesh_file(**formats.called("exodus"), made.mesh, made.with_metric(), folder / "m.exo")
          .ok());
  const std::string said = test::output_of(
      folder.path(), "ncdump -v eb_names,ss_names,name_elem_var,name_nod_var m.exo");
  for (const std::string text :
       {"num_nodes = 140 ;", "num_elem = 432 ;", "num_el_blk = 3 ;", "num_side_sets = 6 ;",
        "num_side_ss2 = 24 ;", "num_el_in_blk3 = 144 ;", "\"cover\"", "\"gate\"",
        "\"insert|runner\"", "\"filling runner\"", "\"metric_xy\"",
        "connect1:elem_type = \"TETRA\""})
    EXPECT_NE(said.find(text), std::string::npos) << text << '\n' << said;
}

// Sides of a tetrahedron as Exodus numbers them from 1.
TEST(Exodus, NcdumpShowsEveryNameWithItsAreaOrVolume) {
  LAMELLA_NEEDS_PROGRAM("ncdump");
  const test::TemporaryFolder folder;
  const test::ThreeBodies made = test::three_different_bodies();
  MeshFormats formats;
  formats.add(vtk_formats());
  ASSERT_TRUE(write_mesh_file(**formats.called("exodus"), made.mesh, {}, folder / "m.exo").ok());
  const std::string said = test::output_of(folder.path(), "ncdump -p 9,17 m.exo");
  const std::string data = said.substr(said.find("data:"));
  const auto numbers = [&](const std::string& name) {
    return test::numbers_behind(data, "\n " + name + " =", ';');
  };
  const auto names = [&](const std::string& name) {
    std::vector<std::string> all;
    const std::size_t begin = data.find("\n " + name + " ="), end = data.find(';', begin);
    for (auto at = data.find('"', begin); at < end; at = data.find('"', at + 1)) {
      const std::size_t close = data.find('"', at + 1);
      all.push_back(data.substr(at + 1, close - at - 1));
      at = close;
    }
    return all;
  };
  const std::array<std::vector<double>, 3> x{numbers("coordx"), numbers("coordy"),
                                             numbers("coordz")};
  const auto node = [&](double id) {
    const auto n = static_cast<std::size_t>(id) - 1;
    return Vec<3>(x[0].at(n), x[1].at(n), x[2].at(n));
  };
  test::Measures seen;
  std::vector<double> elements;  // of all blocks, in their order
  const std::vector<std::string> blocks = names("eb_names"), sets = names("ss_names");
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const std::vector<double> ids = numbers("connect" + std::to_string(b + 1));
    elements.insert(elements.end(), ids.begin(), ids.end());
    for (std::size_t i = 0; i + 3 < ids.size(); i += 4)
      seen.add_tetrahedron(blocks[b], node(ids[i]), node(ids[i + 1]), node(ids[i + 2]),
                           node(ids[i + 3]));
  }
  constexpr int sides[4][3] = {{0, 1, 3}, {1, 2, 3}, {0, 2, 3}, {0, 1, 2}};
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const std::vector<double> of = numbers("elem_ss" + std::to_string(s + 1));
    const std::vector<double> side = numbers("side_ss" + std::to_string(s + 1));
    for (std::size_t i = 0; i < of.size(); ++i) {
      const auto first = 4 * (static_cast<std::size_t>(of[i]) - 1);
      const auto& v = sides[static_cast<int>(side.at(i)) - 1];
      seen.add_triangle(sets[s], node(elements.at(first + v[0])), node(elements.at(first + v[1])),
                        node(elements.at(first + v[2])));
    }
  }
  expect_measures(seen, test::measures_of(made.mesh));
}

}  // namespace
}  // namespace lamella
