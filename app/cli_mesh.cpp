#include <tbb/global_control.h>

#include <algorithm>

#include "app/cli_commands.h"
#include "app/cli_common.h"
#include "app/cli_domain.h"
#include "app/cli_groups.h"
#include "app/cli_job.h"
#include "app/cli_sizing.h"
#include "core/mesh/validate.h"
#include "core/project/project_file.h"
#include "core/study/first_mesh.h"
#include "core/study/forecast.h"
#include "core/study/join.h"
#include "core/study/mesh_parts.h"
#include "core/study/study_file.h"

namespace lamella::cli {

namespace {

namespace fs = std::filesystem;

/// The study of the command line and the files it reads.
struct Request {
  Study study;
  std::vector<fs::path> files;
  Project project;  ///< whose copies the files may be
};

Result<Request> request_of(const MeshCommand& c, Console& console) {
  Request request;
  const auto studies = std::count_if(c.inputs.begin(), c.inputs.end(), names_study);
  if (studies > 0 && c.inputs.size() > 1)
    return Error{Code::usage, "A study brings its own parts: give the study alone.", ""};
  if (studies > 0) {
    Result<Project> project = open_project(c.inputs.front());
    if (!project) return of_input(project.error());
    tell_notes(project->notes, console);
    request.study = project->study;
    request.files = project->files;
    request.project = std::move(*project);
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
  if (c.capture && o.interfaces == Interfaces::exact)
    return Error{Code::usage, "--capture is for fuzzy borders: exact ones are cut.",
                 "Add --interfaces fuzzy, or leave it out."};
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
  // Last: what is wrong with the command is told before what is wrong with its files.
  for (std::size_t k = 0; studies == 0 && k < request.files.size(); ++k)
    if (Result<void> known = identify(request.study.inputs[k], request.files[k]); !known)
      return of_input(known.error());
  return request;
}

/// Options of the command line hold for every body.
Result<void> apply_to_bodies(const MeshCommand& c, const std::vector<Part>& parts, Study& study) {
  std::vector<std::string> names;
  for (const Part& part : parts) names.push_back(part.name);
  for (const StudyZone& zone : study.zones) names.push_back(zone.name);
  for (const std::string& asked : c.flow_bodies)
    if (std::count(names.begin(), names.end(), asked) == 0)
      return Error{Code::usage, "--flow-body: there is no body \"" + asked + "\".",
                   "`info` lists the bodies of a file."};
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
  return {};
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
    Json told{{"phase", "forecast"},
              {"body", b.name},
              {"natural", json_of(b.mesh.natural)},
              {"corrected", json_of(b.mesh.corrected)},
              {"samples", b.mesh.samples},
              {"seconds", b.seconds}};
    if (b.flow) {
      const MeshForecast& f = b.flow->mesh;
      console.say(b.name +
                  (b.flow->solves == 0 ? ", by the solver's field"
                                       : ", by the flow, solved " + std::to_string(b.flow->solves) +
                                             (b.flow->solves == 1 ? " time" : " times")) +
                  ": at most about " + grouped(static_cast<std::size_t>(f.nodes)) + " nodes, " +
                  grouped(static_cast<std::size_t>(f.elements)) + " elements and " +
                  grouped(static_cast<std::size_t>(f.memory) + 1) + " MB");
      told["flow"] = json_of(f);
      told["flow"]["solves"] = b.flow->solves;
    }
    console.emit(dump(told));
  }
  return 0;
}

}  // namespace

int run_mesh(const MeshCommand& c, const std::string& line, Console& console) {
  // What would fail at the end is told at the beginning.
  for (const std::string& output : c.outputs)
    if (Result<void> known = check_output(output); !known) return console.fail(known.error());
  Result<Request> request = request_of(c, console);
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
  // Those of the command line are behind those of the study, and mean the parts of today.
  Study& saved = request->project.study;
  if (!saved.inputs.empty()) tell_notes(fit_to_parts(saved, c.inputs.front(), *parts), console);
  std::copy(saved.groups.begin(), saved.groups.end(), study.groups.begin());
  std::copy(saved.sizing.begin(), saved.sizing.end(), study.sizing.begin());
  if (saved.inputs.empty())
    for (const Part& part : *parts) add_groups_of_file(part, study);
  if (Result<void> applied = apply_to_bodies(c, *parts, study); !applied)
    return console.fail(applied.error());

  Job job;
  job.command = line;
  job.inputs = inputs_of(study);
  job.copies = request->project.copies;
  tell_parts(*parts, study, console);

  if (c.forecast) {
    const Result<std::vector<BodyForecast>> bodies =
        forecast_study(study, *parts, meshers_for(mesher_choice(c.mesher), study.options.seed),
                       progress.portion(0.05, 1));
    if (!bodies) return console.fail(bodies.error());
    return tell_forecast(*bodies, !study.sizing.empty(), console);
  }
  job.study = std::move(study);
  if (Result<void> read = read_field(job, progress.portion(0.05, 0.08)); !read)
    return console.fail(read.error());
  job.mesher = mesher_choice(c.mesher);
  job.outputs = c.outputs;
  job.report = c.report.empty() ? report_stem(c.outputs.front()) : c.report;
  Result<Made> made = make_mesh(job, *parts, progress.portion(0.08, 1), console);
  if (!made) return console.fail(made.error());
  const std::optional<Error> verdict = verdict_on(*made, c.min_quality);
  return verdict ? console.fail(*verdict) : 0;
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

  const MesherChoice asked = mesher_choice(c.mesher);
  for (const Part& part : *parts) {
    const std::size_t facets = part.surface.facets.size();
    if (Result<void> fits = within_memory(
            "Body \"" + part.name + "\", whose surface has " + grouped(facets) +
                " triangles: about",
            first_mesh_memory(facets, asked == MesherChoice::netgen), c.memory,
            "Allow more memory, or take a coarser surface by a larger --chord-tolerance.");
        !fits)
      return console.fail(fits.error());
  }
  std::vector<MeshState> states(parts->size());
  std::vector<const MeshState*> pointers;
  std::vector<std::string> names;
  for (std::size_t b = 0; b < parts->size(); ++b) {
    const Part& part = (*parts)[b];
    // Netgen takes more; where it would take too much there is algorithm 2.1 alone.
    const bool without_netgen = asked == MesherChoice::automatic && c.memory &&
                                first_mesh_memory(part.surface.facets.size(), true) > *c.memory;
    const auto meshers = meshers_for(without_netgen ? MesherChoice::topological : asked, c.seed);
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
