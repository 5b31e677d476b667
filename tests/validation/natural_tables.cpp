// Regenerates table 4.1 of the thesis on real parts and compares the two detectors on parts made by
// code, inside resources/docs/validation.md, which holds the reading.

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <optional>

#include "core/base/atomic_file.h"
#include "core/cad/load_parts.h"
#include "core/cad/sample_parts.h"
#include "core/geometry/soup.h"
#include "core/geometry/triangles.h"
#include "core/mesh/sample_meshes.h"
#include "core/natural/layers.h"
#include "core/natural/natural_metric.h"
#include "core/natural/neighborhood.h"
#include "core/netgen/netgen_mesher.h"
#include "core/optimize/adapt.h"
#include "core/study/first_mesh.h"
#include "core/study/measure.h"
#include "core/study/svg_plot.h"
#include "tests/support/temporary_folder.h"
#include "tests/validation/page.h"

namespace lamella {
namespace {

namespace fs = std::filesystem;

constexpr int kLayers = 4;
constexpr int kRounds = 8;
/// A detector that drifts is followed up to here.
constexpr std::size_t kMostNodes = 60000;

std::string number(double v, int digits = 3) { return short_number(v, digits); }

NaturalParams natural_of(const Part& part) {
  NaturalParams params;
  params.layers = kLayers;
  params.h_min = 1e-3 * diagonal_of(part.surface.points);
  return params;
}

Result<SimplexMesh<3>> start_of(const Part& part) {
  Result<FirstMesh> first =
      first_mesh(part, {std::shared_ptr<const VolumeMesher>(topological_mesher()),
                        std::shared_ptr<const VolumeMesher>(netgen_mesher())});
  if (!first) return first.error();
  return std::move(first->mesh);
}

/// One round of the main loop, with its chord tolerance.
Result<SimplexMesh<3>> adapted(const SimplexMesh<3>& mesh, const MetricField<3>& metric,
                               const Part& part, const MetricFunction<3>& function) {
  AdaptParams params;
  params.chord_tolerance = 0.6e-3 * diagonal_of(part.surface.points);
  Result<Adapted<3>> next = adapt<3>(mesh, metric, &part.surface, params, {}, function);
  if (!next) return next.error();
  return std::move(next->mesh);
}

/// Processor time of all threads, s.
template <class Work>
double timed(Work&& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double quantile(std::vector<double> v, double p) {
  if (v.empty()) return 0;
  std::sort(v.begin(), v.end());
  return v[static_cast<std::size_t>(p * static_cast<double>(v.size() - 1))];
}

double mean(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x;
  return v.empty() ? 0 : sum / static_cast<double>(v.size());
}

std::string three(const std::vector<double>& v) {
  return number(quantile(v, 0.05), 2) + " / " + number(quantile(v, 0.5), 2) + " / " +
         number(quantile(v, 0.95), 2);
}

// ---- Table 4.1

/// One line: a detector on all meshes together.
struct Method {
  std::string name;
  std::optional<NeighborhoodParams> growth;  ///< unset: the geometric detector
  std::size_t failures = 0, bounded = 0, nodes = 0;
  std::vector<double> errors = {};
  double seconds = 0;
  long order = 0;
};

std::vector<Method> methods() {
  const auto neighborhood = [](const std::string& name, std::optional<Interpolation> method,
                               bool middles, PointWeights weights = PointWeights::area) {
    NeighborhoodParams growth;
    growth.interpolation = method;
    growth.edge_middles = middles;
    growth.weights = weights;
    return Method{.name = name, .growth = growth};
  };
  std::vector<Method> all;
  for (const bool middles : {false, true}) {
    const std::string with = middles ? ", edge middles" : "";
    all.push_back(neighborhood("M1" + with, Interpolation::m1, middles));
    all.push_back(neighborhood("M2" + with, Interpolation::m2, middles));
    if (middles) continue;  // they look at faces only
    all.push_back(neighborhood("M3", Interpolation::m3, middles));
    all.push_back(neighborhood("M4", Interpolation::m4, middles));
  }
  all.push_back(
      neighborhood("M2, uniform weights", Interpolation::m2, false, PointWeights::uniform));
  all.push_back(neighborhood("M2, M4, M1 in turn, edge middles", std::nullopt, true));
  all.push_back(Method{.name = "geometric detector", .growth = std::nullopt});
  return all;
}

Result<void> add(Method& method, const SimplexMesh<3>& mesh, const Part& part) {
  const NaturalParams params = natural_of(part);
  if (!method.growth) {
    std::optional<Error> error;
    method.seconds += timed([&] {
      const auto field = make_detector(Detector::geometric, part.surface)->field(mesh, params);
      if (!field) error = field.error();
    });
    method.nodes += mesh.node_count();
    if (error) return *error;
    return {};
  }
  std::optional<Result<NeighborhoodField<3>>> field;
  method.seconds += timed([&] { field = neighborhood_field<3>(mesh, params, *method.growth); });
  if (!*field) return field->error();
  const NeighborhoodField<3>& found = **field;
  method.failures += found.failures;
  method.bounded += found.bounded;
  method.nodes += mesh.node_count();
  for (std::size_t n = 1; n < mesh.points.size(); ++n) {
    method.order += found.order[n];
    if (found.order[n] > 0) method.errors.push_back(found.error[n]);
  }
  return {};
}

Result<void> table_4_1(const fs::path& cad, std::string& page) {
  std::vector<Method> all = methods();
  std::string parts_read;
  for (const char* name :
       {"prusa_mini_fsensor_cover.stp", "netgen_hinge_ascii.stl", "fan_duct_hotend_mount.step",
        "vhb_din_mount.step", "prusa_mini_display_box.stp"}) {
    const Result<std::vector<Part>> parts = load_parts(cad / name);
    if (!parts) {
      std::printf("%s is left out: %s\n", name, parts.error().message.c_str());
      continue;
    }
    for (const Part& part : *parts) {
      Result<SimplexMesh<3>> mesh = start_of(part);
      // One round of the default loop, so that walls have layers to be seen.
      const NaturalDetector detector(part.surface);
      if (mesh) {
        const auto field = detector.field(*mesh, natural_of(part));
        if (!field) return field.error();
        mesh = adapted(*mesh, field->metric, part, detector.function(natural_of(part)));
      }
      if (!mesh) {
        std::printf("%s is left out: %s\n", name, mesh.error().message.c_str());
        continue;
      }
      std::printf("%s: %zu nodes\n", name, mesh->node_count());
      parts_read +=
          (parts_read.empty() ? "" : ", ") + part.name + " (" + grouped(mesh->node_count()) + ")";
      for (Method& method : all) {
        if (const Result<void> done = add(method, *mesh, part); !done) return done;
        std::printf("  %s: %.1f s\n", method.name.c_str(), method.seconds);
        std::fflush(stdout);
      }
    }
  }
  if (parts_read.empty()) {
    std::printf("Table 4.1 stays as it is: no part could be read from %s.\n", cad.c_str());
    return {};
  }
  std::string table =
      "Nodes: " + parts_read +
      ".\n\n| interpolation | failures | mean error (4.63) | median | mean order | growth "
      "bounded | microseconds a node |\n|---|---|---|---|---|---|---|\n";
  for (const Method& m : all) {
    const auto nodes = static_cast<double>(m.nodes);
    const std::string time = number(1e6 * m.seconds / nodes) + " |\n";
    table += "| " + m.name + " | ";
    table += m.growth ? grouped(m.failures) + " | " + number(mean(m.errors)) + " | " +
                            number(quantile(m.errors, 0.5)) + " | " +
                            number(static_cast<double>(m.order) / nodes) + " | " +
                            grouped(m.bounded) + " | " + time
                      : "- | - | - | - | - | " + time;
  }
  return set_table(page, "4.1", table);
}

// ---- The two detectors in the loop

struct Shape {
  std::string name;
  Part part;
  std::optional<double> thickness;  ///< where it is the same everywhere
};

Result<std::vector<Shape>> shapes() {
  std::vector<Shape> all;
  for (const double t : {0.01, 0.02, 0.05}) {
    Shape shape;
    shape.name = "plate t/L = " + number(t);
    shape.part.name = "plate";
    shape.part.surface =
        boundary_surface(box_mesh<3>({2, 2, 1}, Vec<3>::Zero(), Vec<3>(1, 1, t)), 0);
    find_features(shape.part.surface, 0.5);
    shape.thickness = t;
    all.push_back(std::move(shape));
  }
  const test::TemporaryFolder folder;
  for (const char* name : {"l_profile", "t_junction", "wedge", "ribbed_tray"}) {
    const fs::path file = folder / (std::string(name) + ".step");
    if (const Result<void> written = write_sample(name, file); !written) return written.error();
    Result<std::vector<Part>> parts = load_parts(file);
    if (!parts) return parts.error();
    Shape shape{name, std::move(parts->at(0)), std::nullopt};
    if (shape.name == "l_profile") shape.thickness = 2;
    all.push_back(std::move(shape));
  }
  return all;
}

/// A round of the loop as a detector left it.
struct Round {
  std::size_t nodes = 0;
  std::vector<double> ratio;  ///< h1 n / t at the nodes
  LayerStats layers;
};

Result<std::vector<Round>> follow(const Shape& shape, Detector kind) {
  const NaturalParams params = natural_of(shape.part);
  const auto detector = make_detector(kind, shape.part.surface);
  const MetricFunction<3> function = detector->function(params);
  const NaturalDetector ruler(shape.part.surface);
  Result<SimplexMesh<3>> mesh = start_of(shape.part);
  if (!mesh) return mesh.error();
  std::vector<Round> rounds;
  for (int i = 0; i <= kRounds; ++i) {
    const auto field = detector->field(*mesh, params);
    if (!field) return field.error();
    Round round;
    round.nodes = mesh->node_count();
    const auto truth = ruler.field(*mesh, params);
    if (!truth) return truth.error();
    for (std::size_t n = 1; n < mesh->points.size(); ++n)
      round.ratio.push_back(sizes<3>(field->metric[n])[0] * kLayers /
                            shape.thickness.value_or(truth->thickness[n]));
    const auto layers = measure_layers(*mesh, shape.part.surface, kLayers);
    if (!layers) return layers.error();
    round.layers = layers->stats;
    rounds.push_back(std::move(round));
    std::printf("%s, %s, round %d: %zu nodes, h1 n/t %s, layers %.2f\n", shape.name.c_str(),
                std::string(detector_name(kind)).c_str(), i, mesh->node_count(),
                three(rounds.back().ratio).c_str(), rounds.back().layers.p50);
    std::fflush(stdout);
    if (i == kRounds || mesh->node_count() > kMostNodes) break;
    mesh = adapted(*mesh, field->metric, shape.part, function);
    if (!mesh) return mesh.error();
  }
  return rounds;
}

Result<void> compare(std::string& page) {
  Result<std::vector<Shape>> all = shapes();
  if (!all) return all.error();
  std::string table =
      "| part | detector | nodes, rounds 1 / 2 / 4 / last | h1 n/t, round 1: 5 / 50 / 95 % | last "
      "round | layers, median: round 1 | last round | rounds "
      "|\n|---|---|---|---|---|---|---|---|\n";
  for (const Shape& shape : *all)
    for (const Detector kind : {Detector::geometric, Detector::neighborhood}) {
      const Result<std::vector<Round>> rounds = follow(shape, kind);
      if (!rounds) return rounds.error();
      const Round& last = rounds->back();
      const auto& first = rounds->at(std::min<std::size_t>(1, rounds->size() - 1));
      std::string nodes;
      for (const std::size_t i : {1, 2, 4})
        nodes += i < rounds->size() ? grouped((*rounds)[i].nodes) + " / " : "- / ";
      table += "| " + shape.name + " | " + std::string(detector_name(kind)) + " | " + nodes +
               grouped(last.nodes) + " | " + three(first.ratio) + " | " + three(last.ratio) +
               " | " + number(first.layers.p50) + " | " + number(last.layers.p50) + " | " +
               std::to_string(rounds->size() - 1) + " |\n";
    }
  return set_table(page, "detectors", table);
}

// ---- Time against nodes

Result<void> times(std::string& page) {
  std::string table =
      "| mesh | nodes | neighborhood, microseconds a node | geometric |\n|---|---|---|---|\n";
  const auto add_line = [&](const std::string& name, const std::array<int, 3>& cells,
                            const Vec<3>& size) -> Result<void> {
    const SimplexMesh<3> mesh = box_mesh<3>(cells, Vec<3>::Zero(), size);
    Part part;
    part.surface = boundary_surface(box_mesh<3>({2, 2, 1}, Vec<3>::Zero(), size), 0);
    table += "| " + name + " | " + grouped(mesh.node_count());
    for (const Detector kind : {Detector::neighborhood, Detector::geometric}) {
      std::optional<Error> error;
      const double seconds = timed([&] {
        const auto field = make_detector(kind, part.surface)->field(mesh, natural_of(part));
        if (!field) error = field.error();
      });
      if (error) return *error;
      table += " | " + number(1e6 * seconds / static_cast<double>(mesh.node_count()));
    }
    table += " |\n";
    return {};
  };
  for (const int n : {20, 40, 80})
    if (const Result<void> done = add_line("plate of 4 layers", {n, n, 4}, Vec<3>(n, n, 1)); !done)
      return done;
  for (const int n : {8, 16, 32})
    if (const Result<void> done = add_line("cube", {n, n, n}, Vec<3>::Ones()); !done) return done;
  return set_table(page, "times", table);
}

Result<void> regenerate(const fs::path& docs, const std::optional<fs::path>& cad) {
  Result<std::string> page = read_file(docs / "validation.md");
  if (!page) return page.error();
  if (cad) {
    if (const Result<void> done = table_4_1(*cad, *page); !done) return done;
    // The other table takes longer: what is there is kept.
    if (const Result<void> done = write_file(docs / "validation.md", *page); !done) return done;
  } else {
    std::printf("Table 4.1 stays as it is: no folder of parts was given.\n");
  }
  if (const Result<void> done = times(*page); !done) return done;
  if (const Result<void> done = compare(*page); !done) return done;
  return write_file(docs / "validation.md", *page);
}

}  // namespace
}  // namespace lamella

int main(int argc, char** argv) {
  return lamella::write_tables(argc, argv, "lamella_natural_tables", lamella::regenerate);
}
