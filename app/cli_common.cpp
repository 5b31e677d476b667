#include "app/cli_common.h"

#include <filesystem>

#include "app/services.h"
#include "core/io/mesh_file.h"
#include "core/mesh/quality.h"
#include "core/metric/analytic.h"

namespace lamella::cli {

namespace fs = std::filesystem;

namespace {

Json stats_json(const Stats& s) {
  return {{"count", s.count}, {"min", s.min}, {"p1", s.p1},    {"p5", s.p5},
          {"p25", s.p25},     {"p50", s.p50}, {"p75", s.p75},  {"p95", s.p95},
          {"p99", s.p99},     {"max", s.max}, {"mean", s.mean}};
}

}  // namespace

std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Error of_input(Error error) {
  if (error.code == Code::io) error.code = Code::bad_input;
  return error;
}

Result<AnyMesh> read_any(const std::string& file, MetricField<3>* metric,
                         const Progress& progress) {
  if (names_medit(file)) {
    Result<AnyMesh> any = read_medit(file, progress);
    if (!any || !std::holds_alternative<SimplexMesh<3>>(*any)) return any;
    MeshContent content;
    content.mesh = std::get<SimplexMesh<3>>(std::move(*any));
    if (Result<void> done = complete(content, file); !done) return done.error();
    if (metric) *metric = std::move(content.metric);
    return AnyMesh(std::move(content.mesh));
  }
  Result<MeshState> state = read_mesh(file, progress);
  if (!state) return state.error();
  if (metric) *metric = std::move(state->metric);
  return AnyMesh(std::move(state->mesh));
}

void tell_written(const std::string& file, const ExportCertificate& proof, Console& console) {
  console.say("wrote " + file + " (" + proof.format + "), read back and compared");
  for (const std::string& note : proof.notes) console.say("  note: " + note);
  console.emit(dump({{"phase", "written"},
                     {"file", file},
                     {"format", proof.format},
                     {"nodes", proof.read_back.nodes},
                     {"worst_difference", proof.worst_difference},
                     {"notes", proof.notes}}));
}

template <int D>
Result<MetricField<D>> metric_of(const SimplexMesh<D>& mesh, const std::string& sol,
                                 const std::string& name, MetricFunction<D>* function) {
  if (!sol.empty()) {
    Result<MetricField<D>> field = read_sol<D>(sol, mesh.node_count());
    if (!field) return of_input(field.error());
    return field;
  }
  if (name.empty()) return MetricField<D>{};
  Result<MetricFunction<D>> analytic = named_metric<D>(name);
  if (!analytic) return analytic.error();
  if (function) *function = *analytic;
  return sample_metric<D>(*analytic, mesh.points);
}

Json report_json(const CheckReport& r, bool with_metric) {
  const MeshReport& m = r.mesh;
  Json json = {{"phase", "check"},
               {"dimension", r.dimension},
               {"nodes", m.nodes},
               {"elements", m.elements},
               {"boundary_faces", m.faces_boundary},
               {"valid", m.valid()},
               {"conforming", m.conforming()},
               {"finding", m.first_finding},
               {"inverted", m.inverted},
               {"faces_of_more_than_two_elements", m.faces_shared},
               {"misoriented", m.misoriented},
               {"facets_missing", m.facets_missing},
               {"facets_extra", m.facets_extra},
               {"unused_nodes", m.unused},
               {"volume", m.volume},
               {"volume_by_boundary", m.volume_boundary},
               {"boundary_area", m.boundary_area},
               {"edges", r.edges},
               {"aspect_ratio", stats_json(r.aspect_ratio)}};
  if (!with_metric) return json;
  json["edge_length"] = stats_json(r.edge_length);
  json["unit_edges"] = r.unit_edges;
  json["mean_ratio"] = stats_json(r.mean_ratio);
  json["mean_ratio_mean_metric"] = stats_json(r.mean_ratio_mean);
  json["shape"] = stats_json(r.shape);
  json["quality"] = stats_json(r.quality);
  json["conformity"] = stats_json(r.conformity);
  json["conformity_invariant"] = stats_json(r.conformity_invariant);
  json["flat"] = r.flat;
  json["allocation"] = r.allocation;
  return json;
}

Json farthest_json(const FarthestPoint& point) {
  return {{"distance", point.distance},
          {"place", {point.place[0], point.place[1], point.place[2]}}};
}

template Result<MetricField<2>> metric_of(const SimplexMesh<2>&, const std::string&,
                                          const std::string&, MetricFunction<2>*);
template Result<MetricField<4>> metric_of(const SimplexMesh<4>&, const std::string&,
                                          const std::string&, MetricFunction<4>*);
template Result<MetricField<3>> metric_of(const SimplexMesh<3>&, const std::string&,
                                          const std::string&, MetricFunction<3>*);

Result<void> check_output_name(const std::string& output, int dimension) {
  if (Result<void> known = check_export_name(output); !known) return known.error();
  if (dimension != 3 && fs::path(output).extension() != ".mesh")
    return Error{Code::usage, "A " + std::to_string(dimension) + "D mesh is written as Medit only.",
                 "Use OUT.mesh."};
  return {};
}

template <int D>
Result<void> write_any(const std::string& output, SimplexMesh<D>&& mesh, MetricField<D>&& metric,
                       const Progress& progress) {
  if constexpr (D == 3) {
    MeshState state;
    state.mesh = std::move(mesh);
    state.metric = std::move(metric);
    if (!state.metric.empty()) state.quality = element_qualities<3>(state.mesh, state.metric);
    const auto proof = export_mesh(output, state, Study{}, {}, progress);
    if (!proof) return proof.error();
    return {};
  } else {
    if (Result<void> done = write_medit<D>(mesh, output, progress); !done || metric.empty())
      return done;
    return write_sol<D>(metric, fs::path(output).replace_extension(".sol"), progress);
  }
}
template Result<void> write_any(const std::string&, SimplexMesh<2>&&, MetricField<2>&&,
                                const Progress&);
template Result<void> write_any(const std::string&, SimplexMesh<3>&&, MetricField<3>&&,
                                const Progress&);
template Result<void> write_any(const std::string&, SimplexMesh<4>&&, MetricField<4>&&,
                                const Progress&);

}  // namespace lamella::cli
