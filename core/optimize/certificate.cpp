#include "core/optimize/certificate.h"

#include <algorithm>
#include <sstream>

namespace lamella {
namespace {

/// A face by its sorted nodes, and the parity of the permutation that sorted them: two neighbors
/// see their common face with opposite windings.
template <int D>
struct FaceUse {
  std::array<NodeId, D> nodes;
  bool odd = false;
  bool surface = false;  // comes from the surface, turned as its missing outer neighbor sees it
  bool operator<(const FaceUse& o) const {
    if (nodes != o.nodes) return nodes < o.nodes;
    return surface < o.surface;
  }
};

template <int D>
FaceUse<D> face_use(std::array<NodeId, D> f, bool surface) {
  bool odd = false;
  for (int i = 1; i < D; ++i)
    for (int j = i; j > 0 && f[j] < f[j - 1]; --j) {
      std::swap(f[j], f[j - 1]);
      odd = !odd;
    }
  return {f, surface ? !odd : odd, surface};
}

template <int D>
Vec<D> middle(const std::vector<Vec<D>>& points) {
  Vec<D> lo = points.front(), hi = points.front();
  for (const Vec<D>& p : points) {
    lo = lo.cwiseMin(p);
    hi = hi.cwiseMax(p);
  }
  return 0.5 * (lo + hi);
}

template <int D>
Error finding(const std::string& what, const Vec<D>& where) {
  std::ostringstream s;
  s << what << " near (";
  for (int k = 0; k < D; ++k) s << (k ? ", " : "") << where[k];
  s << ").";
  return {Code::failed, s.str(),
          "Another mesher or a slightly different tessellation may succeed."};
}

}  // namespace

template <int D>
double covered_measure(const SimplexMesh<D>& mesh) {
  double sum = 0;
  for (const auto& e : mesh.elements) sum += std::abs(signed_measure<D>(mesh.corners(e)));
  return sum;
}

template <int D>
double domain_measure(const ReferenceSurface<D>& surface) {
  if (surface.points.empty()) return 0;
  const Vec<D> o = middle<D>(surface.points);
  double sum = 0;
  for (const auto& f : surface.facets) {
    std::array<Vec<D>, D> p;
    for (int k = 0; k < D; ++k) p[k] = surface.points[f[k]] - o;
    sum += facet_normal<D>(p).dot(p[0]);
  }
  return sum / factorial(D);
}

template <int D>
Result<void> certify(const SimplexMesh<D>& mesh, const ReferenceSurface<D>& surface) {
  if (mesh.elements.empty()) return Error{Code::failed, "The mesh has no element.", ""};
  for (const auto& e : mesh.elements)
    if (signed_measure<D>(mesh.corners(e)) <= 0)
      return finding<D>("An element is flat or inverted", mesh.points[e[0]]);

  std::vector<FaceUse<D>> uses;
  uses.reserve(mesh.elements.size() * (D + 1) + surface.facets.size());
  for (const auto& e : mesh.elements)
    for (int k = 0; k <= D; ++k) uses.push_back(face_use<D>(opposite_facet<D>(e, k), false));
  for (auto f : surface.facets) {
    for (auto& v : f) ++v;
    uses.push_back(face_use<D>(f, true));
  }
  std::sort(uses.begin(), uses.end());
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t j = i + 1;
    while (j < uses.size() && uses[j].nodes == uses[i].nodes) ++j;
    const Vec<D>& where = mesh.points[uses[i].nodes[0]];
    if (uses[j - 1].surface && (uses[i].surface || j - i != 2))
      return finding<D>("A facet of the surface is not a boundary face of the mesh", where);
    if (j - i == 1) return finding<D>("A boundary face is not in the surface", where);
    if (j - i > 2) return finding<D>("A face belongs to more than two elements", where);
    if (uses[i].odd == uses[i + 1].odd)
      return finding<D>("Two neighbors see their common face with the same winding", where);
    i = j;
  }

  const double covered = covered_measure<D>(mesh), domain = domain_measure<D>(surface);
  if (std::abs(covered - domain) > 1e-10 * std::abs(domain)) {
    std::ostringstream s;
    s << "The elements cover " << covered << " instead of " << domain << ".";
    return Error{Code::failed, s.str(), ""};
  }
  return {};
}

#define LAMELLA_INSTANTIATE(D)                                   \
  template double covered_measure<D>(const SimplexMesh<D>&);     \
  template double domain_measure<D>(const ReferenceSurface<D>&); \
  template Result<void> certify<D>(const SimplexMesh<D>&, const ReferenceSurface<D>&);
LAMELLA_INSTANTIATE(2)
LAMELLA_INSTANTIATE(3)
LAMELLA_INSTANTIATE(4)
#undef LAMELLA_INSTANTIATE

}  // namespace lamella
