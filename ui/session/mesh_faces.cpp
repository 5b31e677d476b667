#include "ui/session/mesh_faces.h"

#include <algorithm>
#include <tuple>

namespace lamella::ui {
namespace {

/// A face among those with the same smallest node: its other nodes, and whose it is.
struct Use {
  NodeId second = 0, third = 0;
  std::int64_t owner = 0;  ///< 4 element + k; of a listed face -1 - its number
};

}  // namespace

std::int32_t MeshFaces::facet(std::size_t element, int k) const {
  const std::int64_t key = 4 * static_cast<std::int64_t>(element) + k;
  const auto it = std::lower_bound(listed.begin(), listed.end(), std::pair(key, std::int32_t(-1)));
  return it != listed.end() && it->first == key ? it->second : -1;
}

MeshFaces mesh_faces(const SimplexMesh<3>& mesh) {
  const std::size_t nodes = mesh.points.size();
  const auto sorted = [](std::array<NodeId, 3> f) {
    std::sort(f.begin(), f.end());
    return f;
  };
  const auto face = [&](std::size_t e, std::size_t k) {
    const auto& c = mesh.elements[e];
    return sorted({c[(k + 1) % 4], c[(k + 2) % 4], c[(k + 3) % 4]});
  };
  // By their smallest node: a few dozen each, which are then put in order.
  std::vector<std::size_t> begin(nodes + 1, 0);
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (std::size_t k = 0; k < 4; ++k) ++begin[static_cast<std::size_t>(face(e, k)[0]) + 1];
  for (const auto& f : mesh.facets) ++begin[static_cast<std::size_t>(sorted(f)[0]) + 1];
  for (std::size_t n = 0; n < nodes; ++n) begin[n + 1] += begin[n];
  std::vector<Use> uses(begin[nodes]);
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  const auto put = [&](const std::array<NodeId, 3>& f, std::int64_t owner) {
    uses[next[static_cast<std::size_t>(f[0])]++] = {f[1], f[2], owner};
  };
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (std::size_t k = 0; k < 4; ++k) put(face(e, k), static_cast<std::int64_t>(4 * e + k));
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    put(sorted(mesh.facets[f]), -1 - static_cast<std::int64_t>(f));

  MeshFaces faces;
  faces.neighbor.assign(mesh.elements.size(), {-1, -1, -1, -1});
  for (std::size_t n = 0; n < nodes; ++n) {
    const auto first = uses.begin() + static_cast<std::ptrdiff_t>(begin[n]);
    const auto last = uses.begin() + static_cast<std::ptrdiff_t>(begin[n + 1]);
    const auto key = [](const Use& u) { return std::tuple(u.second, u.third, u.owner); };
    std::sort(first, last, [&](const Use& a, const Use& b) { return key(a) < key(b); });
    for (auto a = first; a != last;) {
      auto b = a;
      while (b != last && b->second == a->second && b->third == a->third) ++b;
      // Listed ones come first, then the elements, of which there are two at most.
      auto own = a;
      while (own != b && own->owner < 0) ++own;
      for (auto u = own; u != b; ++u) {
        if (own != a) faces.listed.emplace_back(u->owner, static_cast<std::int32_t>(-1 - a->owner));
        for (auto v = own; v != b; ++v)
          if (v != u)
            faces.neighbor[static_cast<std::size_t>(u->owner / 4)]
                          [static_cast<std::size_t>(u->owner % 4)] =
                static_cast<std::int32_t>(v->owner / 4);
      }
      a = b;
    }
  }
  std::sort(faces.listed.begin(), faces.listed.end());
  return faces;
}

}  // namespace lamella::ui
