#include "core/mesh/interfaces.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/mesh/adjacency.h"
#include "core/mesh/boundary.h"

namespace lamella {

template <int D>
WithInterfaces<D> list_interfaces(const SimplexMesh<D>& mesh) {
  WithInterfaces<D> out{mesh, mesh.facets.size(), mesh.facets.size()};
  const auto& body = mesh.element_body;
  if (std::adjacent_find(body.begin(), body.end(), std::not_equal_to<>()) == body.end()) return out;
  using Facet = typename SimplexMesh<D>::Facet;
  SimplexMesh<D>& all = out.mesh;
  std::vector<Facet> inner;  // outward from the body of lower id
  std::vector<std::array<std::int32_t, 2>> sides;
  std::vector<std::pair<Facet, std::size_t>> sorted;  // ascending nodes, index
  const auto uses = face_uses<D>(mesh.elements, mesh.points.size());
  for_each_face<D>(uses, [&](std::size_t first, std::size_t last) {
    if (last - first != 2) return;
    const FaceUse<D>* low = &uses[first];
    const FaceUse<D>* high = &uses[first + 1];
    if (body[low->element] == body[high->element]) return;
    if (body[low->element] > body[high->element]) std::swap(low, high);
    sorted.emplace_back(low->nodes, inner.size());
    inner.push_back(opposite_facet<D>(mesh.elements[low->element], low->local));
    sides.push_back({body[low->element], body[high->element]});
  });

  std::vector<std::size_t> listed(inner.size(), mesh.facets.size());  // [inner] its facet
  std::vector<char> is_outer(mesh.facets.size(), 1);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    Facet nodes = mesh.facets[f];
    std::sort(nodes.begin(), nodes.end());
    const auto it =
        std::lower_bound(sorted.begin(), sorted.end(), std::pair{nodes, std::size_t{0}});
    if (it == sorted.end() || it->first != nodes) continue;
    is_outer[f] = 0;
    listed[it->second] = f;
  }
  std::set<std::int32_t> taken(mesh.facet_face.begin(), mesh.facet_face.end());
  taken.insert(-1);
  // A number above all others, or the least that is free where a file has used the largest.
  const auto new_face = [&taken] {
    std::int32_t face = *taken.rbegin();
    if (face < std::numeric_limits<std::int32_t>::max())
      ++face;
    else
      for (face = 0; taken.count(face) > 0;) ++face;
    taken.insert(face);
    return face;
  };
  all.facets.clear();
  all.facet_group.clear();
  all.facet_face.clear();
  const auto add = [&all](const Facet& nodes, std::int32_t group, std::int32_t face) {
    all.facets.push_back(nodes);
    all.facet_group.push_back(group);
    all.facet_face.push_back(face);
  };
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    if (is_outer[f]) add(mesh.facets[f], mesh.facet_group[f], mesh.facet_face[f]);
  out.outer = all.facets.size();
  for (std::size_t i = 0; i < inner.size(); ++i)
    if (const std::size_t f = listed[i]; f < mesh.facets.size())
      add(inner[i], mesh.facet_group[f], mesh.facet_face[f]);
  out.given = all.facets.size();
  std::map<std::array<std::int32_t, 2>, std::array<std::int32_t, 2>> pairs;  // group and face
  for (std::size_t i = 0; i < inner.size(); ++i) {
    if (listed[i] < mesh.facets.size()) continue;
    const auto [it, added] = pairs.try_emplace(sides[i]);
    if (added) {
      it->second = {static_cast<std::int32_t>(all.groups.size()), new_face()};
      all.groups.push_back(mesh.bodies[sides[i][0]] + "|" + mesh.bodies[sides[i][1]]);
    }
    add(inner[i], it->second[0], it->second[1]);
  }
  return out;
}

template <int D>
void rebuild_with_interfaces(SimplexMesh<D>& mesh) {
  const auto [listed, outer, given] = list_interfaces(mesh);
  rebuild_facets(mesh);
  for (std::size_t f = outer; f < given; ++f) {
    mesh.facets.push_back(listed.facets[f]);
    mesh.facet_group.push_back(listed.facet_group[f]);
    mesh.facet_face.push_back(listed.facet_face[f]);
  }
}

template <int D>
SimplexMesh<D> drop_body(const SimplexMesh<D>& mesh, std::int32_t body,
                         std::vector<NodeId>* new_id) {
  SimplexMesh<D> rest = mesh;
  rest.elements.clear();
  rest.element_body.clear();
  rest.bodies.erase(rest.bodies.begin() + body);
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const std::int32_t b = mesh.element_body[e];
    if (b == body) continue;
    rest.elements.push_back(mesh.elements[e]);
    rest.element_body.push_back(b > body ? b - 1 : b);
  }
  rebuild_with_interfaces(rest);
  std::vector<NodeId> ids = compact_nodes(rest);
  if (new_id) *new_id = std::move(ids);
  return rest;
}

template <int D>
std::vector<typename SimplexMesh<D>::Facet> blocking_faces(const SimplexMesh<D>& mesh) {
  const auto uses = face_uses<D>(mesh.elements, mesh.points.size());
  const auto wall = [&](std::size_t first, std::size_t last) {
    return last - first != 2 ||
           mesh.element_body[uses[first].element] != mesh.element_body[uses[first + 1].element];
  };
  std::vector<char> on_wall(mesh.points.size(), 0);
  for_each_face<D>(uses, [&](std::size_t first, std::size_t last) {
    if (wall(first, last))
      for (NodeId n : uses[first].nodes) on_wall[n] = 1;
  });
  std::vector<typename SimplexMesh<D>::Facet> found;
  for_each_face<D>(uses, [&](std::size_t first, std::size_t last) {
    const auto& nodes = uses[first].nodes;
    if (!wall(first, last) &&
        std::all_of(nodes.begin(), nodes.end(), [&](NodeId n) { return on_wall[n] != 0; }))
      found.push_back(nodes);
  });
  return found;
}

#define LAMELLA_INSTANTIATE(D)                                                                     \
  template WithInterfaces<D> list_interfaces<D>(const SimplexMesh<D>&);                            \
  template void rebuild_with_interfaces<D>(SimplexMesh<D>&);                                       \
  template SimplexMesh<D> drop_body<D>(const SimplexMesh<D>&, std::int32_t, std::vector<NodeId>*); \
  template std::vector<SimplexMesh<D>::Facet> blocking_faces<D>(const SimplexMesh<D>&);
LAMELLA_INSTANTIATE(2)
LAMELLA_INSTANTIATE(3)
LAMELLA_INSTANTIATE(4)
#undef LAMELLA_INSTANTIATE

}  // namespace lamella
