#include <filesystem>

#include "app/cli_commands.h"
#include "app/cli_common.h"
#include "app/cli_groups.h"
#include "app/cli_text.h"
#include "app/services.h"
#include "core/flow/correction.h"
#include "core/flow/field_transfer.h"
#include "core/flow/indicators.h"
#include "core/flow/solver_field.h"
#include "core/flow/stokes.h"
#include "core/io/mesh_file.h"
#include "core/io/vtu.h"
#include "core/study/flow_entry.h"
#include "core/study/forecast.h"
#include "core/study/measure.h"

namespace lamella::cli {

namespace {

namespace fs = std::filesystem;

/// METHOD or METHOD:NAME of --correct.
struct Asked {
  std::string method, field;
};

Asked asked_of(const std::string& correct) {
  const std::size_t colon = correct.find(':');
  if (colon == std::string::npos) return {correct, {}};
  return {correct.substr(0, colon), correct.substr(colon + 1)};
}

/// A field of a solver's result at the nodes of `mesh`.
Result<NodeField> external_field(const SimplexMesh<3>& mesh, const FlowCommand& c,
                                 const Progress& progress, Console& console) {
  const std::string file = c.field_file.empty() ? c.mesh : c.field_file;
  Result<MeshContent> content = read_result(file, progress.portion(0, 0.3));
  if (!content) return of_input(content.error());
  Result<SolverField> found =
      solver_field(std::move(*content), asked_of(c.correct).field, unit_factor(c.field_unit), file);
  if (!found) return found.error();
  NodeField& field = found->field;
  Result<TransferredField> there = transfer_field(found->mesh, field.values, field.components, mesh,
                                                  c.threads, progress.portion(0.3, 1));
  if (!there) return there.error();
  if (there->outside > 0)
    console.say("note: " + grouped(there->outside) + " of " + grouped(mesh.node_count()) +
                " nodes lie outside the mesh of the field, up to " +
                short_number(there->farthest, 2) + " mm; the nearest place counts there");
  field.values = std::move(there->values);
  return std::move(field);
}

template <int D>
Result<FlowCase<D>> flow_case(const FlowCommand& c) {
  FlowCase<D> out;
  for (const std::string& text : c.gates) {
    auto gate = group_and_number(text, 1);
    if (!gate) return gate.error();
    out.gates.push_back({gate->first, gate->second, {}});
  }
  for (const std::string& text : c.rates) {
    auto gate = group_and_number(text, {});
    if (!gate) return gate.error();
    out.gates.push_back({gate->first, {}, gate->second});
  }
  out.vents = c.vents;
  out.symmetries = c.symmetries;
  out.viscosity = c.viscosity;
  return out;
}

/// What a flow gives to look at and to correct by.
template <int D>
struct Fields {
  Flow<D> flow;
  std::vector<double> acceleration;                           ///< [node]
  std::vector<double> shear, turning, residual, directional;  ///< [element]
};

template <int D>
Result<Fields<D>> fields_of(const SimplexMesh<D>& mesh, const FlowCommand& c,
                            const Progress& progress) {
  const Result<FlowCase<D>> flow = flow_case<D>(c);
  if (!flow) return flow.error();
  FlowSettings settings;
  settings.tolerance = c.tolerance;
  settings.threads = c.threads;
  auto solved = solve_stokes<D>(mesh, *flow, settings, progress.portion(0, 0.8));
  if (!solved) return solved.error();
  Fields<D> out;
  out.flow = std::move(*solved);
  const auto& v = out.flow.velocity;
  out.acceleration = acceleration_norm<D>(mesh, v, c.threads);
  out.shear = shear_rate<D>(mesh, v, c.threads);
  out.turning = direction_change<D>(mesh, v, c.threads);
  auto residual = residual_indicator<D>(mesh, v, out.flow.pressure, c.viscosity, c.threads,
                                        progress.portion(0.8, 0.9));
  if (!residual) return residual.error();
  auto directional = directional_indicator<D>(mesh, v, out.flow.pressure, c.viscosity, {},
                                              c.threads, progress.portion(0.9, 1));
  if (!directional) return directional.error();
  out.residual = std::move(*residual);
  out.directional = std::move(*directional);
  return out;
}

template <int D>
void say_flow(const SimplexMesh<D>& mesh, const Flow<D>& flow, Console& console) {
  double fastest = 0;
  for (const Vec<D>& v : flow.velocity) fastest = std::max(fastest, v.norm());
  console.say("flow: " + grouped(mesh.node_count()) + " nodes, " +
              std::to_string(flow.residuals.size() - 1) + " iterations, largest velocity " +
              short_number(fastest, 6) + " mm/s");
  Json openings = Json::array();
  const std::string unit = D == 2 ? " mm2/s " : " mm3/s ";
  for (const OpeningFlow& o : flow.openings) {
    console.say("  " + o.group + ": pressure " + short_number(o.pressure, 6) + " MPa, " +
                short_number(std::abs(o.rate), 8) + unit + (o.rate < 0 ? "in" : "out"));
    openings.push_back(
        {{"group", o.group}, {"pressure", o.pressure}, {"rate", o.rate}, {"area", o.area}});
  }
  console.say("mass balance: " + short_number(flow.imbalance, 2) + " of what enters is lost");
  console.emit(dump({{"phase", "flow"},
                     {"nodes", mesh.node_count()},
                     {"iterations", flow.residuals.size() - 1},
                     {"residual", flow.residuals.back()},
                     {"largest_velocity", fastest},
                     {"openings", std::move(openings)},
                     {"imbalance", flow.imbalance}}));
}

std::vector<Vec<3>> vectors_of(const NodeField& field) {
  std::vector<Vec<3>> out(field.values.size() / 3);
  for (std::size_t n = 0; n < out.size(); ++n)
    out[n] = Eigen::Map<const Vec<3>>(&field.values[3 * n]);
  return out;
}

template <int D>
Result<Corrected<D>> corrected(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                               const Fields<D>& fields, const NodeField& field,
                               const FlowCommand& c, const Progress& progress) {
  AddParams add;
  add.strength = c.strength;
  add.h_min = c.h_min;
  add.elements = c.elements;
  add.threads = c.threads;
  const auto added = [&](const std::vector<Mat<D>>& tensors) {
    return add_tensors<D>(mesh, metric, tensors, add, progress);
  };
  UniformizeParams even;
  even.beta = c.beta;
  even.h_min = c.h_min;
  even.elements = c.elements;
  even.threads = c.threads;
  const auto smoothed = [&](const std::vector<double>& indicator) {
    return uniformize<D>(mesh, metric, indicator, even, progress);
  };
  const std::string method = asked_of(c.correct).method;
  if (method == "residual") return smoothed(fields.residual);
  if (method == "directional") return smoothed(fields.directional);
  if constexpr (D == 3) {
    if (method == "indicator") {
      std::vector<double> mean(mesh.elements.size(), 0);
      for (std::size_t e = 0; e < mean.size(); ++e)
        for (const NodeId n : mesh.elements[e]) mean[e] += field.values[n] / (D + 1);
      return smoothed(mean);
    }
    if (method == "field" && field.components == 1)
      return added(gradient_tensors<D>(mesh, field.values, c.threads));
    if (!field.name.empty()) {
      const std::vector<Vec<D>> v = vectors_of(field);
      if (method == "field") return added(gradient_tensors<D>(mesh, v, c.threads));
      if (method == "strain") return added(strain_tensors<D>(mesh, v, c.threads));
      if (method == "combined") return added(combined_tensors<D>(mesh, v, c.threads));
      if (method == "direction") return smoothed(direction_change<D>(mesh, v, c.threads));
      return added(gradient_tensors<D>(mesh, acceleration_norm<D>(mesh, v, c.threads), c.threads));
    }
  }
  if (method == "acceleration")
    return added(gradient_tensors<D>(mesh, fields.acceleration, c.threads));
  if (method == "velocity")
    return added(gradient_tensors<D>(mesh, fields.flow.velocity, c.threads));
  if (method == "strain") return added(strain_tensors<D>(mesh, fields.flow.velocity, c.threads));
  if (method == "combined")
    return added(combined_tensors<D>(mesh, fields.flow.velocity, c.threads));
  return smoothed(fields.turning);
}

/// A planar mesh as triangles in space; in 3D the mesh itself.
template <int D>
SimplexMesh<3> in_space(const SimplexMesh<D>& mesh) {
  if constexpr (D == 3) {
    return mesh;
  } else {
    SimplexMesh<3> out;
    for (std::size_t n = 1; n < mesh.points.size(); ++n)
      out.points.emplace_back(mesh.points[n][0], mesh.points[n][1], 0);
    out.facets = mesh.elements;
    out.facet_group.assign(out.facets.size(), 0);
    out.facet_face.assign(out.facets.size(), 0);
    return out;
  }
}

template <int D>
Result<void> write_fields(const SimplexMesh<D>& mesh, const Fields<D>& fields,
                          const MetricField<D>& metric, const FlowCommand& c,
                          const Progress& progress) {
  MeshFields out;
  NodeField velocity{"velocity", 3, {}};
  for (const Vec<D>& v : fields.flow.velocity)
    for (int k = 0; k < 3; ++k) velocity.values.push_back(k < D ? v[k] : 0);
  out.of_nodes = {std::move(velocity),
                  {"pressure", 1, fields.flow.pressure},
                  {"acceleration", 1, fields.acceleration}};
  const auto add = [&](const char* name, const std::vector<double>& values) {
    if constexpr (D == 3)
      out.of_elements.push_back({name, values});
    else  // the triangles of a planar mesh are no elements of the file
      out.of_nodes.push_back({name, 1, nodal_means<D, double>(mesh, values, c.threads)});
  };
  add("shear_rate", fields.shear);
  add("direction_change", fields.turning);
  add("residual", fields.residual);
  add("residual_directional", fields.directional);
  if constexpr (D == 3)
    if (!metric.empty()) out.metric = &metric;
  return write_vtu(in_space<D>(mesh), out, c.output, progress);
}

/// One body of a mesh in space; the nodes of the whole that it has go to `old_id`.
template <int D>
Result<SimplexMesh<D>> body_of(const SimplexMesh<D>& mesh, const std::string& name,
                               std::vector<NodeId>& old_id) {
  const auto at = std::find(mesh.bodies.begin(), mesh.bodies.end(), name);
  if (at == mesh.bodies.end()) {
    std::string known;
    for (const std::string& body : mesh.bodies) known += (known.empty() ? "" : ", ") + body;
    return Error{Code::usage, "The mesh has no body \"" + name + "\".",
                 "Its bodies are: " + known + "."};
  }
  if constexpr (D == 3)
    return extract_body(mesh, static_cast<std::int32_t>(at - mesh.bodies.begin()), &old_id);
  else
    return Error{Code::usage, "--body needs a mesh of tetrahedra.", ""};
}

template <int D>
int solve_and_correct(const SimplexMesh<D>& whole, MetricField<D> metric, const FlowCommand& c,
                      Console& console) {
  const Progress progress = console.progress();
  std::vector<NodeId> old_id;
  SimplexMesh<D> part;
  if (!c.body.empty()) {
    Result<SimplexMesh<D>> found = body_of<D>(whole, c.body, old_id);
    if (!found) return console.fail(found.error());
    part = std::move(*found);
  }
  const SimplexMesh<D>& mesh = c.body.empty() ? whole : part;

  const Asked asked = asked_of(c.correct);
  if (Result<void> fits =
          within_memory("The flow through " + grouped(mesh.node_count()) + " nodes: about",
                        flow_memory(static_cast<double>(mesh.node_count())), c.memory,
                        "Allow more memory, solve in one --body alone, or take a coarser mesh.");
      !fits)
    return console.fail(fits.error());
  Fields<D> fields;
  if (asked.field.empty() || !c.gates.empty() || !c.rates.empty()) {
    auto found = fields_of<D>(mesh, c, progress.portion(0, 0.7));
    if (!found) return console.fail(found.error());
    fields = std::move(*found);
    say_flow<D>(mesh, fields.flow, console);
  }
  NodeField field;
  if (!asked.field.empty()) {
    if constexpr (D == 3) {
      Result<NodeField> found = external_field(mesh, c, progress.portion(0.7, 0.8), console);
      if (!found) return console.fail(found.error());
      field = std::move(*found);
      const bool scalar = field.components == 1;
      if (asked.method != "field" && scalar != (asked.method == "indicator"))
        return console.fail({Code::usage,
                             "\"" + field.name + "\" is a " + (scalar ? "number" : "vector") +
                                 ", which \"" + asked.method + "\" cannot use.",
                             "An indicator is a number; a velocity is a vector."});
    } else {
      return console.fail({Code::usage, "A field of a file needs a mesh of tetrahedra.", ""});
    }
  }

  MetricField<D> local;
  if (!c.correct.empty()) {
    if (!c.sol.empty()) {
      auto given = metric_of<D>(whole, c.sol, "", nullptr);
      if (!given) return console.fail(given.error());
      metric = std::move(*given);
    }
    if (metric.empty()) metric = own_metric<D>(whole, c.threads);
    local = metric;
    if (!old_id.empty()) {
      local.clear();
      for (const NodeId n : old_id) local.push_back(metric[n]);
    }
    auto done = corrected<D>(mesh, local, fields, field, c, progress.portion(0.8, 0.95));
    if (!done) return console.fail(done.error());
    console.say("corrected by " + c.correct + ": the metric asked for " +
                grouped(static_cast<std::size_t>(done->elements_before)) + " elements, now for " +
                grouped(static_cast<std::size_t>(done->elements_after)));
    console.emit(dump({{"phase", "correction"},
                       {"method", c.correct},
                       {"weight", done->weight},
                       {"elements_before", done->elements_before},
                       {"elements_after", done->elements_after}}));
    local = std::move(done->metric);
    if (old_id.empty())
      metric = local;
    else
      for (std::size_t n = 1; n < old_id.size(); ++n) metric[old_id[n]] = local[n];
    if (auto written = write_sol<D>(metric, c.correct_out, progress.portion(0.95, 0.96)); !written)
      return console.fail(written.error());
    console.say("wrote " + c.correct_out);
    console.emit(dump({{"phase", "written"}, {"file", c.correct_out}}));
  }
  if (!c.output.empty()) {
    if (auto written = write_fields<D>(mesh, fields, local, c, progress.portion(0.96, 1)); !written)
      return console.fail(written.error());
    console.say("wrote " + c.output);
    console.emit(dump({{"phase", "written"}, {"file", c.output}}));
  }
  return 0;
}

Result<void> check_usage(const FlowCommand& c) {
  const Asked asked = asked_of(c.correct);
  const bool field = c.correct.find(':') != std::string::npos;
  bool known = c.correct.empty();
  for (const char* name : {"field", "indicator", "acceleration", "strain", "combined", "direction"})
    known = known || (field && !asked.field.empty() && asked.method == name);
  for (const FlowMethod method : kFlowMethods)
    known = known || (!field && asked.method == flow_method_name(method));
  if (!known) {
    std::string names;
    for (const FlowMethod method : kFlowMethods)
      names += std::string(flow_method_name(method)) + ", ";
    return Error{Code::usage, "--correct knows no method \"" + c.correct + "\".",
                 "Use " + names +
                     "or of a field field:NAME, indicator:NAME, acceleration:NAME, strain:NAME, "
                     "combined:NAME or direction:NAME."};
  }
  if (!field && c.gates.empty() && c.rates.empty())
    return Error{Code::usage, "flow needs a gate.", "Give --gate or --gate-rate."};
  if (!field && !c.field_file.empty())
    return Error{Code::usage, "--field needs the name of a field.", "Use --correct field:NAME."};
  if (field && !c.output.empty() && c.gates.empty() && c.rates.empty())
    return Error{Code::usage, "Without a gate there is no flow to write.",
                 "Leave --output out, or give --gate."};
  if (!c.output.empty() && fs::path(c.output).extension() != ".vtu")
    return Error{Code::usage, "Fields of a flow are written as VTU only.", "Use OUT.vtu."};
  return {};
}

}  // namespace

int run_flow(const FlowCommand& c, Console& console) {
  if (Result<void> fine = check_usage(c); !fine) return console.fail(fine.error());
  MetricField<3> metric;
  const Result<AnyMesh> input = read_any(c.mesh, &metric, console.progress().portion(0, 0));
  if (!input) return console.fail(of_input(input.error()));
  if (const auto* mesh = std::get_if<SimplexMesh<3>>(&*input))
    return solve_and_correct<3>(*mesh, std::move(metric), c, console);
  if (const auto* mesh = std::get_if<SimplexMesh<2>>(&*input))
    return solve_and_correct<2>(*mesh, {}, c, console);
  return console.fail(
      {Code::usage, "\"" + c.mesh + "\" is a 4D mesh.", "Flows are solved in 2D and 3D."});
}

}  // namespace lamella::cli
