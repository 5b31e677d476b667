#include "core/io_med/med.h"

#include "tests/support/foreign_program.h"
#include "tests/support/format_contract.h"

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

}  // namespace
}  // namespace lamella
