#include "core/io_vtk/vtk_formats.h"

#include "tests/support/foreign_program.h"
#include "tests/support/format_contract.h"

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

}  // namespace
}  // namespace lamella
