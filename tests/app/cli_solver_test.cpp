#include <cmath>

#include "core/io/msh.h"
#include "tests/support/cli_fixture.h"
#include "tests/support/foreign_result.h"

namespace lamella {
namespace {

/// A box of 12 x 10 x 1, and what another solver has found on it: a front at x = 4.
struct CliSolver : Cli {
  void SetUp() override {
    write("box.stl", box_stl(12, 10, 1));
    test::write_result(folder / "solved.vtu", front(1e-3));
  }
  static test::ForeignBox front(double unit) {
    test::ForeignBox box;
    box.cells = {60, 5, 2};
    box.high = {12, 10, 1};
    box.unit = unit;
    box.number = [](const Vec<3>& x) { return std::tanh((x[0] - 4) / 0.5); };
    box.speed = box.number;
    box.at_points = true;
    return box;
  }
  /// Elements of the last two iterations.
  std::pair<double, double> elements() const {
    std::pair<double, double> last{0, 0};
    for (const json& line : lines())
      if (line.value("phase", "") == "iteration") last = {last.second, line["elements"]};
    return last;
  }
  std::string study(const std::string& flow) const {
    return R"({"schema": 2, "name": "s", "inputs": ["box.stl"], "options": {"iterations": 1},
               "bodies": [{"name": "box", "layers": 2}], "flow": )" +
           flow + "}";
  }
};

TEST_F(CliSolver, AFieldCorrectsInTheLoop) {
  const std::string mesh =
      "mesh box.stl -n 2 --iterations 1 --flow-field solved.vtu --flow-field-unit m "
      "--flow-growth 2.5 -o m.vtu --json --flow ";
  for (const std::string method : {"field:T", "combined:U"}) {
    ASSERT_EQ(run(mesh + method), 4) << err;
    EXPECT_GT(elements().second, 1.4 * elements().first) << method;
  }
  std::string notes;
  for (const json& line : lines())
    if (line.value("phase", "") == "done") notes = line["bodies"][0]["notes"].dump();
  EXPECT_NE(notes.find("Corrected by the field"), std::string::npos) << notes;
  // The mesh carries the vector, by its name and what the correction evens out.
  const std::string bytes = read_file(folder / "m.vtu").value();
  EXPECT_NE(bytes.find("Name=\"field U\""), std::string::npos);
  EXPECT_NE(bytes.find("Name=\"flow_indicator\""), std::string::npos);
  EXPECT_EQ(bytes.find("Name=\"pressure\""), std::string::npos) << "nothing flowed";
  // The report names the file among its inputs.
  EXPECT_NE(read_file(folder / "m.report.json").value().find("solved.vtu"), std::string::npos);
}

TEST_F(CliSolver, AStudyHoldsTheFieldAndIsRunAgain) {
  write("s.json", study(R"({"method": "field", "growth": 2.5,
                            "field": {"file": "solved.vtu", "unit": 1000, "name": "T"}})"));
  ASSERT_EQ(run("run s.json --json"), 4) << err;
  EXPECT_GT(elements().second, 1.4 * elements().first);
  // What is finished is not run anew, with another result it is.
  ASSERT_EQ(run("run s.lamella --resume --json"), 4) << err;
  EXPECT_EQ(elements().second, 0);
  test::ForeignBox other = front(1e-3);
  other.number = [](const Vec<3>& x) { return std::tanh((x[0] - 9) / 0.5); };
  test::write_result(folder / "other.vtu", other);
  ASSERT_EQ(run("run s.lamella --resume --set flow.field.file=other.vtu --json"), 4) << err;
  EXPECT_GT(elements().second, 0);
  ASSERT_EQ(run("run s.lamella --resume --set flow.field.name=U --json"), 4) << err;
  EXPECT_GT(elements().second, 0);
  // A body that is left out keeps its natural mesh, which is refused: nothing would be corrected.
  EXPECT_EQ(run("run s.json --set body.flow=false"), 2);
}

TEST_F(CliSolver, AMissingResultEndsTheRunBeforeAnyMesh) {
  write("s.json", study(R"({"method": "field",
                            "field": {"file": "gone.vtu", "name": "T"}})"));
  EXPECT_EQ(run("run s.json --json"), 3);
  EXPECT_NE(err.find("gone.vtu\" is missing"), std::string::npos) << err;
  EXPECT_EQ(out.find("\"iteration\""), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "s.lamella"));
  // Without the correction the study runs; so does one that names a file that is there.
  EXPECT_EQ(run("mesh s.json --flow none -o m.msh"), 4) << err;
  EXPECT_EQ(run("mesh s.json --flow field:T --flow-field solved.vtu --flow-field-unit m -o m.msh"),
            4)
      << err;
}

TEST_F(CliSolver, ResultsOfManyProgramsAreRead) {
  const std::string mesh = "mesh box.stl -n 1 --iterations 1 -o m.msh --flow ";
  test::write_result(folder / "solved.vtk", front(1));
  EXPECT_EQ(run(mesh + "strain:U --flow-field solved.vtk"), 4) << err;
  test::ForeignBox cells = front(1);
  cells.at_points = false;
  test::write_result(folder / "cells.vtk", cells);
  EXPECT_EQ(run(mesh + "field:T --flow-field cells.vtk"), 4) << err;
  // A view of Gmsh: numbers at the nodes, and of the elements.
  const auto other = box_mesh<3>({12, 5, 1}, Vec<3>::Zero(), Vec<3>(12, 10, 1));
  MeshFields fields;
  fields.of_nodes = {{"p", 1, {}}};
  for (const Vec<3>& x : other.points) fields.of_nodes[0].values.push_back(std::tanh(x[0] - 4));
  fields.of_elements = {{"q", {}}};
  for (const auto& e : other.elements)
    fields.of_elements[0].values.push_back(other.points[e[0]][0]);
  ASSERT_TRUE(write_msh(other, fields, folder / "view.msh").ok());
  EXPECT_EQ(run(mesh + "field:p --flow-field view.msh"), 4) << err;
  EXPECT_EQ(run(mesh + "indicator:q --flow-field view.msh"), 4) << err;
}

TEST_F(CliSolver, WhatDoesNotFitIsToldWithAHint) {
  const std::string mesh = "mesh box.stl -n 1 --iterations 1 -o m.msh ";
  const auto refused = [&](int status, const std::string& options, const std::string& word) {
    EXPECT_EQ(run(mesh + options), status) << options << '\n' << err;
    EXPECT_NE(err.find(word), std::string::npos) << options << '\n' << err;
    EXPECT_GE(std::count(err.begin(), err.end(), '\n'), 2) << "a hint: " << err;
    EXPECT_FALSE(std::filesystem::exists(folder / "m.msh"));
  };
  refused(3, "--flow field:T --flow-field solved.vtu", "1000 times");  // meters
  test::ForeignBox shifted = front(1);
  shifted.low[0] += 8;
  shifted.high[0] += 8;
  test::write_result(folder / "shifted.vtu", shifted);
  refused(3, "--flow field:T --flow-field shifted.vtu", "shifted");
  test::ForeignBox holes = front(1);
  holes.number = [](const Vec<3>& x) { return x[0] > 11.9 ? std::nan("") : x[0]; };
  test::write_result(folder / "holes.vtu", holes);
  refused(3, "--flow field:T --flow-field holes.vtu", "no number at 18 of");
  write("list.pvtu", "<VTKFile type=\"PUnstructuredGrid\"/>");
  refused(3, "--flow field:T --flow-field list.pvtu", "list of files");
  write("image.vtk",
        "# vtk DataFile Version 2.0\nx\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\n"
        "ORIGIN 0 0 0\nSPACING 1 1 1\n");
  refused(3, "--flow field:T --flow-field image.vtk", "no unstructured grid");
  write("noise.vtk", "# vtk DataFile Version 2.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 9");
  refused(3, "--flow field:T --flow-field noise.vtk", "noise.vtk");
  const std::string field = " --flow-field solved.vtu --flow-field-unit m";
  refused(2, "--flow field:nothing" + field, "T, U");
  refused(2, "--flow strain:T" + field, "number");
  refused(2, "--flow indicator:U" + field, "vector");
  refused(2, "--flow residual:U" + field, "residual:U");
  refused(3, "--flow indicator:T" + field, "negative");
  refused(2, "--flow field:T", "--flow-field");
  refused(2, "--flow combined" + field, "field:NAME");
}

}  // namespace
}  // namespace lamella
