#include "core/study/report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/atomic_file.h"
#include "core/base/version.h"
#include "core/mesh/quality.h"
#include "core/study/join.h"
#include "core/study/measure.h"
#include "core/study/study_file.h"

namespace lamella {

namespace {

using Json = nlohmann::ordered_json;

Json layers_json(const LayerStats& layers) {
  return {{"mean", layers.mean},
          {"p5", layers.p5},
          {"median", layers.p50},
          {"p95", layers.p95},
          {"share_reached", layers.share_reached},
          {"places", layers.places}};
}

Json iteration_json(const IterationRecord& r) {
  return {{"iteration", r.iteration},
          {"nodes", r.nodes},
          {"elements", r.elements},
          {"volume", r.volume},
          {"quality_min", r.quality_min},
          {"quality_mean", r.quality_mean},
          {"conformity", r.conformity},
          {"unit_edges", r.unit_edges},
          {"layers", layers_json(r.layers)},
          {"layers_by_nodes", r.layers_by_nodes},
          {"mixed", r.mixed},
          {"interface_error", r.interface_error},
          {"flow_rate", r.flow_rate},
          {"flow_pressure", r.flow_pressure},
          {"forecast_nodes", r.forecast_nodes},
          {"forecast_memory", r.forecast_memory},
          {"seconds", r.seconds}};
}

Json inputs_json(const std::vector<InputFile>& inputs) {
  Json list = Json::array();
  for (const InputFile& input : inputs)
    list.push_back({{"path", input.path}, {"bytes", input.bytes}, {"sha256", input.sha256}});
  return list;
}

Json histogram_json(const Histogram& h) {
  return {{"low", h.low}, {"high", h.high}, {"counts", h.counts}};
}

Json farthest_json(const FarthestPoint& p) {
  return {{"distance", p.distance}, {"place", {p.place[0], p.place[1], p.place[2]}}};
}

Json below_json(const std::vector<PlaceBelow>& places) {
  Json list = Json::array();
  for (const PlaceBelow& p : places)
    list.push_back(
        {{"place", {p.at[0], p.at[1], p.at[2]}}, {"layers", p.layers}, {"area", p.area}});
  return list;
}

Json body_json(const BodyOutcome& body) {
  Json records = Json::array();
  for (const IterationRecord& r : body.records) records.push_back(iteration_json(r));
  return {{"name", body.name},
          {"layers_asked", body.layers_asked},
          {"first_mesh_by", body.first_mesh_by},
          {"cad_volume", body.cad_volume},
          {"mesh_volume", body.mesh_volume},
          {"boundary_distance", body.boundary_distance.largest()},
          {"boundary_to_part", farthest_json(body.boundary_distance.to_surface)},
          {"part_to_boundary", farthest_json(body.boundary_distance.from_surface)},
          {"chord_tolerance", body.chord_tolerance},
          {"h_min", body.h_min},
          {"interface_size", body.interface_size},
          {"interface_error", body.interface_error},
          {"layers", layers_json(body.layers)},
          {"below", below_json(body.below)},
          {"notes", body.notes},
          {"records", std::move(records)}};
}

std::string dump(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

Result<InputFile> describe_input(const std::filesystem::path& file) {
  StudyInput input{file.string()};
  if (Result<void> known = identify(input, file); !known) return known.error();
  return InputFile{file.filename().string(), input.bytes, input.sha256};
}

std::vector<InputFile> inputs_of(const Study& study) {
  std::vector<InputFile> inputs;
  for (const StudyInput& input : study.inputs)
    inputs.push_back(
        {std::filesystem::path(input.file).filename().string(), input.bytes, input.sha256});
  return inputs;
}

Result<Report> build_report(const Study& study, const Outcome& outcome,
                            const ReportContext& context, const Progress& progress) {
  Report report;
  report.study = study;
  report.outcome = outcome;
  report.context = context;
  const MeshState& state = *outcome.state;
  Result<MeshReport> validity = inspect<3>(state.mesh, progress.portion(0, 0.6));
  if (!validity) return validity.error();
  report.validity = *validity;

  MeshState measured = state;
  Result<IterationRecord> record = measure(measured, progress.portion(0.6, 0.9));
  if (!record) return record.error();
  std::vector<IterationRecord> of_body(outcome.bodies.size());
  std::vector<const IterationRecord*> records;
  for (std::size_t b = 0; b < of_body.size(); ++b) {
    of_body[b].layers = outcome.bodies[b].layers;
    records.push_back(&of_body[b]);
  }
  report.final_record = *record;
  if (!records.empty()) report.final_record.layers = join(records).layers;

  Result<Fitness> found = fitness(state.mesh, progress.portion(0.9, 1));
  if (!found) return found.error();
  report.fitness = std::move(*found);
  for (const double q : state.quality) report.quality.add(q);

  int asked = 1;
  for (const BodyOutcome& body : outcome.bodies) asked = std::max(asked, body.layers_asked);
  report.layers = Histogram(0, 2.5 * asked, 25);
  for (std::size_t v = 1; v < state.layers.size(); ++v) report.layers.add(state.layers[v]);
  progress.report(1);
  return report;
}

std::vector<FitnessLine> fitness_lines(const Report& report) {
  const MeshState& state = *report.outcome.state;
  const LayerStats& layers = report.final_record.layers;
  return fitness_lines(report.fitness, state.mesh.bodies.size(),
                       layers.places > 0 ? std::optional(layers.p5) : std::nullopt);
}

std::string record_json(const IterationRecord& record) { return dump(iteration_json(record), -1); }

std::string report_json(const Report& report) {
  const MeshReport& v = report.validity;
  Json json;
  json["program"] = "Lamella " + version();
  json["unit"] = "mm";
  json["study"] = Json::parse(study_to_json(report.study), nullptr, false);
  json["inputs"] = inputs_json(report.context.inputs);
  json["command"] = report.context.command;
  json["converged"] = report.outcome.converged;
  json["cancelled"] = report.outcome.cancelled;
  json["seconds"] = report.outcome.seconds;
  json["mesh"] = {{"nodes", v.nodes},
                  {"elements", v.elements},
                  {"boundary_faces", v.faces_boundary},
                  {"volume", v.volume},
                  {"boundary_area", v.boundary_area},
                  {"valid", v.valid()},
                  {"inverted", v.inverted},
                  {"faces_in_more_than_two_elements", v.faces_shared},
                  {"boundary_faces_not_listed", v.facets_missing}};
  json["quality"] = {{"min", report.final_record.quality_min},
                     {"mean", report.final_record.quality_mean},
                     {"conformity", report.final_record.conformity},
                     {"unit_edges", report.final_record.unit_edges},
                     {"aspect_ratio_max", report.fitness.aspect.max},
                     {"aspect_ratio_over_50",
                      static_cast<double>(report.fitness.aspect_over_50) /
                          static_cast<double>(std::max<std::size_t>(1, report.fitness.elements))},
                     {"histogram", histogram_json(report.quality)}};
  json["solvers"] = Json::array();
  for (const FitnessLine& line : fitness_lines(report))
    json["solvers"].push_back({{"solver", line.solver},
                               {"criterion", line.criterion},
                               {"value", line.value},
                               {"bound", line.bound},
                               {"holds", line.holds}});
  json["layers"] = layers_json(report.final_record.layers);
  json["layers"]["histogram"] = histogram_json(report.layers);
  json["bodies"] = Json::array();
  for (const BodyOutcome& body : report.outcome.bodies) json["bodies"].push_back(body_json(body));
  json["records"] = Json::array();
  for (const IterationRecord& r : report.outcome.records)
    json["records"].push_back(iteration_json(r));
  json["exports"] = Json::array();
  for (const ExportCertificate& c : report.context.exports)
    json["exports"].push_back({{"file", c.file},
                               {"format", c.format},
                               {"agrees", c.agrees},
                               {"worst_difference", c.worst_difference},
                               {"finding", c.finding},
                               {"notes", c.notes}});
  return dump(json, 2) + "\n";
}

Result<void> write_report(const Report& report, const std::filesystem::path& stem) {
  if (Result<void> done = write_file(stem.string() + ".json", report_json(report)); !done)
    return done;
  return write_file(stem.string() + ".html", report_html(report));
}

std::string provenance_json(const Study& study, const SimplexMesh<3>& mesh,
                            const std::vector<InputFile>& inputs) {
  Json json;
  json["program"] = "Lamella " + version();
  json["study"] = study.name;
  json["bodies"] = Json::array();
  for (std::size_t b = 0; b < mesh.bodies.size(); ++b) {
    Json body = {{"name", mesh.bodies[b]}};
    const BodySettings settings = settings_of(study, mesh.bodies[b]);
    if (settings.role != BodyRole::none) body["role"] = role_name(settings.role);
    body["layers"] = settings.layers;
    body["alpha"] = settings.alpha;
    if (settings.layers2) body["layers2"] = *settings.layers2;
    if (settings.layers2) body["alpha2"] = settings.alpha2;
    if (settings.layers3) body["layers3"] = *settings.layers3;
    if (settings.h_min) body["h_min"] = *settings.h_min;
    json["bodies"].push_back(std::move(body));
  }
  json["groups"] = Json::array();
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    Json group = {{"name", mesh.groups[g]}};
    for (const BoundaryGroup& asked : study.groups)
      if (asked.name == mesh.groups[g]) group["kind"] = group_kind_name(asked.kind);
    json["groups"].push_back(std::move(group));
  }
  json["inputs"] = inputs_json(inputs);
  return dump(json, -1);
}

}  // namespace lamella
