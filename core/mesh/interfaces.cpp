#include "core/mesh/interfaces.h"

#include <algorithm>
#include <map>

#include "core/mesh/adjacency.h"

namespace lamella {

template <int D>
SimplexMesh<D> with_interfaces(const SimplexMesh<D>& mesh) {
  SimplexMesh<D> out = mesh;
  const auto& body = mesh.element_body;
  if (std::adjacent_find(body.begin(), body.end(), std::not_equal_to<>()) == body.end()) return out;
  std::int32_t faces = 0;
  for (std::int32_t f : mesh.facet_face) faces = std::max(faces, f + 1);
  std::map<std::array<std::int32_t, 2>, std::int32_t> pairs;
  const auto uses = face_uses<D>(mesh.elements, mesh.points.size());
  for_each_face<D>(uses, [&](std::size_t first, std::size_t last) {
    if (last - first != 2) return;
    const FaceUse<D>* low = &uses[first];
    const FaceUse<D>* high = &uses[first + 1];
    if (body[low->element] == body[high->element]) return;
    if (body[low->element] > body[high->element]) std::swap(low, high);
    const std::array<std::int32_t, 2> pair{body[low->element], body[high->element]};
    const auto [it, added] = pairs.try_emplace(pair, static_cast<std::int32_t>(pairs.size()));
    if (added) out.groups.push_back(mesh.bodies[pair[0]] + "|" + mesh.bodies[pair[1]]);
    out.facets.push_back(opposite_facet<D>(mesh.elements[low->element], low->local));
    out.facet_group.push_back(static_cast<std::int32_t>(mesh.groups.size()) + it->second);
    out.facet_face.push_back(faces + it->second);
  });
  return out;
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

#define LAMELLA_INSTANTIATE(D)                                       \
  template SimplexMesh<D> with_interfaces<D>(const SimplexMesh<D>&); \
  template std::vector<SimplexMesh<D>::Facet> blocking_faces<D>(const SimplexMesh<D>&);
LAMELLA_INSTANTIATE(2)
LAMELLA_INSTANTIATE(3)
LAMELLA_INSTANTIATE(4)
#undef LAMELLA_INSTANTIATE

}  // namespace lamella
