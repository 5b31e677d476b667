#include "core/io_cgns/cgns.h"

#include "tests/support/foreign_program.h"
#include "tests/support/format_contract.h"
#include "tests/support/measures.h"

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

// CGNS is HDF5, whose own tool tells the numbers with all their digits.
TEST(Cgns, H5dumpShowsEverySectionWithItsAreaOrVolume) {
  LAMELLA_NEEDS_PROGRAM("h5dump");
  const test::TemporaryFolder folder;
  const test::ThreeBodies made = test::three_different_bodies();
  ASSERT_TRUE(write_mesh_file(cgns_format(), made.mesh, {}, folder / "m.cgns").ok());
  const auto numbers = [&](const std::string& path) {
    return test::numbers_behind(
        test::output_of(folder.path(),
                        "h5dump -m %.17g -y -w 0 -d '/Base/Zone/" + path + "/ data' m.cgns"),
        "DATA {", '}');
  };
  std::array<std::vector<double>, 3> x;
  for (int k = 0; k < 3; ++k) x[k] = numbers(std::string("GridCoordinates/Coordinate") + "XYZ"[k]);
  const auto node = [&](double id) {
    const auto n = static_cast<std::size_t>(id) - 1;
    return Vec<3>(x[0].at(n), x[1].at(n), x[2].at(n));
  };
  test::Measures seen;
  const test::Measures expected = test::measures_of(made.mesh, 1, '_');
  for (const auto& [name, area] : expected.areas) {
    const std::vector<double> ids = numbers(name + "/ElementConnectivity");
    for (std::size_t i = 0; i + 2 < ids.size(); i += 3)
      seen.add_triangle(name, node(ids[i]), node(ids[i + 1]), node(ids[i + 2]));
  }
  for (const auto& [name, volume] : expected.volumes) {
    const std::vector<double> ids = numbers(name + "/ElementConnectivity");
    for (std::size_t i = 0; i + 3 < ids.size(); i += 4)
      seen.add_tetrahedron(name, node(ids[i]), node(ids[i + 1]), node(ids[i + 2]),
                           node(ids[i + 3]));
  }
  expect_measures(seen, expected);
}

}  // namespace
}  // namespace lamella
