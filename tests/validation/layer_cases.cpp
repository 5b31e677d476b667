// Layers case by case: the problems of figure 4.25, junctions of walls, nodes against isotropic
// meshes, and what further iterations change. Tables and pictures of resources/docs/validation.md,
// which holds the reading.

#include "tests/validation/layer_cases.h"

#include <cstdio>

#include "core/base/atomic_file.h"
#include "core/cad/load_parts.h"
#include "core/cad/sample_parts.h"
#include "core/geometry/triangles.h"
#include "core/mesh/quality.h"
#include "core/mesh/sample_meshes.h"
#include "core/natural/layers.h"
#include "core/natural/natural_metric.h"
#include "core/optimize/adapt.h"
#include "core/study/measure.h"
#include "core/study/request.h"
#include "core/study/svg_plot.h"
#include "tests/support/temporary_folder.h"
#include "tests/validation/page.h"

namespace lamella {
namespace {

namespace fs = std::filesystem;

constexpr double kMostElements = 3e6;  // larger isotropic meshes are forecast

std::string number(double v, int digits = 3) { return short_number(v, digits); }

std::string three(const LayerStats& s) {
  return number(s.p5) + " / " + number(s.p50) + " / " + number(s.p95);
}

Result<std::vector<Part>> sample(const std::string& name) {
  const test::TemporaryFolder folder;
  const fs::path file = folder / (name + ".step");
  if (const Result<void> written = write_sample(name, file); !written) return written.error();
  return load_parts(file);
}

/// A square plate 2 mm thick.
Part square_plate(double side) {
  return part_of(
      "plate L/t = " + short_number(side / 2),
      boundary_surface(box_mesh<3>({2, 2, 1}, Vec<3>::Zero(), Vec<3>(side, side, 2)), 0));
}

}  // namespace

Result<std::string> against_isotropic() {
  std::vector<std::pair<Part, double>> parts;  // with the largest length over its thickness
  parts.emplace_back(square_plate(100), 50);
  parts.emplace_back(square_plate(200), 100);
  for (const auto& [name, ratio] : {std::pair{"ribbed_tray", 40.0}, {"curved_shell", 36.0}}) {
    Result<std::vector<Part>> loaded = sample(name);
    if (!loaded) return loaded.error();
    parts.emplace_back(std::move(loaded->at(0)), ratio);
  }
  std::string table =
      "| part | L/t | nodes | layers, 5 / 50 / 95 % | isotropic: nodes | elements | layers | "
      "nodes, "
      "isotropic / ours |\n|---|---|---|---|---|---|---|---|\n";
  double nodes_an_element = 0, elements_of_forecast = 0;  // of the first part, for those forecast
  for (const auto& [part, ratio] : parts) {
    const Result<Outcome> ours = run_case({part}, 6, true);
    if (!ours) return ours.error();
    const SimplexMesh<3>& mesh = ours->state->mesh;
    const NaturalDetector detector(part.surface);
    Study study;
    study.bodies.push_back({part.name});
    const NaturalParams params = natural_params(study, part);
    // The same sizes across the walls, asked as the loop does, in every direction.
    const MetricFunction<3> even = [&](const Vec<3>& x) -> Metric<3> {
      const double h = sizes<3>(detector.at(x, params).metric)[0] / kAskedFiner;
      return isotropic_metric<3>(h);
    };
    MetricField<3> asked = ours->state->metric;
    for (Metric<3>& m : asked) m = isotropic_metric<3>(sizes<3>(m)[0] / kAskedFiner);
    const double forecast =
        allocation_factor<3>(mesh, asked) * static_cast<double>(mesh.element_count());
    std::string line = "| " + part.name + " | " + number(ratio) + " | " +
                       grouped(mesh.node_count()) + " | " + three(ours->records.back().layers) +
                       " | ";
    double nodes = 0;
    if (forecast * std::max(elements_of_forecast, 0.5) > kMostElements && nodes_an_element > 0) {
      const double elements = forecast * elements_of_forecast;
      nodes = elements * nodes_an_element;
      line += grouped(static_cast<std::size_t>(nodes)) + ", forecast | " +
              grouped(static_cast<std::size_t>(elements)) + ", forecast | - | ";
    } else {
      AdaptParams adapt_params;
      adapt_params.chord_tolerance = 0.6e-3 * diagonal_of(part.surface.points);
      const Result<Adapted<3>> isotropic =
          adapt<3>(mesh, {}, &part.surface, adapt_params, {}, even);
      if (!isotropic) return isotropic.error();
      const Result<Layers> layers = measure_layers(isotropic->mesh, part.surface, kCaseLayers);
      if (!layers) return layers.error();
      nodes = static_cast<double>(isotropic->mesh.node_count());
      const auto elements = static_cast<double>(isotropic->mesh.element_count());
      if (nodes_an_element == 0) {
        nodes_an_element = nodes / elements;
        elements_of_forecast = elements / forecast;
      }
      line += grouped(isotropic->mesh.node_count()) + " | " +
              grouped(isotropic->mesh.element_count()) + " | " + three(layers->stats) + " | ";
    }
    line += number(nodes / static_cast<double>(mesh.node_count())) + " |\n";
    std::fprintf(stderr, "%s", line.c_str());
    table += line;
  }
  return table;
}

Result<std::string> iterations_5_to_8(const std::optional<fs::path>& cad) {
  std::vector<std::pair<std::string, std::vector<Part>>> all;
  for (const std::string name : {"plate", "ribbed_tray", "curved_shell", "wedge", "spiral_mold"}) {
    Result<std::vector<Part>> parts = sample(name);
    if (!parts) return parts.error();
    all.emplace_back(name, std::move(*parts));
  }
  for (const std::string name :
       {"prusa_mini_fsensor_cover.stp", "vhb_din_mount.step", "prusa_mini_cable_cover_ascii.stl"}) {
    if (!cad || !fs::exists(*cad / name)) {
      std::fprintf(
          stderr, "%s is left out: %s.\n", name.c_str(),
          cad ? "the folder of the parts does not hold it" : "no folder of parts was given");
      continue;
    }
    Result<std::vector<Part>> parts = load_parts(*cad / name);
    if (!parts) {
      std::fprintf(stderr, "%s is left out: %s\n", name.c_str(), parts.error().message.c_str());
      continue;
    }
    all.emplace_back(name, std::move(*parts));
  }
  std::string table =
      "| part | nodes of iterations 1 / 2 / 3 / 5 / 8 | mean layers, 1 / 2 / 3 / 5 / 8 | change of "
      "nodes from 5 to 8, % | of mean layers, % |\n|---|---|---|---|---|\n";
  for (const auto& [name, parts] : all) {
    const Result<Outcome> outcome = run_case(parts, 8, false);
    if (!outcome) return outcome.error();
    const std::vector<IterationRecord>& r = outcome->records;
    if (r.size() != 9) return Error{Code::failed, name + " ended before iteration 8.", ""};
    std::string nodes, layers;
    for (const std::size_t i : {1, 2, 3, 5, 8}) {
      nodes += (i > 1 ? " / " : "") + grouped(r[i].nodes);
      layers += (i > 1 ? " / " : "") + number(r[i].layers.mean);
    }
    const auto change = [](double a, double b) { return number(100 * (b - a) / a, 2); };
    const std::string line =
        "| " + name + " | " + nodes + " | " + layers + " | " +
        change(static_cast<double>(r[5].nodes), static_cast<double>(r[8].nodes)) + " | " +
        change(r[5].layers.mean, r[8].layers.mean) + " |\n";
    std::fprintf(stderr, "%s", line.c_str());
    table += line;
  }
  return table;
}

namespace {

/// Writes one table after the other, so that what is there is kept.
Result<void> regenerate(const fs::path& docs, const std::optional<fs::path>& cad) {
  const fs::path page_file = docs / "validation.md", pictures = docs / "pictures" / "validation";
  const auto put = [&](const std::string& name, const Result<std::string>& table) -> Result<void> {
    if (!table) return table.error();
    Result<std::string> page = read_file(page_file);
    if (!page) return page.error();
    if (const Result<void> set = set_table(*page, name, *table); !set) return set;
    return write_file(page_file, *page);
  };
  if (const auto done = put("figure-4.25", figure_4_25(pictures)); !done) return done;
  const Result<JunctionTables> meeting = junctions(pictures);
  if (!meeting) return meeting.error();
  if (const auto done = put("arms", meeting->arms); !done) return done;
  if (const auto done = put("cores", meeting->cores); !done) return done;
  if (const auto done = put("isotropic", against_isotropic()); !done) return done;
  return put("iterations", iterations_5_to_8(cad));
}

}  // namespace
}  // namespace lamella

int main(int argc, char** argv) {
  return lamella::write_tables(argc, argv, "lamella_layer_cases", lamella::regenerate);
}
