#include "core/study/flow_of_mesh.h"

#include <algorithm>

#include "core/geometry/triangles.h"
#include "core/study/join.h"
#include "core/study/measure.h"

namespace lamella {

namespace {

/// Facets on CAD faces that a group of the study covers wholly get its name, and those on faces
/// that no group covers any more become walls.
void name_groups(const Study& study, const Part& part, SimplexMesh<3>& mesh) {
  const ReferenceSurface<3>& surface = part.surface;
  constexpr std::int32_t in_part = -2;
  std::vector<std::int32_t> group_of(surface.faces.size(), -1);
  for (const BoundaryGroup& group : groups_of(study, part.name)) {
    const Result<std::vector<std::int32_t>> facets = facets_of(group, surface);
    if (!facets) continue;  // it has no faces yet
    std::vector<std::size_t> covered(surface.faces.size(), 0);
    for (const std::int32_t f : *facets) ++covered[static_cast<std::size_t>(surface.facet_face[f])];
    std::vector<std::size_t> all(surface.faces.size(), 0);
    for (const std::int32_t face : surface.facet_face) ++all[static_cast<std::size_t>(face)];
    for (std::size_t face = 0; face < all.size(); ++face)
      if (covered[face] > 0 && group_of[face] == -1)
        group_of[face] =
            covered[face] == all[face] ? group_called(group.name, mesh.groups) : in_part;
  }
  const std::int32_t walls = group_called("walls", mesh.groups);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const auto face = static_cast<std::size_t>(mesh.facet_face[f]);
    if (face >= group_of.size() || group_of[face] == in_part) continue;
    mesh.facet_group[f] = group_of[face] >= 0 ? group_of[face] : walls;
  }
}

/// Groups of the mesh whose names say what they are.
FlowCase<3> case_by_names(const SimplexMesh<3>& mesh) {
  FlowCase<3> flow;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    if (std::find(mesh.facet_group.begin(), mesh.facet_group.end(), static_cast<std::int32_t>(g)) ==
        mesh.facet_group.end())
      continue;
    const std::string& name = mesh.groups[g];
    const GroupKind kind = group_kind_of(name);
    if (kind == GroupKind::gate) flow.gates.push_back({name, 1.0, {}});
    if (kind == GroupKind::vent) flow.vents.push_back(name);
    if (kind == GroupKind::symmetry) flow.symmetries.push_back(name);
  }
  return flow;
}

std::vector<std::size_t> elements_of(const SimplexMesh<3>& mesh, std::size_t body) {
  std::vector<std::size_t> elements;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    if (mesh.element_body[e] == static_cast<std::int32_t>(body)) elements.push_back(e);
  return elements;
}

/// The field of another solver on the bodies that it lies on.
Result<FlowFields> field_on_bodies(const SimplexMesh<3>& mesh, const Study& study,
                                   const SolverField* field, const Progress& progress) {
  if (!field) return Error{Code::usage, "The solver's field was not read.", "Name its file again."};
  FlowFields all;
  all.resize(mesh.points.size(), mesh.elements.size());
  std::optional<Error> why;
  const auto count = static_cast<double>(mesh.bodies.size());
  for (std::size_t b = 0; b < mesh.bodies.size(); ++b) {
    const auto at = static_cast<double>(b);
    std::vector<NodeId> node;
    const SimplexMesh<3> body = extract_body(mesh, static_cast<std::int32_t>(b), &node);
    if (body.elements.empty()) continue;
    const Result<FlowFields> found =
        field_on(body, *field, study.flow->method, diagonal_of_nodes(mesh), study.options.threads,
                 progress.portion(at / count, (at + 1) / count, "field"));
    if (!found && found.error().code == Code::cancelled) return found;
    if (found)
      all.put(*found, node, elements_of(mesh, b));
    else if (!why)
      why = found.error();
  }
  if (all.components == 0 && why) return *why;
  progress.report(1);
  return all;
}

}  // namespace

Result<FlowFields> flow_of_mesh(const MeshState& state, const Study& study,
                                const std::vector<Part>& parts, const Progress& progress,
                                const SolverField* field) {
  if (study.flow && study.flow->field) return field_on_bodies(state.mesh, study, field, progress);
  const SimplexMesh<3>& mesh = state.mesh;
  const FlowMethod method = study.flow.value_or(StudyFlow{}).method;
  FlowFields all;
  all.resize(mesh.points.size(), mesh.elements.size());
  const auto count = static_cast<double>(mesh.bodies.size());
  for (std::size_t b = 0; b < mesh.bodies.size(); ++b) {
    const auto at = static_cast<double>(b);
    const std::string& name = mesh.bodies[b];
    std::vector<NodeId> node;
    SimplexMesh<3> body = extract_body(mesh, static_cast<std::int32_t>(b), &node);
    FlowCase<3> flow = flow_case_of(study, name);
    for (const Part& part : parts)
      if (part.name == name) name_groups(study, part, body);
    if (study.groups.empty()) {
      const double viscosity = flow.viscosity;
      flow = case_by_names(body);
      flow.viscosity = viscosity;
    }
    if (flow.gates.empty() || body.elements.empty()) continue;
    const Result<FlowFields> found =
        flow_through(body, flow, method, study.options.threads,
                     progress.portion(at / count, (at + 1) / count, "flow"));
    if (!found) return found.error();
    all.put(*found, node, elements_of(mesh, b));
  }
  if (all.openings.empty())
    return Error{Code::usage, "There is no gate, through which the fluid would enter.",
                 "Make one group of faces a gate, and another one a vent."};
  progress.report(1);
  return all;
}

Result<FlowPreview> preview_flow(const MeshState& state, const Study& study,
                                 const Progress& progress) {
  const SimplexMesh<3>& mesh = state.mesh;
  const StudyFlow asked = study.flow.value_or(StudyFlow{});
  if (!state.flow || !is_of(*state.flow, asked) || state.metric.size() != mesh.points.size())
    return Error{Code::usage, "The mesh has no flow, or no metric to correct.",
                 "Solve the flow first."};
  FlowPreview out;
  const auto count = static_cast<double>(mesh.bodies.size());
  for (std::size_t b = 0; b < mesh.bodies.size(); ++b) {
    std::vector<NodeId> node;
    const SimplexMesh<3> body = extract_body(mesh, static_cast<std::int32_t>(b), &node);
    const BodySettings settings = settings_of(study, mesh.bodies[b]);
    if (body.elements.empty() || !settings.flow) continue;
    const FlowFields flow = state.flow->of(node, elements_of(mesh, b));
    // Where nothing flows, or the field does not lie.
    if (!(flow.mean_indicator() > 0)) continue;
    MetricField<3> metric;
    for (const NodeId n : node) metric.push_back(state.metric[n]);
    const double h_min =
        flow_h_min(study, settings.h_min.value_or(1e-3 * diagonal_of(body.points)));
    const auto at = static_cast<double>(b);
    const Result<FlowCorrection> made =
        flow_correction(body, metric, flow, asked, {}, h_min, study.options.threads,
                        progress.portion(at / count, (at + 1) / count));
    if (!made) return made.error();
    const auto nodes = static_cast<double>(body.node_count());
    out.elements_before += made->elements_before;
    out.elements_after += made->elements_after;
    out.nodes_before += nodes;
    out.nodes_after += nodes * made->elements_after / made->elements_before;
  }
  return out;
}

}  // namespace lamella
