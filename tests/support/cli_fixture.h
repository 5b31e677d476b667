#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/base/atomic_file.h"
#include "core/mesh/sample_meshes.h"
#include "tests/support/temporary_folder.h"

namespace lamella {

using Names = std::vector<std::string>;
using nlohmann::json;

/// The batch program run in a folder of its own, as a user would.
class Cli : public testing::Test {
 protected:
  test::TemporaryFolder folder;
  std::string out;  ///< standard output of the last run
  std::string err;  ///< standard error of the last run

  int run(const std::string& arguments) { return finish(start(arguments)); }
  FILE* start(const std::string& arguments) {
    const std::string command = "cd '" + folder.path().string() + "' && exec " + LAMELLA_BIN_DIR +
                                "/lamella-cli " + arguments + " 2>'" + errors_.string() + "'";
    // The first line is the process id, which exec keeps.
    return ::popen(("echo $$; " + command).c_str(), "r");
  }
  int finish(FILE* pipe) {
    out.clear();
    char buffer[4096];
    while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe)) out.append(buffer, n);
    const std::size_t line = out.find('\n');
    if (out.find_first_not_of("0123456789") == line) out.erase(0, line + 1);
    const int status = ::pclose(pipe);
    err = read_file(errors_).value();
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::vector<json> lines() const {
    std::vector<json> objects;
    for (std::size_t at = 0; at < out.size();) {
      const std::size_t end = std::min(out.find('\n', at), out.size());
      objects.push_back(json::parse(out.substr(at, end - at)));
      at = end + 1;
    }
    return objects;
  }
  void write(const std::string& name, const std::string& bytes) {
    ASSERT_TRUE(write_file(folder / name, bytes).ok());
  }
  /// A closed box as ASCII STL.
  static std::string box_stl(double x, double y, double z) {
    const SimplexMesh<3> mesh = box_mesh<3>({1, 1, 1}, Vec<3>::Zero(), Vec<3>(x, y, z));
    std::string text = "solid box\n";
    for (const auto& facet : mesh.facets) {
      text += "facet normal 0 0 0\nouter loop\n";
      for (const Vec<3>& p : mesh.corners(facet))
        text += "vertex " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " +
                std::to_string(p[2]) + "\n";
      text += "endloop\nendfacet\n";
    }
    return text + "endsolid box\n";
  }

 private:
  test::TemporaryFolder elsewhere_;
  std::filesystem::path errors_ = elsewhere_ / "errors";
};

}  // namespace lamella
