#include "core/optimize/boundary_model.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

#include "core/base/parallel.h"

namespace lamella {
namespace {

std::uint64_t pair_key(std::int32_t a, std::int32_t b) {
  const auto [lo, hi] = std::minmax(a, b);
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(lo)) << 32) |
         static_cast<std::uint32_t>(hi);
}

template <int D>
bool lexicographic(const Vec<D>& a, const Vec<D>& b) {
  return std::lexicographical_compare(a.data(), a.data() + D, b.data(), b.data() + D);
}

/// Facets around each (D-2)-face: sorted by the face's vertices.
template <int D>
struct Ridge {
  std::array<std::int32_t, D - 1> nodes;
  std::int32_t facet;
  bool operator<(const Ridge& o) const {
    return nodes != o.nodes ? nodes < o.nodes : facet < o.facet;
  }
};

template <int D>
std::vector<Ridge<D>> ridges_of(const std::vector<std::array<std::int32_t, D>>& facets) {
  std::vector<Ridge<D>> ridges;
  ridges.reserve(facets.size() * D);
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (int k = 0; k < D; ++k) {
      Ridge<D> r;
      for (int i = 0, j = 0; i < D; ++i)
        if (i != k) r.nodes[j++] = facets[f][i];
      std::sort(r.nodes.begin(), r.nodes.end());
      r.facet = static_cast<std::int32_t>(f);
      ridges.push_back(r);
    }
  std::sort(ridges.begin(), ridges.end());
  return ridges;
}

template <int D>
std::vector<Vec<D>> unit_normals(const ReferenceSurface<D>& s) {
  std::vector<Vec<D>> normals(s.facets.size());
  for (std::size_t f = 0; f < s.facets.size(); ++f) {
    std::array<Vec<D>, D> p;
    for (int k = 0; k < D; ++k) p[k] = s.points[s.facets[f][k]];
    normals[f] = facet_normal<D>(p).normalized();
  }
  return normals;
}

/// The surface in two parts: the facets on faces of the first `outer` facets of the mesh, then
/// those on faces of its other facets up to number `given`; what lies on both is there twice.
/// Returns where the second part begins.
template <int D>
std::size_t sort_by_kind(ReferenceSurface<D>& surface, const SimplexMesh<D>& mesh,
                         std::size_t outer, std::size_t given) {
  if (outer == given) return surface.facets.size();
  std::int32_t faces = 0;
  for (std::int32_t f : surface.facet_face) faces = std::max(faces, f + 1);
  for (std::int32_t f : mesh.facet_face) faces = std::max(faces, f + 1);
  std::array<std::vector<char>, 2> on;
  for (auto& kind : on) kind.assign(faces, 0);
  for (std::size_t f = 0; f < given; ++f) on[f < outer ? 0 : 1][mesh.facet_face[f]] = 1;
  const auto facets = std::move(surface.facets);
  const auto face = std::move(surface.facet_face);
  surface.facets.clear();
  surface.facet_face.clear();
  std::size_t first = 0;
  for (const auto& kind : on) {
    first = surface.facets.size();
    for (std::size_t f = 0; f < facets.size(); ++f) {
      if (!kind[face[f]]) continue;
      surface.facets.push_back(facets[f]);
      surface.facet_face.push_back(face[f]);
    }
  }
  return first;
}

/// The surface with the facets of `own` from number `outer` on and the feature edges between them:
/// their faces are numbered behind its faces, in `patch` too.
template <int D>
ReferenceSurface<D> joined(ReferenceSurface<D> surface, const ReferenceSurface<D>& own,
                           std::size_t outer, std::vector<std::int32_t>& patch) {
  std::int32_t base = 0;
  for (std::int32_t f : surface.facet_face) base = std::max(base, f + 1);
  for (std::size_t f = 0; f < outer; ++f) base = std::max(base, patch[f] + 1);
  const auto shift = static_cast<std::int32_t>(surface.points.size());
  surface.points.insert(surface.points.end(), own.points.begin(), own.points.end());
  std::vector<char> on_wall(own.points.size(), 0);
  for (std::size_t f = 0; f < outer; ++f)
    for (auto v : own.facets[f]) on_wall[v] = 1;
  for (std::size_t f = outer; f < own.facets.size(); ++f) {
    auto facet = own.facets[f];
    for (auto& v : facet) v += shift;
    surface.facets.push_back(facet);
    patch[f] += base;
    surface.facet_face.push_back(patch[f]);
  }
  // On the wall the surface knows the features, and the interfaces end at borders of groups.
  const auto ridges = ridges_of<D>(own.facets);
  for (const auto& e : own.feature_edges) {
    Ridge<D> r;
    std::copy_n(e.begin(), D - 1, r.nodes.begin());
    std::sort(r.nodes.begin(), r.nodes.end());
    r.facet = -1;
    const auto first = std::lower_bound(ridges.begin(), ridges.end(), r);
    if (first != ridges.end() && static_cast<std::size_t>(first->facet) >= outer)
      surface.feature_edges.push_back({e[0] + shift, e[1] + shift});
  }
  for (auto c : own.corners)
    if (!on_wall[c]) surface.corners.push_back(c + shift);
  return surface;
}

}  // namespace

/// Bounding volume tree over segments.
template <int D>
struct BoundaryModel<D>::Features {
  struct Segment {
    Vec<D> a, b;
  };
  struct Box {
    Vec<D> lo = Vec<D>::Zero(), hi = Vec<D>::Zero();
    std::int32_t first = 0, count = 0, left = -1;  // leaf when count > 0; children left, left + 1
  };
  std::vector<Segment> segments;
  std::vector<Box> boxes;

  explicit Features(std::vector<Segment> s) : segments(std::move(s)) {
    boxes.push_back({});
    build(0, 0, static_cast<std::int32_t>(segments.size()));
  }
  void build(std::int32_t box, std::int32_t first, std::int32_t last) {
    Vec<D> lo = Vec<D>::Constant(1e300), hi = -lo;
    for (std::int32_t i = first; i < last; ++i) {
      lo = lo.cwiseMin(segments[i].a).cwiseMin(segments[i].b);
      hi = hi.cwiseMax(segments[i].a).cwiseMax(segments[i].b);
    }
    boxes[box] = {lo, hi, first, last - first, -1};
    if (last - first <= 4) return;
    int axis;
    (hi - lo).maxCoeff(&axis);
    const std::int32_t mid = (first + last) / 2;
    std::nth_element(segments.begin() + first, segments.begin() + mid, segments.begin() + last,
                     [axis](const Segment& p, const Segment& q) {
                       return p.a[axis] + p.b[axis] < q.a[axis] + q.b[axis];
                     });
    const auto left = static_cast<std::int32_t>(boxes.size());
    boxes[box].count = 0;
    boxes[box].left = left;
    boxes.push_back({});
    boxes.push_back({});
    build(left, first, mid);
    build(left + 1, mid, last);
  }
  void search(std::int32_t box, const Vec<D>& x, double& best, Vec<D>& point) const {
    const Box& b = boxes[box];
    if ((b.lo - x).cwiseMax(x - b.hi).cwiseMax(0.0).squaredNorm() >= best) return;
    if (b.left >= 0) {
      search(b.left, x, best, point);
      search(b.left + 1, x, best, point);
      return;
    }
    for (std::int32_t i = b.first; i < b.first + b.count; ++i) {
      const Segment& s = segments[i];
      const Vec<D> u = s.b - s.a;
      const double t = std::clamp((x - s.a).dot(u) / u.squaredNorm(), 0.0, 1.0);
      const Vec<D> p = s.a + t * u;
      const double d = (x - p).squaredNorm();
      if (d < best) {
        best = d;
        point = p;
      }
    }
  }
};

/// Balanced tree over points, for boxes: the middle of each range divides it.
template <int D>
struct BoundaryModel<D>::Vertices {
  std::vector<Vec<D>> points;
  std::vector<std::uint8_t> axes;  // [point] across which its range is divided

  explicit Vertices(std::vector<Vec<D>> p) : points(std::move(p)), axes(points.size(), 0) {
    build(0, points.size());
  }
  void build(std::size_t first, std::size_t last) {
    if (last - first < 2) return;
    Vec<D> lo = points[first], hi = lo;
    for (std::size_t i = first; i < last; ++i) {
      lo = lo.cwiseMin(points[i]);
      hi = hi.cwiseMax(points[i]);
    }
    int axis;
    (hi - lo).maxCoeff(&axis);
    const std::size_t middle = first + (last - first) / 2;
    const auto at = [this](std::size_t i) {
      return points.begin() + static_cast<std::ptrdiff_t>(i);
    };
    std::nth_element(at(first), at(middle), at(last), [axis](const Vec<D>& a, const Vec<D>& b) {
      return a[axis] != b[axis] ? a[axis] < b[axis] : lexicographic<D>(a, b);
    });
    axes[middle] = static_cast<std::uint8_t>(axis);
    build(first, middle);
    build(middle + 1, last);
  }
  void in_box(std::size_t first, std::size_t last, const Vec<D>& lo, const Vec<D>& hi,
              std::vector<Vec<D>>& found) const {
    while (first < last) {
      const std::size_t middle = first + (last - first) / 2;
      const Vec<D>& p = points[middle];
      const int axis = axes[middle];
      if ((p - lo).minCoeff() >= 0 && (hi - p).minCoeff() >= 0) found.push_back(p);
      if (p[axis] > hi[axis]) {
        last = middle;
      } else if (p[axis] < lo[axis]) {
        first = middle + 1;
      } else {
        in_box(first, middle, lo, hi, found);
        first = middle + 1;
      }
    }
  }
};

template <int D>
BoundaryModel<D>::~BoundaryModel() = default;

template <int D>
ReferenceSurface<D> own_surface(const SimplexMesh<D>& mesh, double angle) {
  ReferenceSurface<D> s;
  std::vector<std::int32_t> where(mesh.points.size(), -1);
  for (const auto& f : mesh.facets) {
    std::array<std::int32_t, D> g;
    for (int k = 0; k < D; ++k) {
      if (where[f[k]] < 0) {
        where[f[k]] = static_cast<std::int32_t>(s.points.size());
        s.points.push_back(mesh.points[f[k]]);
      }
      g[k] = where[f[k]];
    }
    s.facets.push_back(g);
  }
  std::vector<std::int32_t> patch(s.facets.size());
  std::iota(patch.begin(), patch.end(), 0);
  const auto root = [&patch](std::int32_t f) {
    while (patch[f] != f) f = patch[f] = patch[patch[f]];
    return f;
  };
  const auto normals = unit_normals(s);
  const auto ridges = ridges_of<D>(s.facets);
  const double limit = std::cos(angle);
  std::vector<std::vector<std::int32_t>> feature_at(s.points.size());
  for (std::size_t i = 0; i < ridges.size();) {
    std::size_t j = i + 1;
    while (j < ridges.size() && ridges[j].nodes == ridges[i].nodes) ++j;
    const bool sharp =
        j - i != 2 || normals[ridges[i].facet].dot(normals[ridges[i + 1].facet]) < limit;
    const std::int32_t a = ridges[i].facet, b = ridges[j - 1].facet;
    if (!sharp && mesh.facet_group[a] == mesh.facet_group[b] &&
        mesh.facet_face[a] == mesh.facet_face[b])
      patch[root(a)] = root(b);
    if (sharp) {
      if constexpr (D == 2) s.corners.push_back(ridges[i].nodes[0]);
      if constexpr (D == 3) {
        s.feature_edges.push_back({ridges[i].nodes[0], ridges[i].nodes[1]});
        for (int k = 0; k < 2; ++k)
          feature_at[ridges[i].nodes[k]].push_back(ridges[i].nodes[1 - k]);
      }
    }
    i = j;
  }
  for (std::size_t f = 0; f < s.facets.size(); ++f)
    s.facet_face.push_back(root(static_cast<std::int32_t>(f)));
  if constexpr (D == 3)
    for (std::size_t v = 0; v < s.points.size(); ++v) {
      const auto& ends = feature_at[v];
      if (ends.empty()) continue;
      bool corner = ends.size() != 2;
      if (!corner) {
        const Vec<D> a = (s.points[ends[0]] - s.points[v]).normalized();
        const Vec<D> b = (s.points[v] - s.points[ends[1]]).normalized();
        corner = a.dot(b) < limit;
      }
      if (corner) s.corners.push_back(static_cast<std::int32_t>(v));
    }
  return s;
}

template <int D>
BoundaryModel<D>::BoundaryModel(const SimplexMesh<D>& mesh, const ReferenceSurface<D>* surface,
                                double tolerance, double feature_angle,
                                const std::vector<std::int32_t>& frozen_groups,
                                const std::vector<std::int32_t>& frozen_bodies, std::size_t outer,
                                std::size_t given)
    : tolerance_(tolerance) {
  given = std::min(given, mesh.facets.size());
  outer = std::min(outer, given);
  ReferenceSurface<D> reference;
  std::vector<std::int32_t> patch = mesh.facet_face;  // [facet of the mesh]
  if constexpr (D < 4) {
    if (surface) {
      // Without a face of theirs the surface says nothing of the interfaces.
      const auto& known = surface->facet_face;
      if (std::none_of(mesh.facet_face.begin() + outer, mesh.facet_face.begin() + given,
                       [&](auto f) { return std::count(known.begin(), known.end(), f) > 0; }))
        given = outer;
      reference = *surface;
      first_interface_ = static_cast<std::int32_t>(sort_by_kind(reference, mesh, outer, given));
    }
    if (!surface || given < mesh.facets.size()) {
      ReferenceSurface<D> own = own_surface<D>(mesh, feature_angle);
      patch = own.facet_face;
      if (surface) {
        std::copy_n(mesh.facet_face.begin(), given, patch.begin());
        own = joined(std::move(reference), own, given, patch);
      } else {
        first_interface_ =
            static_cast<std::int32_t>(own.facets.size() - (mesh.facets.size() - outer));
      }
      reference = std::move(own);
    }
  }
  std::map<std::array<std::int32_t, 3>, std::int32_t> index;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const std::int32_t face = mesh.facet_face[f];
    const auto [it, added] = index.try_emplace({mesh.facet_group[f], face, patch[f]},
                                               static_cast<std::int32_t>(tags_.size()));
    if (added) tags_.push_back({mesh.facet_group[f], face, patch[f], f >= outer});
    facet_tag_.push_back(it->second);
  }
  fixed_.assign(mesh.points.size(), 0);
  frozen_tag_.assign(tags_.size(), 0);
  for (std::size_t t = 0; t < tags_.size(); ++t)
    frozen_tag_[t] = std::count(frozen_groups.begin(), frozen_groups.end(), tags_[t].group) > 0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    if (frozen_tag_[facet_tag_[f]])
      for (NodeId n : mesh.facets[f]) fixed_[n] = 1;
  frozen_body_.assign(mesh.bodies.size(), 0);
  for (std::int32_t body : frozen_bodies) frozen_body_[body] = 1;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    if (frozen_body(mesh.element_body[e]))
      for (NodeId n : mesh.elements[e]) fixed_[n] = 1;
  if constexpr (D < 4) {
    normals_ = unit_normals(reference);
    facet_face_ = reference.facet_face;
    find_planes(reference);
    find_features(mesh, reference, feature_angle);
    if (first_interface_ < static_cast<std::int32_t>(reference.facets.size())) {
      ReferenceSurface<D> inner;
      inner.points = reference.points;
      inner.facets.assign(reference.facets.begin() + first_interface_, reference.facets.end());
      interfaces_ = std::make_unique<Search>(inner);
      reference.facets.resize(static_cast<std::size_t>(first_interface_));
      reference.facet_face.resize(reference.facets.size());
    }
    locator_ = std::make_unique<Search>(reference);
    if (surface) {
      find_sides(mesh);
      measure_first(mesh);
    }
  }
}

/// A face is planar when all its vertices lie in the plane of its largest facet. Keeps the vertices
/// that do not lie inside of planar faces.
template <int D>
void BoundaryModel<D>::find_planes(const ReferenceSurface<D>& reference) {
  std::int32_t patches = 0;
  for (const Tag& t : tags_) patches = std::max(patches, t.patch + 1);
  for (std::int32_t f : facet_face_) patches = std::max(patches, f + 1);
  planes_.resize(patches);
  plane_tolerance_ = 1e-3 * tolerance_;
  std::vector<double> largest(patches, 0);
  for (std::size_t f = 0; f < reference.facets.size(); ++f) {
    std::array<Vec<D>, D> p;
    for (int k = 0; k < D; ++k) p[k] = reference.points[reference.facets[f][k]];
    const double size = facet_normal<D>(p).squaredNorm();
    const std::int32_t patch = facet_face_[f];
    if (size <= largest[patch]) continue;
    largest[patch] = size;
    planes_[patch] = {normals_[f], p[0], true};
  }
  for (std::size_t f = 0; f < reference.facets.size(); ++f) {
    Plane& plane = planes_[facet_face_[f]];
    for (auto v : reference.facets[f])
      if (std::abs(plane.normal.dot(reference.points[v] - plane.origin)) > plane_tolerance_)
        plane.planar = false;
  }
  std::vector<char> curved(reference.points.size(), 0);
  std::vector<std::int32_t> face_at(reference.points.size(), -1);
  for (std::size_t f = 0; f < reference.facets.size(); ++f)
    for (auto v : reference.facets[f]) {
      const std::int32_t face = facet_face_[f];
      if (!planes_[face].planar || (face_at[v] >= 0 && face_at[v] != face)) curved[v] = 1;
      face_at[v] = face;
    }
  std::vector<Vec<D>> points;
  for (std::size_t v = 0; v < curved.size(); ++v)
    if (curved[v]) points.push_back(reference.points[v]);
  curved_ = std::make_unique<Vertices>(std::move(points));
}

/// Feature edges of the reference, borders of groups where it has none, and the nodes at corners.
template <int D>
void BoundaryModel<D>::find_features(const SimplexMesh<D>& mesh,
                                     const ReferenceSurface<D>& reference, double feature_angle) {
  std::vector<Vec<D>> corners;
  for (auto c : reference.corners) corners.push_back(reference.points[c]);
  std::sort(corners.begin(), corners.end(), lexicographic<D>);
  for (const auto& f : mesh.facets)
    for (NodeId n : f)
      if (std::binary_search(corners.begin(), corners.end(), mesh.points[n], lexicographic<D>))
        fixed_[n] = 1;

  if constexpr (D == 3) {
    using Segment = typename Features::Segment;
    const auto ridges = ridges_of<D>(reference.facets);
    std::vector<Segment> segments;
    std::vector<char> on_feature(reference.points.size(), 0);
    for (const auto& e : reference.feature_edges) {
      segments.push_back({reference.points[e[0]], reference.points[e[1]]});
      for (auto v : e) on_feature[v] = 1;
      Ridge<D> r{{std::min(e[0], e[1]), std::max(e[0], e[1])}, -1};
      std::vector<std::int32_t> faces;
      for (auto it = std::lower_bound(ridges.begin(), ridges.end(), r);
           it != ridges.end() && it->nodes == r.nodes; ++it)
        faces.push_back(facet_face_[it->facet]);
      for (std::size_t i = 0; i < faces.size(); ++i)
        for (std::size_t j = i + 1; j < faces.size(); ++j)
          if (faces[i] != faces[j]) hard_pairs_.push_back(pair_key(faces[i], faces[j]));
    }
    std::sort(hard_pairs_.begin(), hard_pairs_.end());
    hard_pairs_.erase(std::unique(hard_pairs_.begin(), hard_pairs_.end()), hard_pairs_.end());
    std::vector<Vec<D>> vertices;
    for (std::size_t v = 0; v < on_feature.size(); ++v)
      if (on_feature[v]) vertices.push_back(reference.points[v]);
    if (!segments.empty()) features_ = std::make_unique<Features>(segments);

    std::map<NodeId, std::vector<NodeId>> border_at;
    std::vector<std::array<NodeId, 2>> borders;
    const auto own = ridges_of<D>(mesh.facets);
    for (std::size_t i = 0; i < own.size();) {
      std::size_t j = i + 1;
      bool differ = false;
      for (; j < own.size() && own[j].nodes == own[i].nodes; ++j)
        differ = differ || mesh.facet_group[own[j].facet] != mesh.facet_group[own[i].facet];
      const auto [a, b] = own[i].nodes;
      i = j;
      if (!differ ||
          nearest_feature(0.5 * (mesh.points[a] + mesh.points[b]), std::max(tolerance_, 1e-300)))
        continue;
      borders.push_back({a, b});
      border_at[a].push_back(b);
      border_at[b].push_back(a);
    }
    for (const auto& [a, b] : borders) segments.push_back({mesh.points[a], mesh.points[b]});
    for (const auto& [n, ends] : border_at) {
      vertices.push_back(mesh.points[n]);
      if (ends.size() != 2) continue;  // the mesh tells by itself
      const Vec<D> a = (mesh.points[ends[0]] - mesh.points[n]).normalized();
      const Vec<D> b = (mesh.points[n] - mesh.points[ends[1]]).normalized();
      if (a.dot(b) < std::cos(feature_angle)) fixed_[n] = 1;
    }
    if (!borders.empty()) features_ = std::make_unique<Features>(std::move(segments));
    on_features_ = std::make_unique<Vertices>(std::move(vertices));
  }
}

/// An interface may be listed from the other side than the body whose surface it is, and what
/// becomes of it when one body is dropped too.
template <int D>
void BoundaryModel<D>::find_sides(const SimplexMesh<D>& mesh) {
  std::vector<double> along(mesh.facets.size(), 0);
  parallel_each(along.size(), 0, {}, [&](std::size_t f) {
    const auto p = mesh.corners(mesh.facets[f]);
    const Vec<D> center = std::accumulate(p.begin() + 1, p.end(), p[0]) / D;
    const auto at = nearest(center, 1e150, facet_tag_[f]);
    if (at) along[f] = facet_normal<D>(p).dot(normals_[at->facet]);
  });
  std::vector<double> sum(tags_.size(), 0);
  for (std::size_t f = 0; f < along.size(); ++f) sum[facet_tag_[f]] += along[f];
  for (std::size_t t = 0; t < tags_.size(); ++t) tags_[t].side = sum[t] < 0 ? -1 : 1;
}

template <int D>
void BoundaryModel<D>::measure_first(const SimplexMesh<D>& mesh) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> of_facet(mesh.facets.size());
  parallel_each(of_facet.size(), 0, {}, [&](std::size_t f) {
    of_facet[f] = deviation(mesh.corners(mesh.facets[f]), -1, facet_tag_[f], infinity);
  });
  for (double d : of_facet) first_deviation_ = std::max(first_deviation_, d);
  if constexpr (D == 3) {
    const auto ridges = ridges_of<D>(mesh.facets);
    for (std::size_t i = 0; features_ && i + 1 < ridges.size(); ++i) {
      const auto &r = ridges[i], &q = ridges[i + 1];
      if (r.nodes != q.nodes || !hard(facet_tag_[r.facet], facet_tag_[q.facet])) continue;
      const Vec<D> middle = 0.5 * (mesh.points[r.nodes[0]] + mesh.points[r.nodes[1]]);
      const auto on = nearest_feature(middle, 1e150);
      first_deviation_ = std::max(first_deviation_, (*on - middle).norm());
    }
  }
}

template <int D>
bool BoundaryModel<D>::hard(std::int32_t a, std::int32_t b) const {
  if (a == b) return false;
  if (tags_[a].group != tags_[b].group) return true;
  if constexpr (D == 2) return false;  // corners are fixed nodes
  return std::binary_search(hard_pairs_.begin(), hard_pairs_.end(),
                            pair_key(tags_[a].patch, tags_[b].patch));
}

template <int D>
std::optional<Nearest<D>> BoundaryModel<D>::nearest(const Vec<D>& x, double within,
                                                    std::int32_t t) const {
  if constexpr (D < 4) {
    if (!tags_[t].interface) return locator_->nearest(x, within);
    auto found = interfaces_->nearest(x, within);
    if (found) found->facet += first_interface_;
    return found;
  }
  return std::nullopt;
}

template <int D>
double BoundaryModel<D>::deviation(const std::array<Vec<D>, D>& p, int apex, std::int32_t t,
                                   double limit) const {
  if constexpr (D < 4) {
    constexpr int order = 4;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    // Below this share of the tolerance the facet below the point before is near enough; above this
    // share of the limit the lattice is refined.
    constexpr double close = 0.7;
    const double safe2 = close * close * tolerance_ * tolerance_;
    const Search& search = tags_[t].interface ? *interfaces_ : *locator_;
    std::int32_t below = -1;
    const bool all = apex < 0;
    if (all) apex = 0;
    double most2 = 0;
    const auto near = [&](const Vec<D>& x) {
      std::optional<Nearest<D>> on;
      if (below >= 0) on = search.nearest_on_facet(x, below);
      if (!on || on->distance2 > safe2) {
        const bool known = on && on->distance2 < limit * limit;
        const auto nearer = search.nearest(x, known ? std::sqrt(on->distance2) : limit);
        if (!nearer && !known) return false;
        if (nearer) on = nearer;
      }
      below = on->facet;
      most2 = std::max(most2, on->distance2);
      return true;
    };
    const Vec<D>& a = p[apex];
    // The distance to one flat facet is convex: what all corners keep, the whole facet keeps.
    if (!near(std::accumulate(p.begin() + 1, p.end(), p[0]) / D)) return infinity;
    if (std::all_of(p.begin(), p.end(), [&](const Vec<D>& x) {
          return search.nearest_on_facet(x, below).distance2 <= tolerance_ * tolerance_;
        }))
      return std::sqrt(most2);
    if constexpr (D == 2) {
      for (int i = 1; i < order; ++i)
        if (!near((i * a + (order - i) * p[1 - apex]) / order)) return infinity;
    } else if constexpr (D == 3) {
      const Vec<D>&b = p[(apex + 1) % 3], &c = p[(apex + 2) % 3];
      for (int i = all ? 0 : 1; i < order; ++i)
        for (int j = 0; i + j <= order; ++j)
          if (!near((i * a + j * b + (order - i - j) * c) / order)) return infinity;
      constexpr int fine = 2 * order;
      if (most2 > close * close * limit * limit)
        for (int i = all ? 0 : 1; i < fine; ++i)
          for (int j = 0; i + j <= fine; ++j)
            if ((i % 2 != 0 || j % 2 != 0) && !near((i * a + j * b + (fine - i - j) * c) / fine))
              return infinity;
    }
    return std::sqrt(most2);
  }
  return 0;
}

template <int D>
void BoundaryModel<D>::vertices_in(const Vec<D>& low, const Vec<D>& high,
                                   std::vector<Vec<D>>& found) const {
  found.clear();
  if (curved_) curved_->in_box(0, curved_->points.size(), low, high, found);
}

template <int D>
void BoundaryModel<D>::feature_vertices_in(const Vec<D>& low, const Vec<D>& high,
                                           std::vector<Vec<D>>& found) const {
  found.clear();
  if (on_features_) on_features_->in_box(0, on_features_->points.size(), low, high, found);
}

template <int D>
std::optional<Vec<D>> BoundaryModel<D>::nearest_feature(const Vec<D>& x, double within) const {
  if (!features_) return std::nullopt;
  double best = within * within;
  Vec<D> point = x;
  bool found = false;
  const double before = best;
  features_->search(0, x, best, point);
  found = best < before;
  if (!found) return std::nullopt;
  return point;
}

template <int D>
std::int32_t BoundaryModel<D>::tag_on(std::int32_t t, std::int32_t facet) const {
  const std::int32_t patch = facet_face_[facet];
  if (tags_[t].patch == patch) return t;
  for (std::size_t i = 0; i < tags_.size(); ++i)
    if (tags_[i].group == tags_[t].group && tags_[i].patch == patch)
      return static_cast<std::int32_t>(i);
  return t;
}

template ReferenceSurface<2> own_surface(const SimplexMesh<2>&, double);
template ReferenceSurface<3> own_surface(const SimplexMesh<3>&, double);
template class BoundaryModel<2>;
template class BoundaryModel<3>;
template class BoundaryModel<4>;

}  // namespace lamella
