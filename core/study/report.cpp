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

Json place_json(const Vec<3>& x) { return {x[0], x[1], x[2]}; }

Json overlaps_json(const StudyOverlaps& found) {
  const auto name = [&](int region) { return found.names[static_cast<std::size_t>(region)]; };
  Json overlaps = Json::array(), gaps = Json::array();
  for (const Overlap& o : found.report.overlaps) {
    overlaps.push_back({{"bodies", {name(o.first), name(o.second)}},
                        {"volume", o.volume},
                        {"error", o.error},
                        {"depth", o.depth},
                        {"place", place_json(o.place)}});
    if (o.inner) overlaps.back()["inner"] = name(*o.inner);
  }
  for (const Gap& g : found.report.gaps)
    gaps.push_back({{"bodies", {name(g.first), name(g.second)}},
                    {"volume", g.volume},
                    {"error", g.error},
                    {"mean_width", g.mean_width},
                    {"least_width", g.least_width},
                    {"place", place_json(g.place)}});
  return {{"overlaps", overlaps}, {"gaps", gaps}};
}

double number(const Json& json, const char* name) {
  const Json& value = json.at(name);
  return value.is_null() ? std::nan("") : value.get<double>();
}

Vec<3> place_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

LayerStats layers_of(const Json& json) {
  LayerStats layers;
  layers.mean = number(json, "mean");
  layers.p5 = number(json, "p5");
  layers.p50 = number(json, "median");
  layers.p95 = number(json, "p95");
  layers.share_reached = number(json, "share_reached");
  layers.places = json.at("places").get<std::size_t>();
  return layers;
}

IterationRecord iteration_of(const Json& json) {
  IterationRecord r;
  r.iteration = json.at("iteration").get<int>();
  r.nodes = json.at("nodes").get<std::size_t>();
  r.elements = json.at("elements").get<std::size_t>();
  r.volume = number(json, "volume");
  r.quality_min = number(json, "quality_min");
  r.quality_mean = number(json, "quality_mean");
  r.conformity = number(json, "conformity");
  r.unit_edges = number(json, "unit_edges");
  r.layers = layers_of(json.at("layers"));
  r.layers_by_nodes = number(json, "layers_by_nodes");
  r.mixed = json.at("mixed").get<std::size_t>();
  r.interface_error = number(json, "interface_error");
  r.flow_rate = number(json, "flow_rate");
  r.flow_pressure = number(json, "flow_pressure");
  r.forecast_nodes = number(json, "forecast_nodes");
  r.forecast_memory = number(json, "forecast_memory");
  r.seconds = number(json, "seconds");
  return r;
}

BodyOutcome body_of(const Json& json) {
  BodyOutcome body;
  body.name = json.at("name").get<std::string>();
  body.layers_asked = json.at("layers_asked").get<int>();
  body.first_mesh_by = json.at("first_mesh_by").get<std::string>();
  body.cad_volume = number(json, "cad_volume");
  body.mesh_volume = number(json, "mesh_volume");
  const auto farthest = [&](const char* name) {
    return FarthestPoint{number(json.at(name), "distance"), place_of(json.at(name).at("place"))};
  };
  body.boundary_distance = {farthest("boundary_to_part"), farthest("part_to_boundary")};
  body.chord_tolerance = number(json, "chord_tolerance");
  body.h_min = number(json, "h_min");
  body.interface_size = number(json, "interface_size");
  body.interface_error = number(json, "interface_error");
  body.layers = layers_of(json.at("layers"));
  for (const Json& p : json.at("below"))
    body.below.push_back({place_of(p.at("place")), number(p, "layers"), number(p, "area")});
  body.notes = json.at("notes").get<std::vector<std::string>>();
  for (const Json& r : json.at("records")) body.records.push_back(iteration_of(r));
  return body;
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
  for (const StudyInput* input : sources_of(study))
    inputs.push_back(
        {std::filesystem::path(input->file).filename().string(), input->bytes, input->sha256});
  return inputs;
}

Result<Report> build_report(const Study& study, const Outcome& outcome,
                            const ReportContext& context, const Progress& progress) {
  Report report;
  report.study = study;
  report.outcome = outcome;
  report.context = context;
  const MeshState& state = *outcome.state;
  Result<MeshReport> validity = inspect<3>(state.mesh, progress.portion(0, 0.5));
  if (!validity) return validity.error();
  report.validity = *validity;

  MeshState measured = state;
  Result<IterationRecord> record = measure(measured, progress.portion(0.5, 0.7));
  if (!record) return record.error();
  std::vector<IterationRecord> of_body(outcome.bodies.size());
  std::vector<const IterationRecord*> records;
  for (std::size_t b = 0; b < of_body.size(); ++b) {
    of_body[b].layers = outcome.bodies[b].layers;
    records.push_back(&of_body[b]);
  }
  report.final_record = *record;
  if (!records.empty()) report.final_record.layers = join(records).layers;

  Result<Fitness> found = fitness(state.mesh, progress.portion(0.7, 0.8));
  if (!found) return found.error();
  report.fitness = std::move(*found);
  for (const double q : state.quality) report.quality.add(q);

  int asked = 1;
  for (const BodyOutcome& body : outcome.bodies) asked = std::max(asked, body.layers_asked);
  report.layers = Histogram(0, 2.5 * asked, 25);
  for (std::size_t v = 1; v < state.layers.size(); ++v) report.layers.add(state.layers[v]);
  Result<std::optional<ReportPicture>> map = layers_map(study, state, progress.portion(0.8, 0.9));
  if (!map) return map.error();
  report.layers_map = std::move(*map);
  Result<std::vector<ReportPicture>> drawn = sections(study, state, progress.portion(0.9, 1));
  if (!drawn) return drawn.error();
  report.sections = std::move(*drawn);
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
  if (report.outcome.overlaps) json["overlaps"] = overlaps_json(*report.outcome.overlaps);
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

Result<Outcome> outcome_from_json(const std::string& report) {
  const Json json = Json::parse(report, nullptr, false);
  try {
    Outcome outcome;
    outcome.converged = json.at("converged").get<bool>();
    outcome.cancelled = json.at("cancelled").get<bool>();
    outcome.seconds = number(json, "seconds");
    for (const Json& body : json.at("bodies")) outcome.bodies.push_back(body_of(body));
    for (const Json& record : json.at("records")) outcome.records.push_back(iteration_of(record));
    return outcome;
  } catch (const Json::exception&) {
    return Error{Code::bad_input, "The report is none of this version.",
                 "Run the study again to have one."};
  }
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
