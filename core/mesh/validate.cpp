#include "core/mesh/validate.h"

#include <algorithm>
#include <sstream>

#include "core/mesh/adjacency.h"

namespace lamella {
namespace {

constexpr double kVolumeTolerance = 1e-9;

/// Keeps the first sentence; later findings only count.
template <class... Parts>
void found(MeshReport& report, std::size_t& counter, const Parts&... parts) {
  ++counter;
  if (!report.first_finding.empty()) return;
  std::ostringstream text;
  (text << ... << parts);
  report.first_finding = text.str();
}

/// Nodes and points for a message, written only if the message is kept.
template <std::size_t N>
struct List {
  const std::array<NodeId, N>& nodes;
  friend std::ostream& operator<<(std::ostream& out, const List& l) {
    for (std::size_t i = 0; i < N; ++i) out << (i ? " " : "") << l.nodes[i];
    return out;
  }
};
template <std::size_t N>
List(const std::array<NodeId, N>&) -> List<N>;

template <int D>
struct Place {
  const Vec<D>& x;
  friend std::ostream& operator<<(std::ostream& out, const Place& p) {
    for (int k = 0; k < D; ++k) out << (k ? ", " : "(") << p.x[k];
    return out << ")";
  }
};

template <std::size_t N>
bool good_ids(const std::array<NodeId, N>& nodes, std::size_t slots) {
  for (std::size_t i = 0; i < N; ++i) {
    if (nodes[i] < 1 || nodes[i] >= static_cast<NodeId>(slots)) return false;
    for (std::size_t j = 0; j < i; ++j)
      if (nodes[i] == nodes[j]) return false;
  }
  return true;
}

template <int D>
void check_arrays(const SimplexMesh<D>& mesh, MeshReport& r) {
  if (mesh.points.empty()) {
    found(r, r.bad_arrays, "The mesh has no slot for the virtual node.");
    return;
  }
  const auto length = [&](std::size_t got, std::size_t expected, const char* name) {
    if (got != expected)
      found(r, r.bad_arrays, name, " has ", got, " entries instead of ", expected, ".");
  };
  length(mesh.element_body.size(), mesh.elements.size(), "element_body");
  length(mesh.facet_group.size(), mesh.facets.size(), "facet_group");
  length(mesh.facet_face.size(), mesh.facets.size(), "facet_face");
  const auto range = [&](const std::vector<std::int32_t>& ids, std::size_t end, const char* name) {
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (ids[i] < 0 || ids[i] >= static_cast<std::int32_t>(end))
        found(r, r.bad_arrays, name, " ", i, " is ", ids[i], ", but there are ", end, " names.");
  };
  range(mesh.element_body, mesh.bodies.size(), "The body of element");
  range(mesh.facet_group, mesh.groups.size(), "The group of facet");
  for (std::size_t i = 0; i < mesh.elements.size(); ++i)
    if (!good_ids(mesh.elements[i], mesh.points.size()))
      found(r, r.bad_indices, "Element ", i, " has the nodes ", List{mesh.elements[i]},
            ", out of 1..", mesh.node_count(), " or repeated.");
  for (std::size_t i = 0; i < mesh.facets.size(); ++i)
    if (!good_ids(mesh.facets[i], mesh.points.size()))
      found(r, r.bad_indices, "Facet ", i, " has the nodes ", List{mesh.facets[i]}, ", out of 1..",
            mesh.node_count(), " or repeated.");
  for (std::size_t i = 1; i < mesh.points.size(); ++i)
    if (!mesh.points[i].allFinite())
      found(r, r.bad_points, "Node ", i, " has a coordinate that is not finite.");
}

/// Counts the uses of each face; returns the boundary, listed outward. `inner` gets the faces
/// between two bodies, with growing nodes.
template <int D>
std::vector<typename SimplexMesh<D>::Facet> check_faces(
    const SimplexMesh<D>& mesh, std::vector<typename SimplexMesh<D>::Facet>& inner, MeshReport& r) {
  const auto uses = face_uses<D>(mesh.elements, mesh.points.size());
  std::vector<typename SimplexMesh<D>::Facet> boundary;
  for_each_face<D>(uses, [&](std::size_t i, std::size_t j) {
    const FaceUse<D>& u = uses[i];
    if (j - i == 1) {
      ++r.faces_boundary;
      boundary.push_back(opposite_facet<D>(mesh.elements[u.element], u.local));
    } else if (j - i > 2) {
      found(r, r.faces_shared, "Face ", List{u.nodes}, " belongs to ", j - i, " elements.");
    } else {
      ++r.faces_interior;
      if (mesh.element_body[u.element] != mesh.element_body[uses[i + 1].element])
        inner.push_back(u.nodes);
      if (!FaceUse<D>::opposed(u, uses[i + 1]))
        found(r, r.misoriented, "Elements ", u.element, " and ", uses[i + 1].element,
              " lie on the same side of the face ", List{u.nodes}, ".");
    }
  });
  return boundary;
}

/// The listed facets against the boundary of the elements; `inner`: those that may be listed too.
template <int D>
void check_facets(const SimplexMesh<D>& mesh,
                  const std::vector<typename SimplexMesh<D>::Facet>& boundary,
                  const std::vector<typename SimplexMesh<D>::Facet>& inner, MeshReport& r) {
  struct Entry {
    std::array<NodeId, D> nodes;
    bool odd;
    std::size_t index;
    bool operator<(const Entry& o) const {
      return nodes != o.nodes ? nodes < o.nodes : index < o.index;
    }
  };
  const auto entry = [](std::array<NodeId, D> f, std::size_t index) {
    bool odd = false;
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < i; ++j) odd = odd != (f[j] > f[i]);
    std::sort(f.begin(), f.end());
    return Entry{f, odd, index};
  };
  std::vector<Entry> listed(mesh.facets.size()), real(boundary.size());
  for (std::size_t i = 0; i < listed.size(); ++i) listed[i] = entry(mesh.facets[i], i);
  for (std::size_t i = 0; i < real.size(); ++i) real[i] = entry(boundary[i], i);
  std::sort(listed.begin(), listed.end());
  std::sort(real.begin(), real.end());
  auto it = listed.begin();
  const std::array<NodeId, D>* last = nullptr;
  const auto extra = [&] {
    // A face between two bodies may be listed, from either side.
    const bool twice = last && *last == it->nodes;
    last = &it->nodes;
    if (!twice && std::binary_search(inner.begin(), inner.end(), it->nodes)) {
      ++it;
      return;
    }
    found(r, r.facets_extra, "Facet ", it->index, " (nodes ", List{it->nodes},
          ") is no boundary face or is listed twice.");
    ++it;
  };
  for (const Entry& e : real) {
    while (it != listed.end() && it->nodes < e.nodes) extra();
    if (it == listed.end() || it->nodes != e.nodes) {
      found(r, r.facets_missing, "The boundary face with the nodes ", List{e.nodes},
            " is not listed as a facet.");
      continue;
    }
    if (it->odd != e.odd) found(r, r.facets_inward, "Facet ", it->index, " points inward.");
    ++it;
  }
  while (it != listed.end()) extra();
}

template <int D>
void check_measures(const SimplexMesh<D>& mesh,
                    const std::vector<typename SimplexMesh<D>::Facet>& boundary, MeshReport& r) {
  std::vector<char> used(mesh.points.size(), 0);
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    const double measure = signed_measure<D>(mesh.corners(mesh.elements[i]));
    r.volume += std::abs(measure);
    if (!(measure > 0))
      found(r, r.inverted, "Element ", i, " at ", Place<D>{mesh.points[mesh.elements[i][0]]},
            measure < 0 ? " is inverted." : " is flat.");
    for (const NodeId v : mesh.elements[i]) used[v] = 1;
  }
  for (std::size_t i = 1; i < mesh.points.size(); ++i)
    if (!used[i])
      found(r, r.unused, "Node ", i, " at ", Place<D>{mesh.points[i]}, " belongs to no element.");
  // Seen from the middle of the box: far from the origin (1.23) would lose digits.
  Eigen::AlignedBox<double, D> box;
  for (std::size_t i = 1; i < mesh.points.size(); ++i) box.extend(mesh.points[i]);
  const Vec<D> center = box.isEmpty() ? Vec<D>::Zero() : Vec<D>(box.center());
  for (const auto& facet : boundary) {
    const auto p = mesh.corners(facet);
    const Vec<D> normal = facet_normal<D>(p);
    // x . n is constant on a flat face: its measure times its first corner's value.
    r.volume_boundary += normal.dot(p[0] - center) / factorial(D);
    r.boundary_area += normal.norm() / factorial(D - 1);
  }
}

}  // namespace

bool MeshReport::volumes_agree() const {
  return std::abs(volume - volume_boundary) <= kVolumeTolerance * volume;
}

template <int D>
Result<MeshReport> inspect(const SimplexMesh<D>& mesh, const Progress& progress) {
  MeshReport r;
  r.elements = mesh.elements.size();
  check_arrays(mesh, r);
  if (r.bad_arrays + r.bad_indices + r.bad_points > 0) return r;
  r.nodes = mesh.node_count();
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.1);
  std::vector<typename SimplexMesh<D>::Facet> inner;
  const auto boundary = check_faces(mesh, inner, r);
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.7);
  check_measures(mesh, boundary, r);
  check_facets(mesh, boundary, inner, r);
  if (r.first_finding.empty() && !r.volumes_agree()) {
    std::ostringstream text;
    text << "Elements cover each other: their volumes sum to " << r.volume
         << ", their boundary encloses " << r.volume_boundary << ".";
    r.first_finding = text.str();
  }
  progress.report(1);
  return r;
}

template <int D>
Result<void> validate(const SimplexMesh<D>& mesh, const Progress& progress) {
  const Result<MeshReport> report = inspect(mesh, progress);
  if (!report) return report.error();
  if (report->valid()) return {};
  return Error{Code::bad_input, "The mesh is not valid: " + report->first_finding,
               "Run lamella-cli check on it for the full list."};
}

template Result<MeshReport> inspect<2>(const SimplexMesh<2>&, const Progress&);
template Result<MeshReport> inspect<3>(const SimplexMesh<3>&, const Progress&);
template Result<MeshReport> inspect<4>(const SimplexMesh<4>&, const Progress&);
template Result<void> validate<2>(const SimplexMesh<2>&, const Progress&);
template Result<void> validate<3>(const SimplexMesh<3>&, const Progress&);
template Result<void> validate<4>(const SimplexMesh<4>&, const Progress&);

}  // namespace lamella
