#include <algorithm>
#include <limits>

#include "core/geometry/foot.h"
#include "core/optimize/star_optimizer.h"

namespace lamella {
namespace {

/// Cosine below which a facet may not replace another: keeps ridges and folds.
constexpr double facet_turn = 0.8;
/// A facet must not look away from the surface it stands for.
constexpr double surface_turn = 0.4;
/// Of the tolerance: the height of facets below which their normals tell nothing.
constexpr double thin_share = 0.5;
/// Of the tolerance: nodes that are as near to a feature are on it.
constexpr double near_share = 0.1;

}  // namespace

/// What the boundary says of the node; false when it must stay as it is.
template <int D>
bool StarOptimizer<D>::node_site(NodeId s, BoundarySite& site) {
  site.a = s;
  site.anchor = topo_.points[s];
  site.boundary = !virtual_faces_.empty();
  if (!site.boundary) return true;
  collect_ring(s);
  if constexpr (D == 2)
    return ring_.size() == 2 && !model_.hard(ring_[0].tags[0], ring_[1].tags[0]);
  if constexpr (D == 3) {
    std::size_t features = 0;
    for (const auto& r : ring_) {
      if (r.count == 2 && !model_.hard(r.tags[0], r.tags[1])) continue;
      if (features == site.ends.size()) return false;
      site.ends[features++] = r.node;
    }
    site.on_feature = features == 2;
    site.stray = features != 0 && features != 2;
    return true;
  }
  return true;
}

/// What the boundary says of the edge; false when it must stay as it is.
template <int D>
bool StarOptimizer<D>::edge_site(NodeId s, NodeId n, BoundarySite& site) {
  site.a = s;
  site.b = n;
  site.anchor = 0.5 * (topo_.points[s] + topo_.points[n]);
  site.boundary = !virtual_faces_.empty();
  for (auto e : cavity_)
    if (topo_.is_virtual(e) ? model_.frozen_tag(topo_.label[e])
                            : model_.frozen_body(topo_.label[e]))
      return false;
  if (!site.boundary) return true;
  site.second = &topo_.points[s];
  // Around an edge of a surface two virtual elements, with two faces each.
  if constexpr (D == 3)
    site.on_feature =
        virtual_faces_.size() != 4 ||
        model_.hard(topo_.label[virtual_faces_[0].element], topo_.label[virtual_faces_[2].element]);
  if constexpr (D == 4)
    for (const auto& f : virtual_faces_)
      site.on_feature = site.on_feature ||
                        model_.hard(topo_.label[virtual_faces_[0].element], topo_.label[f.element]);
  return true;
}

template <int D>
void StarOptimizer<D>::collect_ring(NodeId s) {
  ring_.clear();
  for (const auto& f : virtual_faces_) {
    const std::int32_t tag = topo_.label[f.element];
    for (NodeId n : f.nodes) {
      if (n == 0 || n == s) continue;
      auto it =
          std::find_if(ring_.begin(), ring_.end(), [n](const RingNode& r) { return r.node == n; });
      if (it == ring_.end()) {
        ring_.push_back({n, {tag, tag}, 1});
      } else {
        if (it->count == 1) it->tags[1] = tag;
        ++it->count;
      }
    }
  }
}

/// Whether a stray node may join v: a feature goes on from where it was broken off, and features
/// that meet beside their corner meet there.
template <int D>
bool StarOptimizer<D>::takes_stray(NodeId v, const BoundarySite& site) const {
  if (site.ends[1] != 0)
    return fixed_[v] && (topo_.points[v] - site.anchor).norm() <= model_.tolerance();
  return v != site.ends[0] &&
         model_.nearest_feature(topo_.points[v], near_share * model_.tolerance());
}

template <int D>
std::optional<Vec<D>> StarOptimizer<D>::point_on_boundary(const Vec<D>& x, bool on_feature,
                                                          double reach) const {
  if (!model_.has_surface()) return x;
  // A mesh that does not lie on the surface yet must find it.
  const auto nearest = [this](double r, const auto& search) {
    auto p = search(r);
    if (!p && r < 2 * model_.first_deviation()) p = search(2 * model_.first_deviation());
    return p;
  };
  if (on_feature) {
    const auto p = nearest(reach, [&](double r) { return model_.nearest_feature(x, r); });
    if (!p) return std::nullopt;
    return (*p - x).norm() > flat_ ? *p : x;
  }
  const std::int32_t tag = topo_.label[virtual_faces_[0].element];
  const auto p = nearest(reach, [&](double r) { return model_.nearest(x, r, tag); });
  if (!p) return std::nullopt;
  return p->distance2 > flat_ * flat_ ? p->point : x;
}

/// Orthonormal directions in which the node may move, as the first columns of `basis`; returns how
/// many.
template <int D>
int StarOptimizer<D>::free_directions(const BoundarySite& site, Mat<D>& basis) const {
  if (!site.boundary) {
    basis.setIdentity();
    return D;
  }
  Mat<D> normals = Mat<D>::Zero();
  for (const auto& f : virtual_faces_) {
    const Facet nodes = Topology<D>::facet_of(topo_.elements[f.element]);
    std::array<Vec<D>, D> p;
    for (int k = 0; k < D; ++k) p[k] = topo_.points[nodes[k]];
    const Vec<D> n = facet_normal<D>(p);
    const double length2 = n.squaredNorm();
    if (length2 > 0) normals += n * n.transpose() / length2;
  }
  const Eigen::SelfAdjointEigenSolver<Mat<D>> solver(normals);
  basis = solver.eigenvectors();
  if constexpr (D == 4) {
    int free = 0;
    while (free < D && solver.eigenvalues()[free] < 1e-9 * solver.eigenvalues()[D - 1]) ++free;
    return free;
  }
  return site.on_feature ? 1 : D - 1;
}

/// How far the facets of the cavity lie from the surface.
template <int D>
double StarOptimizer<D>::star_deviation(const BoundarySite& site) const {
  double most = 0;
  for (auto e : cavity_) {
    if (!topo_.is_virtual(e)) continue;
    const Facet nodes = Topology<D>::facet_of(topo_.elements[e]);
    std::array<Vec<D>, D> p;
    int apex = 0;
    for (int k = 0; k < D; ++k) {
      p[k] = topo_.points[nodes[k]];
      if (nodes[k] == site.a) apex = k;
    }
    most = std::max(most, model_.deviation(p, apex, topo_.label[e], 2 * model_.first_deviation()));
  }
  return most;
}

/// How far the feature edges at the node or edge that is removed lie from those of the surface.
template <int D>
double StarOptimizer<D>::feature_deviation(const BoundarySite& site) const {
  double most = 0;
  for (NodeId n : site.ends) {
    if (n == 0) continue;
    const Vec<D> middle = 0.5 * (topo_.points[n] + site.anchor);
    const auto on = model_.nearest_feature(middle, 2 * model_.first_deviation());
    if (on) most = std::max(most, (*on - middle).norm());
  }
  // The middle of an edge that is split.
  if (site.b != 0)
    if (const auto on = model_.nearest_feature(site.anchor, 2 * model_.first_deviation()))
      most = std::max(most, (*on - site.anchor).norm());
  return most;
}

/// Whether the vertices of the surface within the chord tolerance of the old facets are within it
/// of the new ones, and those of its feature edges of the new feature edges: what the mesh covers
/// stays covered.
template <int D>
bool StarOptimizer<D>::keeps_vertices(const Apex& apex, const BoundarySite& site) {
  if constexpr (D < 4) {
    const double tol2 = model_.tolerance() * model_.tolerance();
    Vec<D> lo = Vec<D>::Constant(1e300), hi = -lo;
    const auto include = [&](const Vec<D>& x) {
      lo = lo.cwiseMin(x);
      hi = hi.cwiseMax(x);
    };
    const Vec<D> around = Vec<D>::Constant(model_.tolerance());
    const auto facet = [this](const Element& e) {
      const Facet nodes = Topology<D>::facet_of(e);
      std::array<Vec<D>, D> p;
      for (int k = 0; k < D; ++k) p[k] = topo_.points[nodes[k]];
      return p;
    };
    const auto near = [&](const std::array<Vec<D>, D>& p, const Vec<D>& x) {
      return (foot_on_facet(p, x).point - x).squaredNorm() <= tol2;
    };
    for (auto e : cavity_)
      if (topo_.is_virtual(e))
        for (const Vec<D>& x : facet(topo_.elements[e])) include(x);
    model_.vertices_in(lo - around, hi + around, vertices_);
    if (!vertices_.empty()) {
      new_facets_.clear();
      for (const auto& f : virtual_faces_) {
        if (apex.node != 0 && f.contains(apex.node)) continue;
        const Element& old = topo_.elements[f.element];
        auto p = facet(old);
        const Facet nodes = Topology<D>::facet_of(old);
        for (int k = 0; k < D; ++k)
          if (nodes[k] == old[f.place]) p[k] = apex.point;
        new_facets_.push_back(p);
      }
      for (const Vec<D>& x : vertices_) {
        if (std::any_of(new_facets_.begin(), new_facets_.end(),
                        [&](const auto& p) { return near(p, x); }))
          continue;
        for (auto e : cavity_)
          if (topo_.is_virtual(e) && near(facet(topo_.elements[e]), x)) return false;
      }
    }
    if (site.ends[0] == 0) return true;
    // The old feature edges; of an edge that is split, itself.
    lo = hi = site.anchor;
    for (NodeId n : site.ends)
      if (n != 0) include(topo_.points[n]);
    model_.feature_vertices_in(lo - around, hi + around, vertices_);
    const auto near_line = [&](const Vec<D>& middle, const Vec<D>& x) {
      return std::any_of(site.ends.begin(), site.ends.end(), [&](NodeId n) {
        return n != 0 &&
               (foot_on_segment<D>(topo_.points[n], middle, x).point - x).squaredNorm() <= tol2;
      });
    };
    for (const Vec<D>& x : vertices_)
      if (!near_line(apex.point, x) && near_line(site.anchor, x)) return false;
  }
  return true;
}

/// Whether the borders between groups around a node stay where they are when the apex takes its
/// place: it must lie in the span of each piece of border. In 3D features see to that.
template <int D>
bool StarOptimizer<D>::borders_allow(const Apex& apex, const BoundarySite& site) const {
  for (std::size_t i = 0; i < virtual_faces_.size(); ++i)
    for (std::size_t j = i + 1; j < virtual_faces_.size(); ++j) {
      const auto &f = virtual_faces_[i], &g = virtual_faces_[j];
      if (!model_.hard(topo_.label[f.element], topo_.label[g.element])) continue;
      std::array<Vec<D>, D> span;  // orthonormal directions from the node
      int common = 0;
      for (NodeId n : f.nodes) {
        if (n == 0 || !g.contains(n)) continue;
        Vec<D> e = topo_.points[n] - site.anchor;
        for (int k = 0; k < common; ++k) e -= span[k].dot(e) * span[k];
        span[common++] = e.normalized();
      }
      if (common != D - 2) continue;
      Vec<D> off = apex.point - site.anchor;
      for (int k = 0; k < common; ++k) off -= span[k].dot(off) * span[k];
      if (off.squaredNorm() > flat_ * flat_) return false;
    }
  return true;
}

/// Whether the boundary facets of an apex may replace those of the cavity. Where the mesh has yet
/// to be brought to the surface they need only be no farther from it than what they replace. Fills
/// retag_.
template <int D>
bool StarOptimizer<D>::boundary_allows(const Apex& apex, const BoundarySite& site) {
  const double tol = model_.tolerance(), lattice = model_.lattice_tolerance();
  if (boundary_within(apex, site, lattice, tol)) return true;
  if (!(model_.first_deviation() > lattice)) return false;
  const double deviation = star_deviation(site), feature = feature_deviation(site);
  if (deviation <= lattice && feature <= tol) return false;
  return boundary_within(apex, site, std::max(lattice, deviation), std::max(tol, feature));
}

/// Whether a facet of tag t with this normal looks away from the surface at its nearest point.
template <int D>
bool StarOptimizer<D>::looks_away(const Nearest<D>& at, const Vec<D>& normal,
                                  std::int32_t t) const {
  return model_.tag(t).side * model_.normal(at.facet).dot(normal) < surface_turn;
}

/// The new boundary facets of an apex against the surface: nowhere turned, near the anchor
/// that is removed, and within the limit of the original surface; so must the feature
/// edges from the apex to its ends be. Fills retag_.
template <int D>
bool StarOptimizer<D>::boundary_within(const Apex& apex, const BoundarySite& site, double limit,
                                       double feature_limit) {
  const Vec<D>& anchor = site.anchor;
  const double tol = model_.tolerance();
  const bool ends = site.ends[0] != 0;
  if (D == 4 && site.b == 0 && !borders_allow(apex, site)) return false;
  const std::size_t count = virtual_faces_.size();
  retag_.resize(count);
  bool flat = !site.stray, one_tag = true, planar = true;
  for (std::size_t i = 0; i < count; ++i) {
    retag_[i] = topo_.label[virtual_faces_[i].element];
    one_tag = one_tag && retag_[i] == retag_[0];
  }
  // Beyond the tolerance this only bounds what is looked at: a facet that rises to the surface lies
  // above the middle of the edge it replaces by more than its own deviation.
  const double most_height = limit > model_.tolerance() ? 2 * limit : model_.tolerance();
  if (ends) {
    // The removed node must lie on the new feature line; facets alone do not tell, as all those on
    // one side of the line may vanish.
    double off2 = std::numeric_limits<double>::infinity();
    for (NodeId n : site.ends) {
      if (n == 0 || n == apex.node) continue;
      const Vec<D> e = topo_.points[n] - apex.point;
      const double t = std::clamp((anchor - apex.point).dot(e) / e.squaredNorm(), 0.0, 1.0);
      off2 = std::min(off2, (anchor - apex.point - t * e).squaredNorm());
    }
    if (off2 > feature_limit * feature_limit) return false;
    if (off2 > flat_ * flat_) flat = false;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto& f = virtual_faces_[i];
    if (apex.node != 0 && f.contains(apex.node)) continue;
    const Element& old = topo_.elements[f.element];
    const Facet nodes = Topology<D>::facet_of(old);
    std::array<Vec<D>, D> p, q;
    double size2 = 0;
    for (int k = 0; k < D; ++k) {
      p[k] = topo_.points[nodes[k]];
      q[k] = nodes[k] == old[f.place] ? apex.point : p[k];
      size2 = std::max({size2, (q[k] - q[0]).squaredNorm(), (p[k] - p[0]).squaredNorm()});
    }
    const Vec<D> before = facet_normal<D>(p);
    const Vec<D> after = facet_normal<D>(q);
    const double nb = before.norm(), na = after.norm();
    double scale = 1;
    for (int k = 0; k < D - 1; ++k) scale *= std::sqrt(size2);
    if (na <= 1e-10 * scale) return false;
    // Facets thinner than what nodes may be off the surface look anywhere.
    const double thin = model_.has_surface() && D == 3 ? thin_share * tol : 0;
    const bool known = nb > std::max(1e-6 * scale, thin * std::sqrt(size2));
    const double turn = known ? before.dot(after) / (nb * na) : 1;
    if (turn < facet_turn) return false;
    const double height = std::abs(after.dot(anchor - apex.point)) / na;
    double flat_height = height;
    if (site.second)
      flat_height = std::max(flat_height, std::abs(after.dot(*site.second - apex.point)) / na);
    if (!known || flat_height > flat_) flat = false;
    if (height > most_height) return false;
    for (int k = 0; k < D && planar; ++k) planar = model_.in_plane(retag_[i], q[k]);
  }
  // Flat facets over a curved face were tested at their own points only: new ones are tested again.
  if (flat && ((one_tag && planar) || !model_.has_surface())) return true;
  if (!model_.has_surface()) return false;
  if (!flat && !keeps_vertices(apex, site)) return false;

  for (std::size_t i = 0; i < count; ++i) {
    const auto& f = virtual_faces_[i];
    if (apex.node != 0 && f.contains(apex.node)) continue;
    const Element& old = topo_.elements[f.element];
    const Facet nodes = Topology<D>::facet_of(old);
    std::array<Vec<D>, D> q;
    Vec<D> center = Vec<D>::Zero();
    int top = 0;
    for (int k = 0; k < D; ++k) {
      if (nodes[k] == old[f.place]) top = k;
      q[k] = nodes[k] == old[f.place] ? apex.point : topo_.points[nodes[k]];
      center += q[k] / D;
    }
    const Vec<D> normal = facet_normal<D>(q).normalized();
    const auto at = model_.nearest(center, limit, retag_[i]);
    if (!at) return false;
    if (!flat && looks_away(*at, normal, retag_[i])) {
      // As where the surface has details below the tolerance; what does so already may go on.
      std::array<Vec<D>, D> p = q;
      p[top] = topo_.points[old[f.place]];
      Vec<D> middle = Vec<D>::Zero();
      for (const Vec<D>& x : p) middle += x / D;
      const auto before = model_.nearest(middle, limit, retag_[i]);
      if (!before || !looks_away(*before, facet_normal<D>(p).normalized(), retag_[i])) return false;
    }
    if (!one_tag) {
      const std::int32_t t = model_.tag_on(retag_[i], at->facet);
      if (!model_.hard(t, retag_[i])) retag_[i] = t;
    }
    if (!(flat && planar) && model_.deviation(q, top, retag_[i], limit) > limit) return false;
  }
  if (!flat && ends)
    for (NodeId n : site.ends)
      if (n != 0 && n != apex.node &&
          !model_.nearest_feature(0.5 * (apex.point + topo_.points[n]), feature_limit))
        return false;
  return true;
}

/// No boundary edge of the new star may exist elsewhere already: the boundary would touch itself.
template <int D>
bool StarOptimizer<D>::topology_allows(const Apex& apex, const BoundarySite& site) const {
  if (apex.node == 0) return true;
  // Part of its surroundings may lie in another block.
  if (locked(apex.node)) return false;
  for (auto e : topo_.around.of(apex.node)) {
    if (!topo_.is_virtual(e)) continue;
    const Element& nodes = topo_.elements[e];
    const bool inside =
        Topology<D>::has(nodes, site.a) && (site.b == 0 || Topology<D>::has(nodes, site.b));
    if (inside) continue;
    for (NodeId x : nodes) {
      if (x == 0 || x == apex.node) continue;
      for (const auto& f : virtual_faces_) {
        if (f.contains(apex.node) || !f.contains(x)) continue;
        // x is joined anew to the apex unless an old facet of the cavity already joins them.
        bool joined = false;
        for (const auto& g : virtual_faces_)
          joined = joined || (Topology<D>::has(topo_.elements[g.element], x) &&
                              Topology<D>::has(topo_.elements[g.element], apex.node));
        if (!joined) return false;
      }
    }
  }
  return true;
}

#define LAMELLA_INSTANTIATE(D)                                                                    \
  template bool StarOptimizer<D>::node_site(NodeId, BoundarySite&);                               \
  template bool StarOptimizer<D>::edge_site(NodeId, NodeId, BoundarySite&);                       \
  template bool StarOptimizer<D>::takes_stray(NodeId, const BoundarySite&) const;                 \
  template std::optional<Vec<D>> StarOptimizer<D>::point_on_boundary(const Vec<D>&, bool, double) \
      const;                                                                                      \
  template int StarOptimizer<D>::free_directions(const BoundarySite&, Mat<D>&) const;             \
  template bool StarOptimizer<D>::boundary_allows(const Apex&, const BoundarySite&);              \
  template bool StarOptimizer<D>::topology_allows(const Apex&, const BoundarySite&) const;
LAMELLA_INSTANTIATE(2)
LAMELLA_INSTANTIATE(3)
LAMELLA_INSTANTIATE(4)
#undef LAMELLA_INSTANTIATE

}  // namespace lamella
