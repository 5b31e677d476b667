#include "core/io/facet_sides.h"

#include <algorithm>
#include <atomic>

#include "core/base/parallel.h"
#include "core/mesh/boundary.h"

namespace lamella {

namespace {

using Facet = SimplexMesh<3>::Facet;

Facet sorted(Facet f) {
  std::sort(f.begin(), f.end());
  return f;
}

/// Both list the same three nodes in the same sense.
bool same_sense(const Facet& a, const Facet& b) {
  const auto k = std::find(b.begin(), b.end(), a[0]) - b.begin();
  return b[(k + 1) % 3] == a[1];
}

/// A number for a face that changes its sign with the winding, so that it cancels out within.
std::uint64_t mark(const Facet& f) {
  const Facet s = sorted(f);
  std::uint64_t h = 0x9E3779B97F4A7C15u;
  for (const NodeId v : s) {
    h ^= static_cast<std::uint64_t>(v) + 0x9E3779B97F4A7C15u;
    h *= 0xBF58476D1CE4E5B9u;
    h ^= h >> 29;
  }
  return same_sense(s, f) ? h : ~h + 1;
}

}  // namespace

std::vector<FacetSide> facet_sides(const SimplexMesh<3>& mesh) {
  std::vector<FacetSide> sides(mesh.facets.size());
  std::vector<std::pair<Facet, std::int32_t>> keys;
  std::vector<bool> listed(mesh.points.size(), false);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    keys.push_back({sorted(mesh.facets[f]), static_cast<std::int32_t>(f)});
    for (const NodeId v : mesh.facets[f]) listed[v] = true;
  }
  std::sort(keys.begin(), keys.end());
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const auto& element = mesh.elements[e];
    int outside = 0, alone = -1;
    for (int k = 0; k < 4; ++k)
      if (!listed[element[k]]) ++outside, alone = k;
    if (outside > 1) continue;
    for (int k = 0; k < 4; ++k) {
      if (alone >= 0 && k != alone) continue;
      const Facet out = opposite_facet<3>(element, k);
      const Facet key = sorted(out);
      for (auto it = std::lower_bound(keys.begin(), keys.end(), std::pair(key, std::int32_t{0}));
           it != keys.end() && it->first == key; ++it) {
        FacetSide& side = sides[it->second];
        const auto id = static_cast<std::int32_t>(e);
        if (side.element < 0) {
          side = {id, k, -1};
        } else if (same_sense(mesh.facets[it->second], out)) {
          side = {id, k, side.element};
        } else {
          side.other = id;
        }
      }
    }
  }
  return sides;
}

bool boundary_is_listed(const SimplexMesh<3>& mesh) {
  // Faces within the mesh cancel out: the sum over all elements is the sum over the boundary.
  std::atomic<std::uint64_t> all = 0;
  parallel_ranges(mesh.elements.size(), 32768, 0, [&](std::size_t first, std::size_t last) {
    std::uint64_t own = 0;
    for (std::size_t e = first; e < last; ++e)
      for (int k = 0; k < 4; ++k) own += mark(opposite_facet<3>(mesh.elements[e], k));
    all += own;
  });
  std::uint64_t sum = all;
  const std::vector<FacetSide> sides = facet_sides(mesh);
  for (std::size_t f = 0; f < sides.size(); ++f)
    if (sides[f].element >= 0 && sides[f].other < 0)
      sum -= mark(opposite_facet<3>(mesh.elements[sides[f].element], sides[f].local));
  return sum == 0;
}

void list_boundary(SimplexMesh<3>& mesh) {
  if (boundary_is_listed(mesh)) return;
  std::vector<Facet> known;
  for (const Facet& f : mesh.facets) known.push_back(sorted(f));
  std::sort(known.begin(), known.end());
  const auto group = static_cast<std::int32_t>(mesh.groups.size());
  bool added = false;
  for (const BoundaryFace<3>& face : boundary_faces<3>(mesh.elements, mesh.points.size())) {
    if (std::binary_search(known.begin(), known.end(), sorted(face.facet))) continue;
    mesh.facets.push_back(face.facet);
    mesh.facet_group.push_back(group);
    mesh.facet_face.push_back(0);
    added = true;
  }
  if (added) mesh.groups.push_back("unnamed");
}

}  // namespace lamella
