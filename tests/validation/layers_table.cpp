// Layers through the thickness, asked and measured back: the main loop on parts made by code and on
// real ones, as a table of resources/docs/validation.md, which holds the reading.

#include <cstdio>
#include <filesystem>
#include <optional>

#include "core/base/atomic_file.h"
#include "core/cad/load_parts.h"
#include "core/cad/sample_parts.h"
#include "core/netgen/netgen_mesher.h"
#include "core/study/run.h"
#include "core/study/svg_plot.h"
#include "tests/support/temporary_folder.h"
#include "tests/validation/page.h"

namespace lamella {
namespace {

namespace fs = std::filesystem;

constexpr int kIterations = 8;
constexpr int kAsked[] = {2, 4, 8};

struct Named {
  std::string name;
  fs::path file;
};

/// Those that are there; the others are told.
std::vector<Named> real_parts(const fs::path& folder) {
  std::vector<Named> found;
  for (const std::string name :
       {"prusa_mini_fsensor_cover.stp", "fan_duct_hotend_mount.step", "vhb_din_mount.step",
        "prusa_mini_display_box.stp", "prusa_mini_cable_cover_ascii.stl", "netgen_hinge_ascii.stl",
        "cpx_snapfit_case.stl", "shaker_top_cover_bad_normals.stl"}) {
    if (fs::exists(folder / name))
      found.push_back({name, folder / name});
    else
      std::fprintf(stderr, "%s is not in %s: left out.\n", name.c_str(), folder.string().c_str());
  }
  return found;
}

std::string percent(double share) { return short_number(100 * share, 2); }

/// One row, or the reason why there is none.
std::string row(const Named& named, const std::vector<Part>& parts, int n) {
  Study study;
  for (const Part& part : parts) {
    study.bodies.push_back({part.name});
    study.bodies.back().layers = n;
  }
  study.options.iterations = kIterations;
  const Result<Outcome> outcome = run(study, parts,
                                      {std::shared_ptr<const VolumeMesher>(topological_mesher()),
                                       std::shared_ptr<const VolumeMesher>(netgen_mesher())});
  std::string line = "| " + named.name + " | " + std::to_string(n) + " | ";
  if (!outcome) return line + outcome.error().message + " | | | | | | | | |\n";
  const std::vector<IterationRecord>& records = outcome->records;
  const IterationRecord& last = records.back();
  const auto change = [&](double a, double b) { return percent((b - a) / a); };
  const IterationRecord& before = records[records.size() - 2];
  line += std::to_string(last.iteration) + " | " + grouped(last.nodes) + " | " +
          change(static_cast<double>(before.nodes), static_cast<double>(last.nodes)) + " | " +
          change(before.layers.mean, last.layers.mean) + " | ";
  const LayerStats& layers = last.layers;
  std::size_t below = 0;
  for (const BodyOutcome& body : outcome->bodies) below += body.below.size();
  return line + short_number(layers.p5, 3) + " / " + short_number(layers.p50, 3) + " / " +
         short_number(layers.p95, 3) + " | " + percent(layers.share_reached) + " | " +
         grouped(below) + " | " + short_number(last.layers_by_nodes, 3) + " | " +
         short_number(last.quality_mean, 2) + " / " + short_number(last.quality_min, 2) + " | " +
         short_number(outcome->seconds, 2) + " |\n";
}

Result<void> regenerate(const fs::path& docs, const std::optional<fs::path>& cad) {
  std::vector<Named> parts;
  const test::TemporaryFolder folder;
  for (const std::string name : {"plate", "curved_shell", "wedge", "ribbed_tray", "t_junction",
                                 "l_profile", "cross_junction", "spiral_mold"}) {
    parts.push_back({name, folder / (name + ".step")});
    if (const Result<void> written = write_sample(name, parts.back().file); !written)
      return written;
  }
  if (cad)
    for (const Named& part : real_parts(*cad)) parts.push_back(part);

  std::string table =
      "| part | n | iterations | nodes | last change of nodes, % | of layers, % | layers measured, "
      "5 / 50 / 95 % | area with n or more, % | places below n | (B.2) | quality mean / worst | s "
      "|\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Named& part : parts) {
    Result<std::vector<Part>> bodies = load_parts(part.file);
    if (!bodies) {
      std::fprintf(stderr, "%s\n", bodies.error().message.c_str());
      continue;
    }
    for (const int n : kAsked) {
      const std::string line = row(part, *bodies, n);
      std::fprintf(stderr, "%s", line.c_str());
      table += line;
    }
  }
  Result<std::string> page = read_file(docs / "validation.md");
  if (!page) return page.error();
  if (const Result<void> set = set_table(*page, "layers", table); !set) return set;
  return write_file(docs / "validation.md", *page);
}

}  // namespace
}  // namespace lamella

int main(int argc, char** argv) {
  return lamella::write_tables(argc, argv, "lamella_layers_table", lamella::regenerate);
}
