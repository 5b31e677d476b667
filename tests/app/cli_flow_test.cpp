#include "core/io/medit.h"
#include "core/io/msh.h"
#include "core/metric/metric.h"
#include "tests/support/cli_fixture.h"
#include "tests/support/flow_meshes.h"
#include "tests/support/foreign_result.h"

namespace lamella {
namespace {

class CliFlow : public Cli {
 protected:
  SimplexMesh<3> mesh = test::channel<3>(3, 4, 1);

  void SetUp() override { ASSERT_TRUE(write_msh(mesh, {}, folder / "c.msh").ok()); }
};

TEST_F(CliFlow, TellsRatesThatBalanceAndWritesTheFields) {
  ASSERT_EQ(run("flow c.msh --gate gate=2 --vent vent --viscosity 0.5 -o f.vtu --json"), 0) << err;
  const auto told = lines();
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0]["phase"], "flow");
  EXPECT_LT(told[0]["imbalance"], 1e-6);
  const double in = told[0]["openings"][0]["rate"], through = told[0]["openings"][1]["rate"];
  EXPECT_LT(in, 0);
  EXPECT_NEAR(in + through, 0, 1e-6 * through);
  const std::string bytes = read_file(folder / "f.vtu").value();
  for (const std::string name : {"velocity", "pressure", "acceleration", "shear_rate",
                                 "direction_change", "residual", "residual_directional"})
    EXPECT_NE(bytes.find("Name=\"" + name + "\""), std::string::npos) << name;
  // Another format keeps what is known at the nodes.
  ASSERT_EQ(run("export f.vtu f.msh"), 0) << err;
  EXPECT_NE(read_file(folder / "f.msh").value().find("\"velocity\""), std::string::npos);

  // The rate asked for needs the pressure that gave it.
  ASSERT_EQ(run("flow c.msh --gate-rate gate=" + std::to_string(through) +
                " --vent vent --viscosity 0.5 --json"),
            0);
  EXPECT_NEAR(lines()[0]["openings"][0]["pressure"], 2, 1e-4);
  ASSERT_EQ(run("flow c.msh --gate gate --vent vent"), 0);
  EXPECT_NE(out.find("mass balance"), std::string::npos);
  EXPECT_NE(out.find("gate: pressure 1 MPa"), std::string::npos);
}

TEST_F(CliFlow, MoreMemoryThanAllowedIsToldBeforeTheWork) {
  EXPECT_EQ(run("flow c.msh --gate gate --vent vent -o f.vtu --memory 0.1 --json"), 6);
  EXPECT_NE(err.find("flow through " + std::to_string(mesh.node_count()) + " nodes: about"),
            std::string::npos)
      << err;
  EXPECT_NE(err.find("MB allowed"), std::string::npos) << err;
  EXPECT_EQ(out.find("\"flow\""), std::string::npos) << "nothing was solved";
  EXPECT_FALSE(std::filesystem::exists(folder / "f.vtu"));
  EXPECT_EQ(run("flow c.msh --gate gate --vent vent -o f.vtu --memory 500"), 0) << err;
}

TEST_F(CliFlow, EveryMethodWritesAMetricWithinItsBounds) {
  for (const std::string method :
       {"acceleration", "velocity", "strain", "combined", "direction", "residual", "directional"}) {
    ASSERT_EQ(run("flow c.msh --gate gate --vent vent --correct " + method +
                  " --h-min 0.05 --elements 3000 --correct-out " + method + ".sol --json"),
              0)
        << method << err;
    const auto told = lines();
    EXPECT_EQ(told[1]["phase"], "correction");
    EXPECT_LT(told[1]["elements_after"], 3000 * 1.02) << method;
    const auto metric = read_sol<3>(folder / (method + ".sol"), mesh.node_count());
    ASSERT_TRUE(metric.ok()) << method;
    for (std::size_t n = 1; n < metric->size(); ++n)
      EXPECT_GT(sizes<3>((*metric)[n])[0], 0.05 * (1 - 1e-6)) << method;
  }
  // The velocity varies across the channel, not along it.
  const auto metric = read_sol<3>(folder / "velocity.sol", mesh.node_count());
  std::size_t across = 0;
  for (std::size_t n = 1; n < metric->size(); ++n) {
    const Metric<3>& m = (*metric)[n];
    across += m(0, 0) < 0.9 * std::max(m(1, 1), m(2, 2));
  }
  EXPECT_GT(across, mesh.node_count() / 2);
}

TEST_F(CliFlow, AFieldOfTheFileCorrectsWithoutAGate) {
  ASSERT_EQ(run("flow c.msh --gate gate --vent vent -o f.vtu"), 0);
  ASSERT_EQ(run("flow f.vtu --correct field:pressure --correct-out p.sol"), 0) << err;
  const auto metric = read_sol<3>(folder / "p.sol", mesh.node_count());
  ASSERT_TRUE(metric.ok());
  // The pressure falls along x.
  for (std::size_t n = 1; n < metric->size(); ++n)
    EXPECT_GT(std::abs(spectrum<3>((*metric)[n]).vectors.col(2)[0]), 0.9);
  EXPECT_EQ(run("flow f.vtu --correct field:nothing --correct-out n.sol"), 2);
  EXPECT_NE(err.find("pressure"), std::string::npos) << err;
}

/// Of another solver on the channel.
void write_foreign(const std::filesystem::path& file, int cells, double unit) {
  test::ForeignBox box;
  box.cells = {3 * cells, cells, cells};
  box.high = {3, 1, 1};
  box.unit = unit;
  test::write_result(file, box);
}

TEST_F(CliFlow, AFieldOfAnotherMeshCorrectsThisOne) {
  write_foreign(folder / "solved.vtu", 5, 1e-3);
  const std::string field = "flow c.msh --field solved.vtu --field-unit m --correct ";
  const auto steepest = [&](const std::string& sol) {
    // The axis of the smallest size, most often.
    const auto metric = read_sol<3>(folder / sol, mesh.node_count());
    std::array<std::size_t, 3> axes{};
    for (std::size_t n = 1; metric.ok() && n < metric->size(); ++n) {
      Eigen::Index axis = 0;
      spectrum<3>((*metric)[n]).vectors.col(2).cwiseAbs().maxCoeff(&axis);
      ++axes[static_cast<std::size_t>(axis)];
    }
    return std::max_element(axes.begin(), axes.end()) - axes.begin();
  };
  ASSERT_EQ(run(field + "field:T --correct-out t.sol"), 0) << err;  // grows along x
  EXPECT_EQ(steepest("t.sol"), 0);
  ASSERT_EQ(run(field + "field:U --correct-out u.sol"), 0) << err;  // changes across y
  EXPECT_EQ(steepest("u.sol"), 1);
  for (const std::string method : {"acceleration:U", "strain:U", "direction:U", "indicator:T"})
    EXPECT_EQ(run(field + method + " --correct-out m.sol"), 0) << method << err;
}

TEST_F(CliFlow, AFieldThatDoesNotFitIsToldFrom) {
  write_foreign(folder / "solved.vtu", 3, 1e-3);
  const std::string out_to = " --correct-out n.sol";
  // Meters taken for millimeters.
  EXPECT_EQ(run("flow c.msh --field solved.vtu --correct field:T" + out_to), 3);
  EXPECT_NE(err.find("unit"), std::string::npos) << err;
  const std::string field = "flow c.msh --field solved.vtu --field-unit m --correct ";
  EXPECT_EQ(run(field + "field:p" + out_to), 2);
  EXPECT_NE(err.find("T, U"), std::string::npos) << err;
  EXPECT_EQ(run(field + "acceleration:T" + out_to), 2);  // a number is no velocity
  EXPECT_EQ(run(field + "indicator:U" + out_to), 2);
  EXPECT_EQ(run(field + "residual:U" + out_to), 2);
  EXPECT_EQ(run(field + "velocity" + out_to), 2);
  EXPECT_EQ(run("flow c.msh --field c.msh --correct field:T" + out_to), 2);
  EXPECT_EQ(run("flow c.msh --field none.vtu --correct field:T" + out_to), 3);
}

TEST_F(CliFlow, PlanarMeshesAndSymmetries) {
  auto plane = box_mesh<2>({8, 4}, Vec<2>(0, 0.5), Vec<2>(2, 1));
  test::name_channel<2>(plane, {2});
  ASSERT_TRUE(write_medit<2>(plane, folder / "p.mesh").ok());
  // Groups of a .mesh are known by their references, from 1.
  ASSERT_EQ(run("flow p.mesh --gate 'ref 2' --vent 'ref 3' --symmetry 'ref 4' -o p.vtu --json"), 0)
      << err;
  EXPECT_NEAR(lines()[0]["openings"][1]["rate"], 1.0 / 48, 2e-3);
}

TEST_F(CliFlow, ABodyOfAnAssemblyIsSolvedAlone) {
  auto two = two_body_box<3>(4);
  two.groups = {"walls", "gate", "vent"};
  for (std::size_t f = 0; f < two.facets.size(); ++f)
    two.facet_group[f] = two.facet_face[f] == 2 ? 1 : two.facet_face[f] == 3 ? 2 : 0;
  ASSERT_TRUE(write_msh(two, {}, folder / "two.msh").ok());
  ASSERT_EQ(run("flow two.msh --gate gate --vent vent --json"), 0) << err;
  const double both = lines()[0]["openings"][1]["rate"];
  ASSERT_EQ(run("flow two.msh --gate gate --vent vent --body '" + two.bodies[0] +
                "' --correct velocity --correct-out one.sol --json"),
            0)
      << err;
  EXPECT_LT(lines()[0]["openings"][1]["rate"], 0.5 * both);
  EXPECT_TRUE(read_sol<3>(folder / "one.sol", two.node_count()).ok());
  EXPECT_EQ(run("flow two.msh --gate gate --vent vent --body none"), 2);
}

TEST_F(CliFlow, WrongUsageIsStatus2) {
  for (const std::string arguments :
       {"flow c.msh", "flow c.msh --gate gate", "flow c.msh --gate gate --vent nowhere",
        "flow c.msh --gate gate=x --vent vent", "flow c.msh --gate-rate gate --vent vent",
        "flow c.msh --gate gate --vent vent -o f.msh",
        "flow c.msh --gate gate --vent vent --correct acceleration",
        "flow c.msh --gate gate --vent vent --correct magic --correct-out m.sol",
        "flow c.msh --gate gate --vent vent --strength 2",
        "flow c.msh --gate gate --vent vent --viscosity 0"})
    EXPECT_EQ(run(arguments), 2) << arguments;
  EXPECT_EQ(run("flow missing.msh --gate gate --vent vent"), 3);
  EXPECT_EQ(folder.names(), Names{"c.msh"});
}

}  // namespace
}  // namespace lamella
