#include <signal.h>

#include "core/io/msh.h"
#include "tests/support/cli_fixture.h"

namespace lamella {
namespace {

/// A box of 12 x 10 x 1 that is meshed in a moment.
struct CliRun : Cli {
  void SetUp() override {
    write("box.stl", box_stl(12, 10, 1));
    write("s.json", R"({"schema": 1, "name": "s", "inputs": ["box.stl"],
                        "options": {"iterations": 1}, "bodies": [{"name": "box", "layers": 2}]})");
  }
  std::vector<std::vector<std::string>> table(const std::string& name) {
    std::vector<std::vector<std::string>> rows(1, Names(1));
    const std::string text = read_file(folder / name).value();
    for (const char c : text) {
      if (c == '\n')
        rows.emplace_back(1);
      else if (c == ',')
        rows.back().emplace_back();
      else
        rows.back().back() += c;
    }
    rows.pop_back();
    return rows;
  }
  int count(const std::string& phase) const {
    int found = 0;
    for (const json& line : lines()) found += line.value("phase", "") == phase;
    return found;
  }
};

TEST_F(CliRun, AStudyBecomesAProjectThatIsRunAgain) {
  ASSERT_EQ(run("run s.json --json"), 4) << err;
  EXPECT_EQ(folder.names(), (Names{"box.stl", "s.json", "s.lamella"}));
  EXPECT_EQ(count("row"), 1);
  // What is finished is not run anew, unless something is asked that it is not.
  ASSERT_EQ(run("run s.lamella --resume --json"), 4) << err;
  EXPECT_EQ(count("iteration"), 0);
  EXPECT_EQ(lines().back()["status"], 4);
  EXPECT_EQ(run("run s.lamella --resume --min-quality 1 --json"), 5);
  EXPECT_EQ(count("iteration"), 0);
  ASSERT_EQ(run("run s.lamella --resume --set body.n=3 --json"), 4) << err;
  EXPECT_EQ(count("iteration"), 2);
  // The project has the changed settings now; its backup those before.
  ASSERT_EQ(run("run s.lamella --resume --json"), 4) << err;
  EXPECT_EQ(count("iteration"), 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "s.lamella.bak"));
  // Another part of the same name is told, and meshed anew.
  write("box.stl", box_stl(12, 10, 1.5));
  ASSERT_EQ(run("run s.lamella --resume --json"), 4) << err;
  EXPECT_EQ(count("note"), 1);
  EXPECT_EQ(count("iteration"), 2);
}

TEST_F(CliRun, MeshSaysTheSame) {
  ASSERT_EQ(run("run s.json -o a.msh"), 4) << err;
  ASSERT_EQ(run("mesh s.json -o b.msh -o b.lamella"), 4) << err;
  ASSERT_EQ(run("mesh b.lamella -o c.msh"), 4) << err;
  ASSERT_EQ(run("run s.json -o d.msh --threads 1"), 4) << err;
  const std::string mesh = read_file(folder / "a.msh").value();
  for (const char* other : {"b.msh", "c.msh", "d.msh"})
    EXPECT_EQ(read_file(folder / other).value(), mesh) << other;
}

TEST_F(CliRun, ASweepWritesATableAndAMeshEach) {
  const std::string sweep = "run s.json --set body.n=2,3 --set options.seed=1,7 -o n.msh ";
  // The combination of an array of jobs first.
  ASSERT_EQ(run(sweep + "--only 2 --json"), 4) << err;
  EXPECT_FALSE(std::filesystem::exists(folder / "n.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder / "n-2.msh"));
  ASSERT_EQ(run(sweep + "--resume --json"), 4) << err;
  EXPECT_EQ(count("iteration"), 2 * 3) << "the second was there";
  EXPECT_EQ(count("row"), 4);
  const auto rows = table("n.csv");
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0],
            (Names{"combination", "body.n", "options.seed", "nodes", "elements", "layers_mean",
                   "layers_p5", "quality_min", "seconds", "status", "file"}));
  for (int k = 1; k <= 4; ++k) {
    const Names& row = rows[static_cast<std::size_t>(k)];
    EXPECT_EQ(row[0], std::to_string(k));
    EXPECT_EQ(row[1], k <= 2 ? "2" : "3");
    EXPECT_EQ(row[2], k % 2 ? "1" : "7");
    EXPECT_EQ(row.back(), "n-" + std::to_string(k) + ".msh");
    const Result<MeshContent> mesh = read_msh(folder / row.back());
    ASSERT_TRUE(mesh);
    EXPECT_EQ(row[3], std::to_string(mesh->mesh.node_count()));
    EXPECT_EQ(row[4], std::to_string(mesh->mesh.element_count()));
  }
  EXPECT_GT(std::stod(rows[3][5]), 1.3 * std::stod(rows[1][5])) << "layers follow n";
  // What is missing is made again, and nothing else.
  const std::string table_before = read_file(folder / "n.csv").value();
  std::filesystem::remove(folder / "n-3.msh");
  ASSERT_EQ(run(sweep + "--resume --json"), 4) << err;
  EXPECT_EQ(count("iteration"), 2);
  EXPECT_EQ(table("n.csv")[1], rows[1]);
  EXPECT_TRUE(std::filesystem::exists(folder / "n-3.msh"));
}

TEST_F(CliRun, ACombinationThatFailsLeavesTheOthers) {
  ASSERT_EQ(run("run s.json --set options.memory=0.001,4000 -o m.msh"), 6) << err;
  const auto rows = table("m.csv");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[1][8], "6") << read_file(folder / "m.csv").value();
  EXPECT_EQ(rows[2][8], "4");
  EXPECT_FALSE(std::filesystem::exists(folder / "m-1.msh"));
  EXPECT_TRUE(std::filesystem::exists(folder / "m-2.msh"));
}

TEST_F(CliRun, WrongSettingsAreToldBeforeAnythingIsMeshed) {
  write("newer.json", R"({"schema": 3})");
  write("broken.lamella", "PK\x03\x04 and no more");
  for (const auto& [arguments, status, finding] :
       std::vector<std::tuple<std::string, int, std::string>>{
           {"run", 2, "STUDY"},
           {"run box.stl", 2, "no study"},
           {"run s.json --set body.n", 2, "PATH=VALUE"},
           {"run s.json --set body.n=2,,3", 2, "a value is empty"},
           {"run s.json --set body.n=0", 2, "bodies[0].layers"},
           {"run s.json --set body.n=2,x", 2, "bodies[0].layers"},
           {"run s.json --set body.layer=2", 2, "bodies[0].layer"},
           {"run s.json --set bodies.lid.layers=2", 2, "\"box\""},
           {"run s.json --set options.speed=2", 2, "options.speed"},
           {"run s.json --set inputs.0=a.stl", 2, "no setting"},
           {"run s.json --set name.of=a", 2, "nothing called"},
           {"run s.json --set body.n=2,3 --only 3", 2, "2 combinations"},
           {"run s.json -o no/such/s.lamella", 2, "folder does not exist"},
           {"run s.json -o s.xyz", 2, ""},
           {"run none.lamella", 3, "no such file"},
           {"run newer.json", 3, "newer"},
           {"run broken.lamella", 3, "too early"},
           {"mesh broken.lamella -o a.msh", 3, "too early"}}) {
    EXPECT_EQ(run(arguments), status) << arguments << err;
    EXPECT_NE((out + err).find(finding), std::string::npos) << arguments << ": " << err;
  }
  EXPECT_EQ(folder.names(), (Names{"box.stl", "broken.lamella", "newer.json", "s.json"}));
}

TEST_F(CliRun, TheManualNamesEverySubcommandAndOption) {
  ASSERT_EQ(run("manual"), 0) << err;
  const std::string page = out;
  EXPECT_TRUE(page.starts_with(".TH LAMELLA\\-CLI 1 "));
  ASSERT_EQ(run("--help"), 0);
  const std::string help = out.substr(out.find("Subcommands:"));
  int options = 0;
  for (std::size_t at = 0; (at = help.find("\n  ", at + 1)) != std::string::npos;) {
    const std::string name = help.substr(at + 3, help.find(' ', at + 3) - at - 3);
    if (name.empty() || name.find_first_not_of("abcdefghijklmnopqrstuvwxyz") != name.npos) continue;
    const std::size_t section = page.find("\n.SS " + name + "\n");
    ASSERT_NE(section, std::string::npos) << name;
    const std::string of_name = page.substr(section, page.find("\n.S", section + 5) - section);
    ASSERT_EQ(run(name + " --help"), 0);
    for (std::size_t dash = 0; (dash = out.find("--", dash)) != std::string::npos; dash += 2) {
      // Options stand at the start of a line; further ones belong to descriptions.
      const std::size_t line = out.rfind('\n', dash) + 1;
      if (out.compare(line, 3, "  -") != 0 || out.compare(dash, 6, "--help") == 0) continue;
      std::string option = out.substr(dash, out.find_first_of(" ,\n[", dash) - dash);
      std::string as_roff;
      for (const char c : option) as_roff += c == '-' ? std::string("\\-") : std::string(1, c);
      EXPECT_NE(of_name.find("\\fB" + as_roff + "\\fR"), std::string::npos) << name << option;
      ++options;
      if (out.find('\n', dash) == std::string::npos) break;
      dash = out.find('\n', dash) - 2;
    }
  }
  EXPECT_GT(options, 100);
}

TEST_F(CliRun, BashCompletesFromTheOptionsThemselves) {
  ASSERT_EQ(run("completion bash"), 0) << err;
  write("c.sh", out);
  const auto words = [&](const std::string& line) {
    write("ask.sh", "source c.sh\nCOMP_WORDS=(" + line +
                        ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_lamella_cli\n"
                        "echo \"${COMPREPLY[@]}\"\n");
    FILE* pipe = ::popen(("cd '" + folder.path().string() + "' && bash ask.sh").c_str(), "r");
    return finish(pipe) == 0 ? out.substr(0, out.find('\n')) : std::string("failed");
  };
  EXPECT_EQ(words("lamella-cli ge"), "generate");
  EXPECT_EQ(words("lamella-cli mesh --iter"), "--iterations");
  EXPECT_EQ(words("lamella-cli run --res"), "--resume");
  EXPECT_EQ(words("lamella-cli mesh --unit i"), "inch");
  EXPECT_EQ(words("lamella-cli completion ''"), "bash");
  EXPECT_EQ(words("lamella-cli run s.js"), "") << "files are completed by bash itself";
  EXPECT_EQ(run("completion fish"), 2);
}

}  // namespace
}  // namespace lamella
