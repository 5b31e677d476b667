#include "app/cli_job.h"

#include <cstdio>

#include "app/cli_common.h"
#include "core/project/project_file.h"
#include "core/study/study_field.h"

namespace lamella::cli {

namespace {

namespace fs = std::filesystem;

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
  if (!stem.empty()) console.say("report " + stem + ".html");
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
  Json done = {{"phase", "done"},
               {"converged", outcome.converged},
               {"cancelled", outcome.cancelled},
               {"nodes", report.final_record.nodes},
               {"elements", report.final_record.elements},
               {"quality_min", report.final_record.quality_min},
               {"quality_mean", report.final_record.quality_mean},
               {"valid", report.validity.valid()},
               {"bodies", bodies}};
  if (!stem.empty()) done["report"] = stem + ".json";
  done["seconds"] = outcome.seconds;
  console.emit(dump(done));
}

/// The project with the mesh in it. Notes of its writer are told.
Result<void> write_project(const Job& job, const std::vector<Part>& parts,
                           const std::string& output, const Made& made, const Progress& progress,
                           Console& console) {
  ProjectContent content;
  content.study = job.study;
  content.faces = known_faces(job.study, parts);
  content.copies = job.copies;
  content.write_mesh = [&](const fs::path& vtu) -> Result<void> {
    Result<ExportCertificate> proof =
        export_mesh(vtu, *made.outcome.state, job.study, job.inputs, progress.portion(0, 0.5));
    if (!proof) return proof.error();
    return {};
  };
  content.report_json = report_json(made.report);
  content.report_html = report_html(made.report);
  Result<std::vector<std::string>> saved = save_project(content, output, progress);
  if (!saved) return saved.error();
  console.say("wrote " + output + " (project), read back and compared");
  tell_notes(*saved, console);
  console.emit(dump({{"phase", "written"},
                     {"file", output},
                     {"format", "project"},
                     {"nodes", made.report.final_record.nodes},
                     {"notes", *saved}}));
  return {};
}

}  // namespace

Result<void> check_output(const std::string& output) {
  if (!is_project(output)) return check_export_name(output);
  std::error_code ec;
  const fs::path folder = fs::path(output).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, ec))
    return Error{Code::usage, "\"" + output + "\": the folder does not exist.", "Create it first."};
  return {};
}

std::string report_stem(const std::string& output) {
  return fs::path(output).replace_extension(".report").string();
}

void tell_notes(const std::vector<std::string>& notes, Console& console) {
  for (const std::string& note : notes) {
    console.say("note: " + note);
    console.emit(dump({{"phase", "note"}, {"note", note}}));
  }
}

void tell_parts(const std::vector<Part>& parts, const Study& study, Console& console) {
  for (const Part& part : parts) {
    console.say(part.name + ": " + grouped(part.surface.facets.size()) + " facets, " +
                short_number(part.cad_volume, 6) +
                " mm3, n = " + std::to_string(settings_of(study, part.name).layers));
    console.emit(dump({{"phase", "body"},
                       {"name", part.name},
                       {"facets", part.surface.facets.size()},
                       {"volume", part.cad_volume},
                       {"notes", part.notes}}));
  }
}

Result<void> read_field(Job& job, const Progress& progress) {
  auto field = load_field(job.study, job.copies, read_result, progress);
  if (!field) return of_input(field.error());
  job.field = std::move(*field);
  job.inputs = inputs_of(job.study);  // with today's hash of its file
  return {};
}

Result<Made> make_mesh(const Job& job, const std::vector<Part>& parts, const Progress& progress,
                       Console& console) {
  Result<Outcome> outcome = run(
      job.study, parts, meshers_for(job.mesher, job.study.options.seed), progress.portion(0, 0.95),
      [&](const IterationRecord& r, const auto&) { tell_iteration(r, console); }, job.field);
  if (!outcome) return outcome.error();
  // After a cancel the best mesh is written all the same: no stop request goes along any more.
  const Progress closing = outcome->cancelled ? Progress{} : progress.portion(0.95, 1, "writing");
  ReportContext context;
  context.command = job.command;
  context.inputs = job.inputs;
  for (const std::string& output : job.outputs) {
    if (is_project(output)) continue;
    Result<ExportCertificate> proof =
        export_mesh(output, *outcome->state, job.study, job.inputs, closing);
    if (!proof) return proof.error();
    tell_written(output, *proof, console);
    context.exports.push_back(std::move(*proof));
  }
  Result<Report> report = build_report(job.study, *outcome, context, closing);
  if (!report) return report.error();
  Made made{std::move(*outcome), std::move(*report)};
  for (const std::string& output : job.outputs) {
    if (!is_project(output)) continue;
    Result<void> written = write_project(job, parts, output, made, closing, console);
    if (!written) return written.error();
  }
  if (!job.report.empty())
    if (Result<void> written = write_report(made.report, job.report); !written)
      return written.error();
  tell_end(made.outcome, made.report, job.report, console);
  return made;
}

std::optional<Error> verdict_on(const Made& made, const std::optional<double>& min_quality) {
  if (made.outcome.cancelled)
    return Error{Code::cancelled, "Cancelled; the best mesh so far was written.", ""};
  const double worst = made.report.final_record.quality_min;
  if (min_quality && worst < *min_quality)
    return Error{Code::poor_quality,
                 "The worst element has quality " + short_number(worst, 3) + ", below " +
                     short_number(*min_quality, 3) + "; the mesh was written.",
                 "More iterations may help."};
  if (!made.outcome.converged)
    return Error{Code::not_converged,
                 "Layers and node count have not settled; the mesh was written.",
                 "Ask for more --iterations, or see the report for where layers lack."};
  return std::nullopt;
}

}  // namespace lamella::cli
