#include "core/io_cgns/cgns.h"

#include "tests/support/foreign_program.h"
#include "tests/support/format_contract.h"

namespace lamella {

namespace test {
INSTANTIATE_TEST_SUITE_P(Cgns, FormatContract, testing::Values(cgns_format()), format_name);
}

namespace {

TEST(Cgns, CgnscheckFindsNothingWrong) {
  LAMELLA_NEEDS_PROGRAM("cgnscheck");
  const test::TemporaryFolder folder;
  for (const test::ThreeBodies& made : {test::ThreeBodies(), test::three_bodies_of_odd_names()}) {
    ASSERT_TRUE(
        write_mesh_file(cgns_format(), made.mesh, made.with_metric(), folder / "m.cgns").ok());
    const std::string said = test::output_of(folder.path(), "cgnscheck -w3 m.cgns");
    EXPECT_NE(said.find("checking complete"), std::string::npos) << said;
    EXPECT_EQ(test::count_of(said, "ERROR"), 0) << said;
    // The standard has no names for a metric and for filling ratios.
    EXPECT_EQ(test::count_of(said, "WARNING"),
              test::count_of(said, "not a CGNS data-name identifier"))
        << said;
    EXPECT_EQ(test::count_of(said, "checking BC \""), 4) << said;
  }
}

}  // namespace
}  // namespace lamella
