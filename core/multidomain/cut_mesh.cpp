#include "core/multidomain/cut_mesh.h"

#include <algorithm>
#include <map>

#include "core/base/parallel.h"
#include "core/mesh/adjacency.h"

namespace lamella {
namespace {

/// Where several borders meet, elements with all nodes on them may be claimed by none of the
/// regions there: such islands go to the neighbors with whom they share most.
bool give_slivers_away(const std::vector<FaceUse<3>>& uses, SimplexMesh<3>& mesh,
                       const Partition<3>& partition, int threads, const Progress& progress) {
  std::vector<std::array<std::int32_t, 4>> beside(mesh.elements.size(), {-1, -1, -1, -1});
  for_each_face<3>(uses, [&](std::size_t first, std::size_t last) {
    if (last - first != 2) return;
    beside[uses[first].element][uses[first].local] = uses[first + 1].element;
    beside[uses[first + 1].element][uses[first + 1].local] = uses[first].element;
  });
  std::vector<char> lost(mesh.elements.size());
  if (!parallel_each(lost.size(), threads, progress, [&](std::size_t e) {
        const Corners<3> p = mesh.corners(mesh.elements[e]);
        lost[e] = partition.region_of((p[0] + p[1] + p[2] + p[3]) / 4) != mesh.element_body[e];
      }))
    return false;
  // What hangs on to its own region was counted to it on purpose.
  std::vector<std::int32_t> front;
  for (std::size_t e = 0; e < lost.size(); ++e)
    if (!lost[e]) front.push_back(static_cast<std::int32_t>(e));
  while (!front.empty()) {
    const std::int32_t e = front.back();
    front.pop_back();
    for (const std::int32_t next : beside[e])
      if (next >= 0 && lost[next] && mesh.element_body[next] == mesh.element_body[e]) {
        lost[next] = 0;
        front.push_back(next);
      }
  }
  for (bool any = true; any;) {
    any = false;
    for (std::size_t e = 0; e < lost.size(); ++e) {
      if (!lost[e]) continue;
      std::map<std::int32_t, double> shared;
      for (int k = 0; k < 4; ++k)
        if (beside[e][k] >= 0 && !lost[beside[e][k]])
          shared[mesh.element_body[beside[e][k]]] +=
              facet_normal<3>(mesh.corners(opposite_facet<3>(mesh.elements[e], k))).norm();
      if (shared.empty()) continue;
      mesh.element_body[e] = std::max_element(shared.begin(), shared.end(), [](auto& a, auto& b) {
                               return a.second < b.second;
                             })->first;
      lost[e] = 0;
      any = true;
    }
  }
  return true;
}

/// The faces between regions, once slivers of a third one between them are gone.
bool add_interfaces(SimplexMesh<3>& mesh, const Partition<3>& partition, int threads,
                    const Progress& progress) {
  const auto uses = face_uses<3>(mesh.elements, mesh.points.size());
  if (!give_slivers_away(uses, mesh, partition, threads, progress)) return false;
  for_each_face<3>(uses, [&](std::size_t first, std::size_t last) {
    if (last - first != 2) return;
    const FaceUse<3>*low = &uses[first], *high = &uses[first + 1];
    if (mesh.element_body[low->element] == mesh.element_body[high->element]) return;
    if (mesh.element_body[low->element] > mesh.element_body[high->element]) std::swap(low, high);
    mesh.facets.push_back(opposite_facet<3>(mesh.elements[low->element], low->local));
    mesh.facet_group.push_back(0);
    mesh.facet_face.push_back(0);
  });
  return true;
}

}  // namespace

std::optional<CutMesh> mesh_of_cut(const CutTopology& cut, const SimplexMesh<3>& original,
                                   const Partition<3>& partition, int threads,
                                   const Progress& progress) {
  CutMesh out;
  SimplexMesh<3>& mesh = out.mesh;
  mesh.points = cut.topo.points;
  mesh.bodies = partition.names();
  mesh.groups = original.groups;
  out.metric.push_back(Metric<3>::Identity());
  for (std::size_t n = 1; n < cut.metric.size(); ++n) out.metric.push_back(cut.metric[n].full());
  for (std::int32_t e = 0; e < cut.count(); ++e) {
    if (!cut.topo.alive(e)) continue;
    if (!cut.topo.is_virtual(e)) {
      mesh.elements.push_back(cut.topo.elements[e]);
      mesh.element_body.push_back(cut.topo.label[e]);
    } else if (cut.is_wall(e)) {
      const auto f = static_cast<std::size_t>(cut.topo.label[e]);
      mesh.facets.push_back(Topology<3>::facet_of(cut.topo.elements[e]));
      mesh.facet_group.push_back(original.facet_group[f]);
      mesh.facet_face.push_back(original.facet_face[f]);
    }
  }
  out.outer = mesh.facets.size();
  if (!add_interfaces(mesh, partition, threads, progress)) return std::nullopt;
  out.features.assign(cut.features.begin(), cut.features.end());
  out.snapped = cut.moves;
  out.added = mesh.node_count() - original.node_count();
  return out;
}

}  // namespace lamella
