#include "core/optimize/boundary_model.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

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

/// The boundary of a mesh as its own reference: features are the (D-2)-faces where facets meet at
/// more than `angle` radians, faces are the patches of one tag between them.
template <int D>
ReferenceSurface<D> surface_of(const SimplexMesh<D>& mesh, double angle) {
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

template <int D>
BoundaryModel<D>::~BoundaryModel() = default;

template <int D>
BoundaryModel<D>::BoundaryModel(const SimplexMesh<D>& mesh, const ReferenceSurface<D>* surface,
                                double tolerance, double feature_angle,
                                const std::vector<std::int32_t>& frozen_groups,
                                const std::vector<std::int32_t>& frozen_bodies)
    : tolerance_(tolerance) {
  ReferenceSurface<D> own;
  if constexpr (D < 4)
    if (!surface) own = surface_of(mesh, feature_angle);
  std::map<std::array<std::int32_t, 3>, std::int32_t> index;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const std::int32_t face = mesh.facet_face[f];
    const std::int32_t patch = own.facets.empty() ? face : own.facet_face[f];
    const auto [it, added] = index.try_emplace({mesh.facet_group[f], face, patch},
                                               static_cast<std::int32_t>(tags_.size()));
    if (added) tags_.push_back({mesh.facet_group[f], face, patch});
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
  if constexpr (D == 4) return;
  if constexpr (D < 4) {
    if (!surface) surface = &own;
    normals_ = unit_normals(*surface);
    facet_face_ = surface->facet_face;
    locator_ = std::make_unique<Search>(*surface);

    // A face is planar when all its vertices lie in the plane of its largest facet.
    std::int32_t patches = 0;
    for (const Tag& t : tags_) patches = std::max(patches, t.patch + 1);
    for (std::int32_t f : facet_face_) patches = std::max(patches, f + 1);
    planes_.resize(patches);
    plane_tolerance_ = 1e-3 * tolerance;
    std::vector<double> largest(patches, 0);
    for (std::size_t f = 0; f < surface->facets.size(); ++f) {
      std::array<Vec<D>, D> p;
      for (int k = 0; k < D; ++k) p[k] = surface->points[surface->facets[f][k]];
      const double size = facet_normal<D>(p).squaredNorm();
      const std::int32_t patch = facet_face_[f];
      if (size <= largest[patch]) continue;
      largest[patch] = size;
      planes_[patch] = {normals_[f], p[0], true};
    }
    for (std::size_t f = 0; f < surface->facets.size(); ++f) {
      Plane& plane = planes_[facet_face_[f]];
      for (auto v : surface->facets[f])
        if (std::abs(plane.normal.dot(surface->points[v] - plane.origin)) > plane_tolerance_)
          plane.planar = false;
    }

    std::vector<Vec<D>> corners;
    for (auto c : surface->corners) corners.push_back(surface->points[c]);
    std::sort(corners.begin(), corners.end(), lexicographic<D>);
    for (const auto& f : mesh.facets)
      for (NodeId n : f)
        if (std::binary_search(corners.begin(), corners.end(), mesh.points[n], lexicographic<D>))
          fixed_[n] = 1;

    if constexpr (D == 3) {
      const auto ridges = ridges_of<D>(surface->facets);
      std::vector<typename Features::Segment> segments;
      for (const auto& e : surface->feature_edges) {
        segments.push_back({surface->points[e[0]], surface->points[e[1]]});
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
      if (!segments.empty()) features_ = std::make_unique<Features>(std::move(segments));
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
std::optional<Nearest<D>> BoundaryModel<D>::nearest(const Vec<D>& x, double within) const {
  if constexpr (D < 4) {
    if (locator_) return locator_->nearest(x, within);
  }
  return std::nullopt;
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

template class BoundaryModel<2>;
template class BoundaryModel<3>;
template class BoundaryModel<4>;

}  // namespace lamella
