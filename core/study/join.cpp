#include "core/study/join.h"

#include <algorithm>

namespace lamella {

namespace {

/// The facets from number `first` on, whose faces are those of a grouped surface, get their groups
/// and the faces of the part.
void put_in_groups(const FaceGroups& of, const std::string& walls, std::size_t first,
                   SimplexMesh<3>& mesh) {
  for (std::size_t f = first; f < mesh.facet_face.size(); ++f) {
    const auto face = static_cast<std::size_t>(mesh.facet_face[f]);
    const std::int32_t group = of.face_group[face];
    mesh.facet_group.push_back(
        group_called(group < 0 ? walls : of.names[static_cast<std::size_t>(group)], mesh.groups));
    mesh.facet_face[f] = of.cad_face[face];
  }
}

/// The fields of all bodies, zero in those without a flow; null when none has one.
std::shared_ptr<const FlowFields> join_flows(const std::vector<const MeshState*>& bodies) {
  std::shared_ptr<FlowFields> all;
  for (const MeshState* body : bodies)
    if (body->flow && !all) all = std::make_shared<FlowFields>();
  if (!all) return all;
  all->resize(1, 0);
  for (const MeshState* body : bodies) {
    if (body->flow)
      all->append(*body->flow);
    else
      all->resize(all->pressure.size() + body->mesh.node_count(),
                  all->shear.size() + body->mesh.elements.size());
  }
  return all;
}

}  // namespace

std::int32_t group_called(const std::string& name, std::vector<std::string>& groups) {
  auto it = std::find(groups.begin(), groups.end(), name);
  if (it == groups.end()) it = groups.insert(it, name);
  return static_cast<std::int32_t>(it - groups.begin());
}

std::shared_ptr<const MeshState> join(const std::vector<const MeshState*>& bodies,
                                      const std::vector<std::string>& names,
                                      const std::vector<const FaceGroups*>& groups) {
  auto joined = std::make_shared<MeshState>();
  SimplexMesh<3>& mesh = joined->mesh;
  mesh.bodies = names;
  mesh.groups.clear();
  joined->metric.push_back(Metric<3>::Identity());
  joined->thickness.push_back(0);
  joined->layers.push_back(0);
  const auto append = [](auto& to, const auto& from, std::size_t skip) {
    if (from.size() > skip)
      to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(skip), from.end());
  };
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const MeshState& body = *bodies[b];
    const auto shift = static_cast<NodeId>(mesh.points.size()) - 1;
    const auto id = static_cast<std::int32_t>(b);
    append(mesh.points, body.mesh.points, 1);
    for (auto element : body.mesh.elements) {
      for (NodeId& v : element) v += shift;
      mesh.elements.push_back(element);
    }
    for (auto facet : body.mesh.facets) {
      for (NodeId& v : facet) v += shift;
      mesh.facets.push_back(facet);
    }
    mesh.element_body.resize(mesh.elements.size(), id);
    const std::size_t first_facet = mesh.facet_face.size();
    append(mesh.facet_face, body.mesh.facet_face, 0);
    const std::string walls = bodies.size() == 1 ? "walls" : names[b] + " walls";
    if (!groups.empty() && groups[b])
      put_in_groups(*groups[b], walls, first_facet, mesh);
    else
      mesh.facet_group.resize(mesh.facets.size(), group_called(walls, mesh.groups));
    append(joined->metric, body.metric, 1);
    append(joined->thickness, body.thickness, 1);
    append(joined->layers, body.layers, 1);
    append(joined->quality, body.quality, 0);
    append(joined->below, body.below, 0);
  }
  joined->flow = join_flows(bodies);
  return joined;
}

LayerStats join(const std::vector<const LayerStats*>& layers) {
  LayerStats all;
  bool first = true;
  for (const LayerStats* of : layers) {
    if (of->places == 0) continue;
    const auto p = static_cast<double>(of->places);
    all.places += of->places;
    all.mean += p * of->mean;
    all.share_reached += p * of->share_reached;
    all.p5 = first ? of->p5 : std::min(all.p5, of->p5);
    all.p50 = first ? of->p50 : std::min(all.p50, of->p50);
    all.p95 = std::max(all.p95, of->p95);
    first = false;
  }
  if (all.places == 0) return all;
  all.mean /= static_cast<double>(all.places);
  all.share_reached /= static_cast<double>(all.places);
  return all;
}

IterationRecord join(const std::vector<const IterationRecord*>& records) {
  if (records.size() == 1) return *records.front();
  IterationRecord all;
  all.quality_min = 1;
  double elements = 0;
  std::vector<const LayerStats*> layers;
  for (const IterationRecord* r : records) {
    const auto e = static_cast<double>(r->elements);
    all.iteration = std::max(all.iteration, r->iteration);
    all.nodes += r->nodes;
    all.elements += r->elements;
    all.volume += r->volume;
    all.quality_min = std::min(all.quality_min, r->quality_min);
    all.quality_mean += e * r->quality_mean;
    all.conformity += e * r->conformity;
    all.unit_edges += e * r->unit_edges;
    all.seconds += r->seconds;
    all.forecast_nodes += r->forecast_nodes;
    all.flow_rate += r->flow_rate;
    all.flow_pressure = std::max(all.flow_pressure, r->flow_pressure);
    all.forecast_memory = std::max(all.forecast_memory, r->forecast_memory);
    all.layers_by_nodes += static_cast<double>(r->nodes) * r->layers_by_nodes;
    elements += e;
    layers.push_back(&r->layers);
  }
  if (all.nodes > 0) all.layers_by_nodes /= static_cast<double>(all.nodes);
  for (double* mean : {&all.quality_mean, &all.conformity, &all.unit_edges})
    *mean = elements > 0 ? *mean / elements : 0;
  all.layers = join(layers);
  return all;
}

}  // namespace lamella
