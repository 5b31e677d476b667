#include "core/optimize/generate_voids.h"

#include <algorithm>
#include <map>
#include <set>

#include "core/geometry/bvh.h"
#include "core/geometry/locator.h"
#include "core/geometry/self_intersection.h"
#include "core/mesh/boundary.h"
#include "core/optimize/certificate.h"
#include "core/optimize/generate_bridge.h"

namespace lamella {
namespace {

using Facet = SimplexMesh<3>::Facet;
using Element = SimplexMesh<3>::Element;

constexpr int kAttemptsOfBody = 6;
constexpr int kAttemptsTried = 2, kMostAttempts = 6;
constexpr int kHolesTried = 3, kMostHoles = 14;
constexpr std::size_t kStarts = 10;      // elements that a void's growth may begin with
constexpr std::size_t kSmallVoid = 500;  // facets
constexpr double kMargin = 0.3;          // of a void's diagonal: elements as near may be cut out
constexpr double kShrink = 1e-6;
constexpr double kTouch = 1e-9;  // of the element's size: what is as near counts as met

/// Whether a plane normal to a face, or to an edge of each, lies between them.
bool apart(const std::array<Vec<3>, 3>& triangle, const std::array<Vec<3>, 4>& element) {
  const double size = (element[1] - element[0]).norm() + (element[2] - element[0]).norm();
  const auto splits = [&](const Vec<3>& axis) {
    const double length = axis.norm();
    if (!(length > 0)) return false;
    double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
    const auto take = [&](int side, const Vec<3>& p) {
      const double t = axis.dot(p - element[0]);
      low[side] = std::min(low[side], t);
      high[side] = std::max(high[side], t);
    };
    for (const Vec<3>& p : triangle) take(0, p);
    for (const Vec<3>& p : element) take(1, p);
    return std::max(low[0] - high[1], low[1] - high[0]) > kTouch * size * length;
  };
  std::array<Vec<3>, 3> sides;
  for (int k = 0; k < 3; ++k) sides[k] = triangle[(k + 1) % 3] - triangle[k];
  if (splits(sides[0].cross(sides[1]))) return true;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) {
      const Vec<3> edge = element[j] - element[i];
      for (int k = j + 1; k < 4; ++k)
        if (splits(edge.cross(element[k] - element[i]))) return true;
      for (const Vec<3>& side : sides)
        if (splits(edge.cross(side))) return true;
    }
  return false;
}

class AroundVoids {
 public:
  AroundVoids(const ReferenceSurface<3>& surface, const FillSurface& fill)
      : surface_(surface), fill_(fill) {
    mesh_.points.assign(1, Vec<3>::Zero());
    mesh_.points.insert(mesh_.points.end(), surface.points.begin(), surface.points.end());
    for (auto f : surface.facets) {
      for (auto& n : f) ++n;
      mesh_.facets.push_back(f);
    }
  }

  Result<SimplexMesh<3>> run(const Progress& progress) {
    std::vector<int> shell_of;
    std::vector<std::vector<Facet>> shells(number_shells<3>(mesh_.facets, shell_of));
    for (std::size_t f = 0; f < shell_of.size(); ++f)
      shells[shell_of[f]].push_back(mesh_.facets[f]);
    const auto voids = std::stable_partition(shells.begin(), shells.end(),
                                             [&](const auto& s) { return bounds(s); });
    if (voids - shells.begin() != 1)
      return Error{Code::failed, "The surface is not that of one body with voids.", ""};
    if (Result<void> done = fill(shells[0], kAttemptsOfBody, progress.portion(0, 0.3)); !done)
      return done.error();
    for (std::size_t s = 1; s < shells.size(); ++s) {
      const auto at = static_cast<double>(s - 1) / static_cast<double>(shells.size() - 1);
      if (Result<void> done =
              insert_void(shells[s], progress.portion(0.3 + 0.7 * at, 0.3 + 0.7 * at));
          !done)
        return done.error();
      progress.report(0.3 + 0.7 * at);
    }
    drop_unused();
    mesh_.element_body.assign(mesh_.elements.size(), 0);
    mesh_.facet_group.assign(mesh_.facets.size(), 0);
    mesh_.facet_face = surface_.facet_face;
    return std::move(mesh_);
  }

 private:
  struct Local {
    ReferenceSurface<3> surface;
    std::vector<NodeId> global{0};  // [node of a mesh of the surface]
  };

  Local local(const std::vector<Facet>& facets) const {
    Local out;
    for (const Facet& f : facets) out.global.insert(out.global.end(), f.begin(), f.end());
    std::sort(out.global.begin(), out.global.end());
    out.global.erase(std::unique(out.global.begin(), out.global.end()), out.global.end());
    for (std::size_t k = 1; k < out.global.size(); ++k)
      out.surface.points.push_back(mesh_.points[out.global[k]]);
    for (Facet f : facets) {
      for (NodeId& n : f)
        n = static_cast<NodeId>(std::lower_bound(out.global.begin(), out.global.end(), n) -
                                out.global.begin() - 1);
      out.surface.facets.push_back(f);
    }
    out.surface.facet_face.assign(facets.size(), 0);
    out.surface.faces.resize(1);
    return out;
  }

  /// Whether a shell has its inside on the inner side, unlike a void.
  bool bounds(const std::vector<Facet>& shell) const {
    return domain_measure<3>(local(shell).surface) > 0;
  }

  /// Adds the elements that fill what the facets bound.
  Result<void> fill(const std::vector<Facet>& facets, int attempts, const Progress& progress) {
    if (facets.empty()) return {};
    std::vector<int> shell_of;
    if (const int shells = number_shells<3>(facets, shell_of); shells > 1) {
      std::vector<std::vector<Facet>> pieces(shells);
      for (std::size_t f = 0; f < facets.size(); ++f) pieces[shell_of[f]].push_back(facets[f]);
      if (std::ranges::all_of(pieces, [&](const auto& p) { return bounds(p); })) {
        for (const auto& piece : pieces)
          if (Result<void> done = fill(piece, attempts, progress); !done) return done;
        return {};
      }
    }
    Local part = local(facets);
    if (Result<void> closed = check_boundary<3>(part.surface); !closed) return closed.error();
    if (find_self_intersections(part.surface).pairs > 0)
      return Error{Code::failed, "The surface of a hole crosses itself.", ""};
    Result<SimplexMesh<3>> found = fill_(part.surface, attempts, progress);
    if (!found) return found.error();
    for (std::size_t k = part.global.size(); k < found->points.size(); ++k) {
      part.global.push_back(static_cast<NodeId>(mesh_.points.size()));
      mesh_.points.push_back(found->points[k]);
    }
    for (Element e : found->elements) {
      for (NodeId& n : e) n = part.global[n];
      mesh_.elements.push_back(e);
    }
    return {};
  }

  /// Marks the elements that a solid meets or that lie in it.
  std::vector<char> met_by(const ReferenceSurface<3>& solid) const {
    Box<3> box;
    for (const Vec<3>& p : solid.points) box.add(p);
    const Locator<3> locator(solid);
    std::vector<char> out(mesh_.elements.size(), 0);
    std::vector<Nearest<3>> near;
    for (std::size_t e = 0; e < out.size(); ++e) {
      const auto corners = mesh_.corners(mesh_.elements[e]);
      Box<3> own;
      Vec<3> middle = Vec<3>::Zero();
      for (const Vec<3>& p : corners) own.add(p), middle += p / 4;
      if ((own.lo - box.hi).maxCoeff() > 0 || (box.lo - own.hi).maxCoeff() > 0) continue;
      double radius = 0;
      for (const Vec<3>& p : corners) radius = std::max(radius, (p - middle).norm());
      locator.all_within(middle, (1 + 1e-6) * radius, near);
      out[e] = std::any_of(near.begin(), near.end(), [&](const Nearest<3>& n) {
        const auto& f = solid.facets[n.facet];
        return !apart({solid.points[f[0]], solid.points[f[1]], solid.points[f[2]]}, corners);
      });
      if (!out[e]) out[e] = locator.inside(middle);
    }
    return out;
  }

  /// The facets around the marked elements. Where these touch themselves at an edge, the other
  /// elements at it are marked, too: the facets are a closed surface, or there is nothing to mark.
  std::vector<Facet> facets_around(std::vector<char>& hole) const {
    while (true) {
      std::vector<Element> cut;
      for (std::size_t e = 0; e < hole.size(); ++e)
        if (hole[e]) cut.push_back(mesh_.elements[e]);
      std::vector<Facet> facets;
      std::vector<std::array<NodeId, 2>> edges;
      for (const auto& face : boundary_faces<3>(cut, mesh_.points.size())) {
        facets.push_back(face.facet);
        for (int k = 0; k < 3; ++k) {
          const auto [low, high] = std::minmax({face.facet[k], face.facet[(k + 1) % 3]});
          edges.push_back({low, high});
        }
      }
      std::sort(edges.begin(), edges.end());
      std::vector<std::array<NodeId, 2>> touching;
      for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
        while (j < edges.size() && edges[j] == edges[i]) ++j;
        if (j - i > 2) touching.push_back(edges[i]);
      }
      bool marked = false;
      for (std::size_t e = 0; e < hole.size() && !touching.empty(); ++e) {
        const auto has = [&](NodeId n) { return std::ranges::count(mesh_.elements[e], n) > 0; };
        if (hole[e] ||
            !std::ranges::any_of(touching, [&](const auto& t) { return has(t[0]) && has(t[1]); }))
          continue;
        hole[e] = marked = true;
      }
      if (!marked) return facets;
    }
  }

  /// Marks what shares a face with the marked elements.
  void grow(std::vector<char>& hole, std::vector<Facet> facets) const {
    for (Facet& f : facets) std::ranges::sort(f);
    std::ranges::sort(facets);
    for (std::size_t e = 0; e < hole.size(); ++e)
      for (int k = 0; k < 4 && !hole[e]; ++k) {
        Facet f = opposite_facet<3>(mesh_.elements[e], k);
        std::ranges::sort(f);
        hole[e] = std::ranges::binary_search(facets, f);
      }
  }

  /// Fills a hole around a solid, given by its facets wound into it, anew; in a larger hole where
  /// that fails.
  Result<void> insert(const std::vector<Facet>& facets, std::vector<char> hole, int holes,
                      int attempts, const Progress& progress) {
    Result<void> last;
    for (int size = 0; size < holes; ++size) {
      if (progress.cancelled()) return cancelled_error();
      std::vector<Facet> around = facets_around(hole);
      std::vector<Element> kept;
      for (std::size_t e = 0; e < hole.size(); ++e)
        if (!hole[e]) kept.push_back(mesh_.elements[e]);
      mesh_.elements.swap(kept);
      last = fill(without_pairs(around, facets), attempts, progress);
      if (last.ok()) return last;
      mesh_.elements.swap(kept);
      grow(hole, std::move(around));
    }
    return last;
  }

  /// All facets, but those that come with both windings: there one side closes the other.
  static std::vector<Facet> without_pairs(std::vector<Facet> a, const std::vector<Facet>& b) {
    std::map<Facet, std::size_t> place;
    const auto key = [](Facet f) { return std::ranges::sort(f), f; };
    for (std::size_t i = 0; i < a.size(); ++i) place[key(a[i])] = i;
    std::vector<char> closed(a.size(), 0);
    const std::size_t own = a.size();
    for (const Facet& f : b) {
      const auto at = place.find(key(f));
      if (at == place.end())
        a.push_back(f);
      else
        closed[at->second] = 1;
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (i >= own || !closed[i]) a[kept++] = a[i];
    a.resize(kept);
    return a;
  }

  Result<void> insert_void(const std::vector<Facet>& shell, const Progress& progress) {
    Local inside = local(shell);
    for (auto& f : inside.surface.facets) std::swap(f[0], f[1]);
    const std::vector<Element> far = set_aside(inside.surface.points);
    const auto whole = [&] { return insert(shell, met_by(inside.surface), 1, 1, progress); };
    const auto by_parts = [&] { return insert_by_parts(inside, progress); };
    const bool small = shell.size() <= kSmallVoid;
    Result<void> done = small ? by_parts() : whole();
    if (!done && !progress.cancelled()) done = small ? whole() : by_parts();
    mesh_.elements.insert(mesh_.elements.end(), far.begin(), far.end());
    return done;
  }

  /// Takes what is far from some points out of the mesh, which the search for elements then spares.
  std::vector<Element> set_aside(const std::vector<Vec<3>>& points) {
    Box<3> box;
    for (const Vec<3>& p : points) box.add(p);
    const Vec<3> margin = Vec<3>::Constant(kMargin * (box.hi - box.lo).norm());
    std::vector<Element> far, near;
    for (const Element& e : mesh_.elements) {
      Box<3> own;
      for (const NodeId n : e) own.add(mesh_.points[n]);
      const bool apart =
          (own.lo - box.hi - margin).maxCoeff() > 0 || (box.lo - own.hi - margin).maxCoeff() > 0;
      (apart ? far : near).push_back(e);
    }
    mesh_.elements.swap(near);
    return far;
  }

  /// A void that divides its hole nearly in two has a topology of its own that no star mends:
  /// filled with tetrahedra, it grows from one of them, and no step has a shell inside another.
  Result<void> insert_by_parts(Local& inside, const Progress& progress) {
    Result<SimplexMesh<3>> filling = fill_(inside.surface, kAttemptsOfBody, progress);
    if (!filling) return filling.error();
    for (std::size_t k = inside.global.size(); k < filling->points.size(); ++k) {
      inside.global.push_back(static_cast<NodeId>(mesh_.points.size()));
      mesh_.points.push_back(filling->points[k]);
    }
    for (Element& e : filling->elements)
      for (NodeId& n : e) n = inside.global[n];
    const std::vector<Element> before = mesh_.elements;
    Result<void> grown = Error{Code::failed, "A void is flat.", ""};
    for (std::size_t start = 0; start < std::min(filling->elements.size(), kStarts); ++start) {
      grown = take_out_all(filling->elements, start, progress);
      if (grown.ok() || progress.cancelled()) return grown;
      mesh_.elements = before;
    }
    return grown;
  }

  /// Takes the elements of a void's filling out, one after the other, from `start` on. Each leaves
  /// those before it and itself with a closed surface; one that fails is put off until others are
  /// out, and what has no order of that kind goes at once.
  Result<void> take_out_all(const std::vector<Element>& elements, std::size_t start,
                            const Progress& progress) {
    std::set<Facet> front;  // of those before, sorted nodes
    std::set<std::array<NodeId, 2>> edges;
    std::vector<Element> left = elements;
    std::rotate(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(start), left.end());
    if (Result<void> first = take_out({left[0]}, kHolesTried, progress); !first) return first;
    for (std::size_t out = 0; out < left.size();) {
      for (int k = 0; k < 4; ++k) {
        Facet f = opposite_facet<3>(left[out], k);
        std::ranges::sort(f);
        if (!front.insert(f).second) front.erase(f);
        for (int j = 0; j < k; ++j) edges.insert(sorted_pair(left[out][j], left[out][k]));
      }
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(out));
      if (left.empty()) return {};
      std::vector<std::pair<int, std::size_t>> next;  // what closes most goes first
      for (std::size_t e = 0; e < left.size(); ++e)
        if (const int closed = faces_closed(left[e], front, edges); closed > 0)
          next.emplace_back(-closed, e);
      std::ranges::sort(next);
      out = left.size();
      for (const int holes : {kHolesTried, kMostHoles})
        for (std::size_t k = 0; k < next.size() && out == left.size(); ++k) {
          if (take_out({left[next[k].second]}, holes, progress).ok()) out = next[k].second;
          if (progress.cancelled()) return cancelled_error();
        }
    }
    return take_out(left, kMostHoles, progress);
  }

  static std::array<NodeId, 2> sorted_pair(NodeId a, NodeId b) {
    return {std::min(a, b), std::max(a, b)};
  }

  /// Faces that an element shares with those before it; 0 where an edge of it on none of these is
  /// there already: the surface would touch itself.
  static int faces_closed(const Element& e, const std::set<Facet>& front,
                          const std::set<std::array<NodeId, 2>>& edges) {
    std::array<bool, 4> closes;
    for (int k = 0; k < 4; ++k) {
      Facet f = opposite_facet<3>(e, k);
      std::ranges::sort(f);
      closes[k] = front.contains(f);
    }
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j) {
        bool closed = false;  // the faces at an edge are those opposite the other two nodes
        for (int k = 0; k < 4; ++k) closed |= k != i && k != j && closes[k];
        if (!closed && edges.contains(sorted_pair(e[i], e[j]))) return 0;
      }
    return static_cast<int>(std::ranges::count(closes, true));
  }

  Result<void> take_out(const std::vector<Element>& elements, int holes, const Progress& progress) {
    std::vector<char> hole(mesh_.elements.size(), 0);
    for (const Element& e : elements) {
      // A little smaller, it meets no element that only touches it.
      ReferenceSurface<3> small;
      Vec<3> middle = Vec<3>::Zero();
      for (const NodeId n : e) middle += mesh_.points[n] / 4;
      for (const NodeId n : e)
        small.points.push_back(middle + (1 - kShrink) * (mesh_.points[n] - middle));
      for (int k = 0; k < 4; ++k) small.facets.push_back(opposite_facet<3>(Element{0, 1, 2, 3}, k));
      small.facet_face.assign(4, 0);
      small.faces.resize(1);
      const std::vector<char> met = met_by(small);
      for (std::size_t i = 0; i < hole.size(); ++i) hole[i] = hole[i] || met[i];
    }
    std::vector<Facet> facets;
    for (const auto& face : boundary_faces<3>(elements, mesh_.points.size())) {
      facets.push_back(face.facet);
      std::swap(facets.back()[0], facets.back()[1]);
    }
    return insert(facets, std::move(hole), holes,
                  holes == kMostHoles ? kMostAttempts : kAttemptsTried, progress);
  }

  /// Nodes inside that were cut out with their elements; those of the surface stay.
  void drop_unused() {
    std::vector<NodeId> number(mesh_.points.size(), 0);
    const auto surface_end = static_cast<NodeId>(surface_.points.size()) + 1;
    for (NodeId n = 0; n < surface_end; ++n) number[n] = n;
    for (const Element& e : mesh_.elements)
      for (const NodeId n : e)
        if (n >= surface_end) number[n] = 1;
    NodeId next = surface_end;
    for (NodeId n = surface_end; n < static_cast<NodeId>(number.size()); ++n) {
      if (!number[n]) continue;
      number[n] = next;
      mesh_.points[next++] = mesh_.points[n];
    }
    mesh_.points.resize(next);
    for (Element& e : mesh_.elements)
      for (NodeId& n : e) n = number[n];
  }

  const ReferenceSurface<3>& surface_;
  const FillSurface& fill_;
  SimplexMesh<3> mesh_;
};

}  // namespace

Result<SimplexMesh<3>> generate_around_voids(const ReferenceSurface<3>& surface,
                                             const FillSurface& fill, const Progress& progress) {
  return AroundVoids(surface, fill).run(progress);
}

}  // namespace lamella
