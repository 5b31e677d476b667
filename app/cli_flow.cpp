#include <filesystem>

#include "app/cli_commands.h"
#include "app/cli_common.h"
#include "app/cli_groups.h"
#include "app/cli_text.h"
#include "app/services.h"
#include "core/flow/correction.h"
#include "core/flow/indicators.h"
#include "core/flow/stokes.h"
#include "core/io/mesh_file.h"
#include "core/io_vtk/vtu.h"
#include "core/study/measure.h"

namespace lamella::cli {

namespace {

namespace fs = std::filesystem;

const std::string kField = "field:";

/// Mesh, metric (may be empty) and fields at the nodes of a file.
struct Input {
  AnyMesh mesh;
  MetricField<3> metric;
  std::vector<NodeField> fields;
};

Result<Input> read_input(const std::string& file, const Progress& progress) {
  Input out;
  if (fs::path(file).extension() == ".vtu") {
    Result<MeshContent> content = (*mesh_formats().called("vtu"))->read(file, progress);
    if (!content) return content.error();
    if (Result<void> done = complete(*content, file); !done) return done.error();
    out = {std::move(content->mesh), std::move(content->metric), std::move(content->of_nodes)};
    return out;
  }
  Result<AnyMesh> mesh = read_any(file, &out.metric, progress);
  if (!mesh) return mesh.error();
  out.mesh = std::move(*mesh);
  return out;
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

/// The tensors (5.6), (5.7) of a field of the file.
template <int D>
Result<std::vector<Mat<D>>> tensors_of_field(const SimplexMesh<D>& mesh,
                                             const std::vector<NodeField>& fields,
                                             const FlowCommand& c) {
  const std::string name = c.correct.substr(kField.size());
  std::string known;
  for (const NodeField& field : fields) {
    known += (known.empty() ? "" : ", ") + field.name;
    if (field.name != name) continue;
    if (field.components == 1) return gradient_tensors<D>(mesh, field.values, c.threads);
    std::vector<Vec<D>> vectors(mesh.points.size());
    for (std::size_t n = 0; n < vectors.size(); ++n)
      for (int k = 0; k < D; ++k) vectors[n][k] = field.values[3 * n + static_cast<std::size_t>(k)];
    return gradient_tensors<D>(mesh, vectors, c.threads);
  }
  return Error{Code::usage, "The mesh file has no field \"" + name + "\" at its nodes.",
               known.empty() ? "Give a .vtu with the field." : "It has: " + known + "."};
}

template <int D>
Result<Corrected<D>> corrected(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                               const Fields<D>& fields, const std::vector<NodeField>& of_file,
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
  if (c.correct == "acceleration")
    return added(gradient_tensors<D>(mesh, fields.acceleration, c.threads));
  if (c.correct == "velocity")
    return added(gradient_tensors<D>(mesh, fields.flow.velocity, c.threads));
  if (c.correct == "strain") return added(strain_tensors<D>(mesh, fields.flow.velocity, c.threads));
  if (c.correct == "direction") return smoothed(fields.turning);
  if (c.correct == "residual") return smoothed(fields.residual);
  if (c.correct == "directional") return smoothed(fields.directional);
  const auto tensors = tensors_of_field<D>(mesh, of_file, c);
  if (!tensors) return tensors.error();
  return added(*tensors);
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
int solve_and_correct(const SimplexMesh<D>& whole, MetricField<D> metric,
                      std::vector<NodeField> of_file, const FlowCommand& c, Console& console) {
  const Progress progress = console.progress();
  std::vector<NodeId> old_id;
  SimplexMesh<D> part;
  if (!c.body.empty()) {
    Result<SimplexMesh<D>> found = body_of<D>(whole, c.body, old_id);
    if (!found) return console.fail(found.error());
    part = std::move(*found);
  }
  const SimplexMesh<D>& mesh = c.body.empty() ? whole : part;
  for (NodeField& field : of_file) {
    if (old_id.empty()) continue;
    const auto k = static_cast<std::size_t>(field.components);
    std::vector<double> kept;
    for (const NodeId n : old_id)
      for (std::size_t i = 0; i < k; ++i) kept.push_back(field.values[k * n + i]);
    field.values = std::move(kept);
  }

  const bool solving = !c.correct.starts_with(kField) || !c.gates.empty() || !c.rates.empty();
  Fields<D> fields;
  if (solving) {
    auto found = fields_of<D>(mesh, c, progress.portion(0, 0.8));
    if (!found) return console.fail(found.error());
    fields = std::move(*found);
    say_flow<D>(mesh, fields.flow, console);
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
    auto done = corrected<D>(mesh, local, fields, of_file, c, progress.portion(0.8, 0.95));
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
  const std::vector<std::string> methods = {"",          "acceleration", "velocity",   "strain",
                                            "direction", "residual",     "directional"};
  const bool field = c.correct.starts_with(kField);
  if (!field && std::find(methods.begin(), methods.end(), c.correct) == methods.end())
    return Error{Code::usage, "--correct knows no method \"" + c.correct + "\".",
                 "Use acceleration, velocity, strain, direction, residual, directional or "
                 "field:NAME."};
  if (!field && c.gates.empty() && c.rates.empty())
    return Error{Code::usage, "flow needs a gate.", "Give --gate or --gate-rate."};
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
  Result<Input> input = read_input(c.mesh, console.progress().portion(0, 0));
  if (!input) return console.fail(of_input(input.error()));
  if (const auto* mesh = std::get_if<SimplexMesh<3>>(&input->mesh))
    return solve_and_correct<3>(*mesh, std::move(input->metric), std::move(input->fields), c,
                                console);
  if (const auto* mesh = std::get_if<SimplexMesh<2>>(&input->mesh))
    return solve_and_correct<2>(*mesh, {}, {}, c, console);
  return console.fail(
      {Code::usage, "\"" + c.mesh + "\" is a 4D mesh.", "Flows are solved in 2D and 3D."});
}

}  // namespace lamella::cli
