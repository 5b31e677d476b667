#include "core/mesh/boundary.h"

#include <algorithm>
#include <numeric>

#include "core/mesh/adjacency.h"

namespace lamella {

template <int D>
std::vector<BoundaryFace<D>> boundary_faces(
    const std::vector<typename SimplexMesh<D>::Element>& elements, std::size_t node_slots) {
  const auto uses = face_uses<D>(elements, node_slots);
  std::vector<std::size_t> single;
  for_each_face<D>(uses, [&](std::size_t i, std::size_t j) {
    if (j - i == 1) single.push_back(i);
  });
  std::sort(single.begin(), single.end(), [&](std::size_t a, std::size_t b) {
    return uses[a].element != uses[b].element ? uses[a].element < uses[b].element
                                              : uses[a].local < uses[b].local;
  });
  std::vector<BoundaryFace<D>> faces(single.size());
  for (std::size_t i = 0; i < single.size(); ++i) {
    const FaceUse<D>& u = uses[single[i]];
    faces[i] = {opposite_facet<D>(elements[u.element], u.local), u.element};
  }
  return faces;
}

template <int D>
void rebuild_facets(SimplexMesh<D>& mesh) {
  struct Old {
    typename SimplexMesh<D>::Facet nodes;
    std::int32_t group, face;
  };
  std::vector<Old> old(mesh.facets.size());
  for (std::size_t i = 0; i < old.size(); ++i) {
    old[i] = {mesh.facets[i], mesh.facet_group[i], mesh.facet_face[i]};
    std::sort(old[i].nodes.begin(), old[i].nodes.end());
  }
  const auto less = [](const Old& a, const Old& b) { return a.nodes < b.nodes; };
  std::stable_sort(old.begin(), old.end(), less);

  const auto faces = boundary_faces<D>(mesh.elements, mesh.points.size());
  mesh.facets.resize(faces.size());
  mesh.facet_group.assign(faces.size(), 0);
  mesh.facet_face.assign(faces.size(), 0);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    mesh.facets[i] = faces[i].facet;
    Old key{faces[i].facet, 0, 0};
    std::sort(key.nodes.begin(), key.nodes.end());
    const auto it = std::lower_bound(old.begin(), old.end(), key, less);
    if (it == old.end() || it->nodes != key.nodes) continue;
    mesh.facet_group[i] = it->group;
    mesh.facet_face[i] = it->face;
  }
}

ReferenceSurface<3> surface_of_facets(const SimplexMesh<3>& mesh,
                                      const std::vector<std::size_t>& facets) {
  ReferenceSurface<3> surface;
  std::vector<std::int32_t> vertex(mesh.points.size(), -1);
  std::int32_t faces = 0;
  for (const std::size_t f : facets) {
    std::array<std::int32_t, 3> facet{};
    for (int k = 0; k < 3; ++k) {
      std::int32_t& v = vertex[mesh.facets[f][k]];
      if (v < 0) {
        v = static_cast<std::int32_t>(surface.points.size());
        surface.points.push_back(mesh.points[mesh.facets[f][k]]);
      }
      facet[k] = v;
    }
    surface.facets.push_back(facet);
    surface.facet_face.push_back(std::max(0, mesh.facet_face[f]));
    faces = std::max(faces, surface.facet_face.back() + 1);
  }
  surface.faces.resize(static_cast<std::size_t>(faces));
  return surface;
}

ReferenceSurface<3> surface_of_facets(const SimplexMesh<3>& mesh) {
  std::vector<std::size_t> all(mesh.facets.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return surface_of_facets(mesh, all);
}

template <int D>
std::vector<NodeId> compact_nodes(SimplexMesh<D>& mesh) {
  std::vector<NodeId> new_id(mesh.points.size(), -1);
  new_id[0] = 0;
  for (const auto& e : mesh.elements)
    for (const NodeId v : e) new_id[v] = 0;
  NodeId count = 1;
  for (std::size_t i = 1; i < new_id.size(); ++i)
    if (new_id[i] == 0) new_id[i] = count++;
  compact_field(new_id, mesh.points);
  for (auto& e : mesh.elements)
    for (NodeId& v : e) v = new_id[v];
  // A facet may still name a removed node only if it is no boundary; such a facet goes.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.facets.size(); ++i) {
    auto f = mesh.facets[i];
    for (NodeId& v : f) v = new_id[v];
    if (std::find(f.begin(), f.end(), -1) != f.end()) continue;
    mesh.facets[kept] = f;
    mesh.facet_group[kept] = mesh.facet_group[i];
    mesh.facet_face[kept++] = mesh.facet_face[i];
  }
  mesh.facets.resize(kept);
  mesh.facet_group.resize(kept);
  mesh.facet_face.resize(kept);
  return new_id;
}

template std::vector<BoundaryFace<2>> boundary_faces<2>(const std::vector<std::array<NodeId, 3>>&,
                                                        std::size_t);
template std::vector<BoundaryFace<3>> boundary_faces<3>(const std::vector<std::array<NodeId, 4>>&,
                                                        std::size_t);
template std::vector<BoundaryFace<4>> boundary_faces<4>(const std::vector<std::array<NodeId, 5>>&,
                                                        std::size_t);
template void rebuild_facets<2>(SimplexMesh<2>&);
template void rebuild_facets<3>(SimplexMesh<3>&);
template void rebuild_facets<4>(SimplexMesh<4>&);
template std::vector<NodeId> compact_nodes<2>(SimplexMesh<2>&);
template std::vector<NodeId> compact_nodes<3>(SimplexMesh<3>&);
template std::vector<NodeId> compact_nodes<4>(SimplexMesh<4>&);

}  // namespace lamella
