#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>

#include "app/cli_commands.h"
#include "app/cli_common.h"
#include "app/cli_domain.h"
#include "app/cli_groups.h"
#include "app/cli_sizing.h"
#include "core/mesh/validate.h"
#include "core/study/first_mesh.h"
#include "core/study/forecast.h"
#include "core/study/join.h"
#include "core/study/study_file.h"

namespace lamella::cli {

namespace {

namespace fs = std::filesystem;

bool is_study(const std::string& file) {
  const fs::path ending = fs::path(file).extension();
  return ending == ".json" || ending == ".lamella";
}

/// The study of the command line and the files it reads.
struct Request {
  Study study;
  std::vector<fs::path> files;
};

Result<Request> request_of(const MeshCommand& c) {
  Request request;
  const auto studies = std::count_if(c.inputs.begin(), c.inputs.end(), is_study);
  if (studies > 0 && c.inputs.size() > 1)
    return Error{Code::usage, "A study brings its own parts: give the study alone.", ""};
  if (studies > 0) {
    Result<Study> study = read_study(c.inputs.front());
    if (!study) {
      Error error = study.error();
      error.code = Code::bad_input;
      return error;
    }
    request.study = std::move(*study);
    request.files = input_files(request.study, fs::path(c.inputs.front()).parent_path());
    if (request.files.empty() && request.study.zones.empty())
      return Error{Code::bad_input, "\"" + c.inputs.front() + "\": the study names no inputs.",
                   "Add the parts to \"inputs\"."};
  } else {
    request.study.name = fs::path(c.inputs.front()).stem().string();
    for (const std::string& input : c.inputs) request.study.inputs.push_back({input});
    request.files.assign(c.inputs.begin(), c.inputs.end());
  }
  if (c.unit)
    for (StudyInput& input : request.study.inputs) input.unit = unit_factor(*c.unit);
  StudyOptions& o = request.study.options;
  if (c.chord_tolerance) o.chord_tolerance = c.chord_tolerance;
  if (c.max_anisotropy) o.max_anisotropy = c.max_anisotropy;
  if (c.angle_tolerance) o.angle_tolerance = *c.angle_tolerance;
  if (c.iterations) o.iterations = *c.iterations;
  if (c.threads) o.threads = *c.threads;
  if (c.seed) o.seed = *c.seed;
  if (c.progressive) o.progressive = true;
  if (c.memory) o.memory = c.memory;
  if (c.detector) o.detector = detector_from_name(*c.detector).value_or(o.detector);
  if (c.domain) {
    Result<StudyDomain> domain = domain_of(*c.domain);
    if (!domain) return domain.error();
    request.study.domain = std::move(*domain);
  }
  if (!request.study.domain && (c.interfaces || c.interface_size || c.capture))
    return Error{Code::usage, "Interfaces are of one mesh of all bodies.", "Add a --domain."};
  if (!c.drop.empty()) {
    if (!request.study.domain)
      return Error{Code::usage, "Bodies are dropped from one mesh of all of them.",
                   "Add a --domain."};
    request.study.dropped = c.drop;
  }
  if (c.interfaces) o.interfaces = *c.interfaces == "fuzzy" ? Interfaces::fuzzy : Interfaces::exact;
  if (c.capture) o.capture = *c.capture == "gradient" ? Capture::gradient : Capture::distance;
  Result<std::vector<SizingObject>> sizing = sizing_of(c);
  if (!sizing) return sizing.error();
  std::move(sizing->begin(), sizing->end(), std::back_inserter(request.study.sizing));
  for (const std::string& text : c.groups) {
    Result<BoundaryGroup> group = read_group(text);
    if (!group) return group.error();
    request.study.groups.push_back(std::move(*group));
  }
  if (Result<void> added = add_flow(c, request.study); !added) return added.error();
  return request;
}

/// Options of the command line hold for every body.
void apply_to_bodies(const MeshCommand& c, const std::vector<Part>& parts, Study& study) {
  std::vector<std::string> names;
  for (const Part& part : parts) names.push_back(part.name);
  for (const StudyZone& zone : study.zones) names.push_back(zone.name);
  std::vector<BodySettings> bodies;
  for (const std::string& name : names) {
    BodySettings body = settings_of(study, name);
    if (c.layers) body.layers = *c.layers;
    if (c.alpha) body.alpha = *c.alpha;
    if (c.layers2) body.layers2 = c.layers2;
    if (c.alpha2) body.alpha2 = *c.alpha2;
    if (c.layers3) body.layers3 = c.layers3;
    if (c.h_min) body.h_min = c.h_min;
    if (c.h_max) body.h_max = c.h_max;
    if (c.interface_size) body.interface_size = c.interface_size;
    if (!c.flow_bodies.empty())
      body.flow = std::count(c.flow_bodies.begin(), c.flow_bodies.end(), name) > 0;
    bodies.push_back(std::move(body));
  }
  for (const BodySettings& other : study.bodies)
    if (std::count(names.begin(), names.end(), other.name) == 0) bodies.push_back(other);
  study.bodies = std::move(bodies);
}

void tell_iteration(const IterationRecord& r, Console& console) {
  if (r.iteration == 0 && r.forecast_nodes > 0)
    console.say("about " + grouped(static_cast<std::size_t>(r.forecast_nodes)) + " nodes and " +
                grouped(static_cast<std::size_t>(r.forecast_memory) + 1) +
                " MB are to be expected");
  if (r.iteration == 0)
    console.say(" it      nodes   elements   layers mean     5 %   quality mean   worst    time");
  char line[160];
  std::snprintf(line, sizeof line, "%3d %10s %10s   %11.2f %7.2f   %12.3f %7.3f %6.1f s",
                r.iteration, grouped(r.nodes).c_str(), grouped(r.elements).c_str(), r.layers.mean,
                r.layers.p5, r.quality_mean, r.quality_min, r.seconds);
  std::string text = line;
  if (r.mixed > 0) {
    std::snprintf(line, sizeof line, "   %s mixed, interface error %.4f", grouped(r.mixed).c_str(),
                  r.interface_error);
    text += line;
  }
  if (r.flow_rate > 0)
    text += "   flow " + short_number(r.flow_rate, 5) + " mm3/s at " +
            short_number(r.flow_pressure, 4) + " MPa";
  console.say(text);
  if (!console.json()) return;
  Json json = Json::parse(record_json(r));
  json["phase"] = "iteration";
  console.emit(dump(json));
}

void tell_end(const Outcome& outcome, const Report& report, const std::string& stem,
              Console& console) {
  for (const BodyOutcome& b : outcome.bodies) {
    char line[240];
    const double difference = b.cad_volume > 0 ? 100 * (b.mesh_volume / b.cad_volume - 1) : 0;
    if (outcome.state->filling)
      std::snprintf(line, sizeof line,
                    "%s: layers %.2f (5 %%: %.2f) of %d, volume %+.3f %%, interface error %.4f at "
                    "%.3g mm across",
                    b.name.c_str(), b.layers.mean, b.layers.p5, b.layers_asked, difference,
                    b.interface_error, b.interface_size);
    else
      std::snprintf(line, sizeof line,
                    "%s: layers %.2f (5 %%: %.2f) of %d, volume %+.3f %%, boundary within %.3g mm, "
                    "part within %.3g mm of %.3g mm, first mesh by %s",
                    b.name.c_str(), b.layers.mean, b.layers.p5, b.layers_asked, difference,
                    b.boundary_distance.to_surface.distance,
                    b.boundary_distance.from_surface.distance, b.chord_tolerance,
                    b.first_mesh_by.c_str());
    console.say(line);
    for (const std::string& note : b.notes) console.say("  note: " + note);
  }
  console.say("report " + stem + ".html");
  Json bodies = Json::array();
  for (const BodyOutcome& b : outcome.bodies)
    bodies.push_back({{"name", b.name},
                      {"layers_asked", b.layers_asked},
                      {"layers_mean", b.layers.mean},
                      {"layers_p5", b.layers.p5},
                      {"cad_volume", b.cad_volume},
                      {"mesh_volume", b.mesh_volume},
                      {"boundary_distance", b.boundary_distance.largest()},
                      {"boundary_to_part", farthest_json(b.boundary_distance.to_surface)},
                      {"part_to_boundary", farthest_json(b.boundary_distance.from_surface)},
                      {"chord_tolerance", b.chord_tolerance},
                      {"interface_size", b.interface_size},
                      {"interface_error", b.interface_error},
                      {"first_mesh_by", b.first_mesh_by},
                      {"notes", b.notes}});
  console.emit(dump({{"phase", "done"},
                     {"converged", outcome.converged},
                     {"cancelled", outcome.cancelled},
                     {"nodes", report.final_record.nodes},
                     {"elements", report.final_record.elements},
                     {"quality_min", report.final_record.quality_min},
                     {"quality_mean", report.final_record.quality_mean},
                     {"valid", report.validity.valid()},
                     {"bodies", bodies},
                     {"report", stem + ".json"},
                     {"seconds", outcome.seconds}}));
}

/// The end of `mesh --forecast`.
int tell_forecast(const std::vector<BodyForecast>& bodies, bool with_sizing, Console& console) {
  const auto say = [&](const std::string& who, const MeshForecast& f) {
    console.say(who + ": about " + grouped(static_cast<std::size_t>(f.nodes)) + " nodes, " +
                grouped(static_cast<std::size_t>(f.elements)) + " elements; adaption takes about " +
                grouped(static_cast<std::size_t>(f.memory) + 1) + " MB");
  };
  const auto json_of = [](const MeshForecast& f) {
    return Json{{"nodes", f.nodes}, {"elements", f.elements}, {"memory", f.memory}};
  };
  for (const BodyForecast& b : bodies) {
    say(b.name, b.mesh.natural);
    if (with_sizing) say(b.name + ", sizes corrected", b.mesh.corrected);
    console.emit(dump({{"phase", "forecast"},
                       {"body", b.name},
                       {"natural", json_of(b.mesh.natural)},
                       {"corrected", json_of(b.mesh.corrected)},
                       {"samples", b.mesh.samples},
                       {"seconds", b.seconds}}));
  }
  return 0;
}

}  // namespace

int run_mesh(const MeshCommand& c, const std::string& line, Console& console) {
  // What would fail at the end is told at the beginning.
  for (const std::string& output : c.outputs)
    if (Result<void> known = check_export_name(output); !known) return console.fail(known.error());
  Result<Request> request = request_of(c);
  if (!request) return console.fail(request.error());
  Study& study = request->study;
  std::optional<tbb::global_control> limit;
  if (study.options.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism,
                  static_cast<std::size_t>(study.options.threads));

  const Progress progress = console.progress();
  LoadParams load = load_params(c.repair, c.wrap_spacing, c.cad);
  load.chord_tolerance = study.options.chord_tolerance;
  load.angle_tolerance = study.options.angle_tolerance;
  Result<std::vector<Part>> parts =
      load_all(request->files, study, load, progress.portion(0, 0.05));
  if (!parts) return console.fail(parts.error());
  apply_to_bodies(c, *parts, study);

  ReportContext context;
  context.command = line;
  for (const fs::path& file : request->files) {
    Result<InputFile> input = describe_input(file);
    if (!input) return console.fail(input.error());
    context.inputs.push_back(std::move(*input));
  }
  for (const Part& part : *parts) {
    console.say(part.name + ": " + grouped(part.surface.facets.size()) + " facets, " +
                short_number(part.cad_volume, 6) +
                " mm3, n = " + std::to_string(settings_of(study, part.name).layers));
    console.emit(dump({{"phase", "body"},
                       {"name", part.name},
                       {"facets", part.surface.facets.size()},
                       {"volume", part.cad_volume},
                       {"notes", part.notes}}));
  }

  if (c.forecast) {
    const Result<std::vector<BodyForecast>> bodies =
        forecast_study(study, *parts, meshers_for(mesher_choice(c.mesher), study.options.seed),
                       progress.portion(0.05, 1));
    if (!bodies) return console.fail(bodies.error());
    return tell_forecast(*bodies, !study.sizing.empty(), console);
  }
  Result<Outcome> outcome =
      run(study, *parts, meshers_for(mesher_choice(c.mesher), study.options.seed),
          progress.portion(0.05, 0.95),
          [&](const IterationRecord& r, const auto&) { tell_iteration(r, console); });
  if (!outcome) return console.fail(outcome.error());

  // After a cancel the best mesh is written all the same: no stop request goes along any more.
  const Progress closing = outcome->cancelled ? Progress{} : progress.portion(0.95, 1, "writing");
  for (const std::string& output : c.outputs) {
    Result<ExportCertificate> proof =
        export_mesh(output, *outcome->state, study, context.inputs, closing);
    if (!proof) return console.fail(proof.error());
    tell_written(output, *proof, console);
    context.exports.push_back(std::move(*proof));
  }
  Result<Report> report = build_report(study, *outcome, context, closing);
  if (!report) return console.fail(report.error());
  const std::string stem = c.report.empty()
                               ? fs::path(c.outputs.front()).replace_extension(".report").string()
                               : c.report;
  if (Result<void> written = write_report(*report, stem); !written)
    return console.fail(written.error());
  tell_end(*outcome, *report, stem, console);

  if (outcome->cancelled)
    return console.fail({Code::cancelled, "Cancelled; the best mesh so far was written.", ""});
  if (c.min_quality && report->final_record.quality_min < *c.min_quality)
    return console.fail({Code::poor_quality,
                         "The worst element has quality " +
                             short_number(report->final_record.quality_min, 3) + ", below " +
                             short_number(*c.min_quality, 3) + "; the mesh was written.",
                         "More iterations may help."});
  if (!outcome->converged)
    return console.fail({Code::not_converged,
                         "Layers and node count have not settled; the mesh was written.",
                         "Ask for more --iterations, or see the report for where layers lack."});
  return 0;
}

int run_generate(const GenerateCommand& c, Console& console) {
  if (Result<void> known = check_export_name(c.output); !known) return console.fail(known.error());
  const Progress progress = console.progress();
  LoadParams load = load_params(c.repair, c.wrap_spacing, c.cad);
  load.chord_tolerance = c.chord_tolerance;
  Study study;
  study.inputs = {{c.surface, unit_factor(c.unit)}};
  Result<std::vector<Part>> parts = load_all({c.surface}, study, load, progress.portion(0, 0.1));
  if (!parts) return console.fail(parts.error());

  std::vector<MeshState> states(parts->size());
  std::vector<const MeshState*> pointers;
  std::vector<std::string> names;
  const auto meshers = meshers_for(mesher_choice(c.mesher), c.seed);
  for (std::size_t b = 0; b < parts->size(); ++b) {
    const Part& part = (*parts)[b];
    const auto at = static_cast<double>(b), count = static_cast<double>(parts->size());
    const Progress share =
        progress.portion(0.1 + 0.8 * at / count, 0.1 + 0.8 * (at + 1) / count, "first mesh");
    Result<FirstMesh> mesh = first_mesh(part, meshers, share);
    if (!mesh) return console.fail(mesh.error());
    for (const std::string& note : part.notes) console.say(part.name + ": " + note);
    for (const std::string& note : mesh->notes) console.say(part.name + ": " + note);
    MeshReport found = inspect<3>(mesh->mesh).value();
    console.say(part.name + ": " + grouped(found.nodes) + " nodes, " + grouped(found.elements) +
                " tetrahedra by " + mesh->made_by);
    console.emit(dump({{"phase", "generated"},
                       {"body", part.name},
                       {"mesher", mesh->made_by},
                       {"nodes", found.nodes},
                       {"elements", found.elements},
                       {"volume", found.volume},
                       {"cad_volume", part.cad_volume},
                       {"surface_notes", part.notes},
                       {"notes", mesh->notes}}));
    states[b].mesh = std::move(mesh->mesh);
    pointers.push_back(&states[b]);
    names.push_back(part.name);
  }
  MeshState all = *join(pointers, names);
  all.metric.clear();
  all.thickness.clear();
  all.layers.clear();
  Result<ExportCertificate> proof =
      export_mesh(c.output, all, Study{}, {}, progress.portion(0.9, 1, "writing"));
  if (!proof) return console.fail(proof.error());
  tell_written(c.output, *proof, console);
  return 0;
}

}  // namespace lamella::cli
