#include "core/study/measure.h"

#include <algorithm>

#include "core/mesh/adjacency.h"
#include "core/mesh/boundary.h"
#include "core/mesh/quality.h"

namespace lamella {

Result<IterationRecord> measure(MeshState& state, const Progress& progress) {
  const SimplexMesh<3>& mesh = state.mesh;
  IterationRecord record;
  record.nodes = mesh.node_count();
  record.elements = mesh.element_count();
  state.quality = element_qualities<3>(mesh, state.metric);
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.3);
  record.quality_min = state.quality.empty() ? 0 : 1;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    if (e % 65536 == 0 && progress.cancelled()) return cancelled_error();
    const auto corners = mesh.corners(mesh.elements[e]);
    record.volume += signed_measure<3>(corners);
    record.quality_min = std::min(record.quality_min, state.quality[e]);
    record.quality_mean += state.quality[e];
    record.conformity +=
        conformity<3>(corners, mean_metric<3>(state.metric, mesh.elements[e])).invariant;
  }
  const auto elements = static_cast<double>(std::max<std::size_t>(1, mesh.elements.size()));
  record.quality_mean /= elements;
  record.conformity /= elements;
  progress.report(0.7);

  const auto edges = unique_edges<3>(mesh.elements, mesh.points.size());
  if (progress.cancelled()) return cancelled_error();
  std::size_t unit = 0;
  for (const auto& [a, b] : edges)
    unit += is_unit_length(
        edge_length<3>(Vec<3>(mesh.points[b] - mesh.points[a]), state.metric[a], state.metric[b]));
  record.unit_edges =
      static_cast<double>(unit) / static_cast<double>(std::max<std::size_t>(1, edges.size()));
  progress.report(1);
  return record;
}

SimplexMesh<3> extract_body(const SimplexMesh<3>& mesh, std::int32_t body,
                            std::vector<NodeId>* old_id) {
  SimplexMesh<3> part;
  part.points = mesh.points;
  part.bodies = {mesh.bodies.at(static_cast<std::size_t>(body))};
  part.groups = mesh.groups;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    if (mesh.element_body[e] == body) part.elements.push_back(mesh.elements[e]);
  part.element_body.assign(part.elements.size(), 0);
  // Facets of other bodies are no boundary of these elements: rebuilding drops them, and adds those
  // towards a neighbor body.
  part.facets = mesh.facets;
  part.facet_group = mesh.facet_group;
  part.facet_face = mesh.facet_face;
  rebuild_facets<3>(part);
  const std::vector<NodeId> new_id = compact_nodes<3>(part);
  if (old_id) {
    old_id->assign(part.points.size(), 0);
    for (std::size_t v = 1; v < new_id.size(); ++v)
      if (new_id[v] > 0) (*old_id)[static_cast<std::size_t>(new_id[v])] = static_cast<NodeId>(v);
  }
  return part;
}

ReferenceSurface<3> boundary_surface(const SimplexMesh<3>& mesh, std::int32_t body) {
  return surface_of_facets(extract_body(mesh, body));
}

}  // namespace lamella
