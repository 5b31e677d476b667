#include <algorithm>
#include <cstdio>

#include "app/cli_commands.h"
#include "app/cli_common.h"
#include "core/cad/load_parts.h"
#include "core/cad/sample_parts.h"
#include "core/mesh/fitness.h"
#include "core/natural/layers.h"
#include "core/study/measure.h"
#include "core/study/study_file.h"

namespace lamella::cli {

namespace {

namespace fs = std::filesystem;
void say_stats(Console& console, const char* name, const Stats& s) {
  char line[200];
  std::snprintf(line, sizeof line, "  %-26s %10.6g %10.6g %10.6g %10.6g %10.6g", name, s.min, s.p5,
                s.p50, s.mean, s.max);
  console.say(line);
}

void say_check(Console& console, const CheckReport& r, bool with_metric) {
  const MeshReport& m = r.mesh;
  console.say(std::to_string(r.dimension) + "D mesh: " + grouped(m.nodes) + " nodes, " +
              grouped(m.elements) + " elements, " + grouped(m.faces_boundary) + " boundary faces");
  console.say(m.valid() ? "valid: no inverted element, every face in one or two elements"
                        : "not valid: " + m.first_finding);
  console.say("volume " + short_number(m.volume, 10) + ", by its boundary " +
              short_number(m.volume_boundary, 10) + "; boundary " +
              short_number(m.boundary_area, 8));
  console.say(
      "                                    min         5 %     median       mean        max");
  if (with_metric) {
    say_stats(console, "edge length in the metric", r.edge_length);
    say_stats(console, "mean ratio", r.mean_ratio);
    say_stats(console, "shape (3.1)", r.shape);
    say_stats(console, "quality c(T) (3.7)", r.quality);
    say_stats(console, "conformity (1.32)", r.conformity);
    say_stats(console, "conformity, invariant", r.conformity_invariant);
  }
  say_stats(console, "aspect ratio, Euclidean", r.aspect_ratio);
  if (with_metric)
    console.say("unit edges " + short_number(100 * r.unit_edges, 5) + " %, allocation (1.34) " +
                short_number(r.allocation, 5));
}

/// What solvers will say of the mesh, whatever its metric.
int check_solvers(const SimplexMesh<3>& mesh, const Progress& progress, Console& console) {
  const Result<Fitness> found = fitness(mesh, progress);
  if (!found) return console.fail(found.error());
  Json json = {{"phase", "solvers"}, {"criteria", Json::array()}};
  console.say(
      "what solvers ask                                                          here              "
      "  asked");
  for (const FitnessLine& line : fitness_lines(*found, mesh.bodies.size(), {})) {
    char text[240];
    std::snprintf(text, sizeof text, "  %-15s %-48s %-19s %s", line.solver.c_str(),
                  line.criterion.c_str(), line.value.c_str(), line.bound.c_str());
    console.say(std::string(text) + (line.holds ? "" : "  not held. " + line.advice));
    json["criteria"].push_back({{"solver", line.solver},
                                {"criterion", line.criterion},
                                {"value", line.value},
                                {"bound", line.bound},
                                {"holds", line.holds}});
  }
  console.emit(dump(json));
  return 0;
}

/// Layers of each body between the walls of the mesh itself.
int check_layers(const SimplexMesh<3>& mesh, int asked, const Progress& progress,
                 Console& console) {
  bool reached = true;
  for (std::size_t b = 0; b < mesh.bodies.size(); ++b) {
    const auto body = static_cast<std::int32_t>(b);
    Result<Layers> layers =
        measure_layers(extract_body(mesh, body), boundary_surface(mesh, body), asked, 0, progress);
    if (!layers) return console.fail(layers.error());
    const LayerStats& s = layers->stats;
    char line[200];
    std::snprintf(
        line, sizeof line,
        ": layers mean %.3f, 5 %% %.3f, median %.3f, at least %d at %.1f %% of %zu places", s.mean,
        s.p5, s.p50, asked, 100 * s.share_reached, s.places);
    console.say(s.places ? mesh.bodies[b] + line : mesh.bodies[b] + ": no thin wall found");
    console.emit(dump({{"phase", "layers"},
                       {"body", mesh.bodies[b]},
                       {"asked", asked},
                       {"mean", s.mean},
                       {"p5", s.p5},
                       {"median", s.p50},
                       {"share_reached", s.share_reached},
                       {"places", s.places}}));
    reached = reached && (s.places == 0 || (s.mean >= asked && s.p5 >= 0.9 * asked));
  }
  if (reached) return 0;
  return console.fail({Code::not_converged,
                       "The layers asked are not reached: mean " + std::string("below n, or 5 % ") +
                           "quantile below 0.9 n.",
                       "Mesh again with more iterations."});
}

template <int D>
int check_mesh(const SimplexMesh<D>& mesh, MetricField<D> metric, const CheckCommand& c,
               Console& console) {
  const Progress progress = console.progress();
  if (!c.sol.empty() || !c.metric.empty()) {
    Result<MetricField<D>> asked = metric_of<D>(mesh, c.sol, c.metric, nullptr);
    if (!asked) return console.fail(asked.error());
    metric = std::move(*asked);
  }
  const bool with_metric = !metric.empty();
  if (!with_metric) metric.assign(mesh.points.size(), Metric<D>::Identity());
  if (c.min_quality && !with_metric)
    return console.fail({Code::usage, "--min-quality needs a metric, and the file has none.",
                         "Give --sol or --metric."});
  if (c.layers && D != 3)
    return console.fail({Code::usage, "--layers needs a mesh of tetrahedra.", ""});
  Result<CheckReport> report = check<D>(mesh, metric, progress.portion(0, 0.7));
  if (!report) return console.fail(report.error());
  say_check(console, *report, with_metric);
  console.emit(dump(report_json(*report, with_metric)));
  if constexpr (D == 3)
    if (const int status = check_solvers(mesh, progress.portion(0.7, 0.75), console)) return status;
  if (!report->mesh.valid())
    return console.fail({Code::bad_input, "\"" + c.mesh + "\": " + report->mesh.first_finding, ""});
  if constexpr (D == 3)
    if (c.layers)
      if (const int status = check_layers(mesh, *c.layers, progress.portion(0.75, 1), console))
        return status;
  if (c.min_quality && report->quality.min < *c.min_quality)
    return console.fail({Code::poor_quality,
                         "The worst element has quality " + short_number(report->quality.min, 4) +
                             ", below " + short_number(*c.min_quality, 4) + ".",
                         ""});
  return 0;
}

/// "t-junction" and "tray" find "t_junction" and "ribbed_tray".
std::string sample_called(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  std::vector<std::string> found;
  for (const std::string& known : sample_names()) {
    if (known == name) return known;
    if (known.find(name) != std::string::npos) found.push_back(known);
  }
  return found.size() == 1 ? found.front() : name;
}

}  // namespace

int run_check(const CheckCommand& c, Console& console) {
  MetricField<3> own;
  Result<AnyMesh> mesh = read_any(c.mesh, &own, console.progress().portion(0, 0));
  if (!mesh) return console.fail(of_input(mesh.error()));
  if (const auto* solid = std::get_if<SimplexMesh<3>>(&*mesh))
    return check_mesh<3>(*solid, std::move(own), c, console);
  return std::visit(
      [&]<int D>(const SimplexMesh<D>& other) { return check_mesh<D>(other, {}, c, console); },
      *mesh);
}

int run_export(const ExportCommand& c, Console& console) {
  ExportOptions options{c.format, c.unit == "m" ? LengthUnit::m : LengthUnit::mm};
  const Result<ExportCertificate> proof =
      convert_mesh(c.mesh, c.output, options, console.progress());
  if (!proof) return console.fail(proof.error());
  tell_written(c.output, *proof, console);
  return 0;
}

int run_sample(const SampleCommand& c, Console& console) {
  const std::string name = sample_called(c.name);
  const std::string output = c.output.empty() ? name + ".step" : c.output;
  if (Result<void> done = write_sample(name, output); !done) return console.fail(done.error());
  console.say("wrote " + output);

  // The study beside it names every body, ready to be edited and meshed.
  Result<std::vector<Part>> parts = load_parts(output, {}, console.progress());
  if (!parts) return console.fail(parts.error());
  Study study;
  study.name = name;
  study.inputs = {{fs::path(output).filename().string()}};
  for (const Part& part : *parts) {
    BodySettings body;
    body.name = part.name;
    study.bodies.push_back(body);
  }
  const fs::path file = fs::path(output).replace_extension(".study.json");
  if (Result<void> done = write_study(study, file); !done) return console.fail(done.error());
  console.say("wrote " + file.string() + ", a study of it: lamella-cli mesh takes it as well");
  return 0;
}

}  // namespace lamella::cli
