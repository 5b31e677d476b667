#pragma once

#include <memory>
#include <optional>

#include "core/geometry/surface.h"

namespace lamella {

/// Nearest point of a surface.
template <int D>
struct Nearest {
  Vec<D> point;
  std::int32_t facet = -1;
  double distance2 = 0;  ///< mm^2
};

/// Nearest point with the side of the surface the query lies on.
template <int D>
struct SignedNearest {
  Nearest<D> foot;
  Vec<D> pseudo_normal;  ///< unit, outward: of the facet, edge or vertex the foot lies on
  double distance = 0;   ///< mm, negative inside
};

struct RayHit {
  double t = 0;  ///< distance along the unit direction, mm
  std::int32_t facet = -1;
};

/// Bounding volume hierarchy over the facets of a surface (D = 2: segments, 3: triangles).
/// Keeps its own copy of what it needs. Immutable and thread-safe after construction.
template <int D>
class Locator {
 public:
  explicit Locator(const ReferenceSurface<D>& surface);
  ~Locator();
  Locator(Locator&&) noexcept;

  /// Nearest facet; `within` bounds the search (nullopt when nothing is that near).
  std::optional<Nearest<D>> nearest(const Vec<D>& x, double within = 1e300) const;
  /// Every facet nearer than `radius`, each with its nearest point, by growing distance (then by
  /// facet). `found` is overwritten.
  void all_within(const Vec<D>& x, double radius, std::vector<Nearest<D>>& found) const;
  /// Nearest point of one facet.
  Nearest<D> nearest_on_facet(const Vec<D>& x, std::int32_t facet) const;
  /// Nearest among the facets of one CAD face.
  std::optional<Nearest<D>> nearest_on_face(const Vec<D>& x, std::int32_t face) const;
  /// First facet hit from x along the unit direction u, leaving the body only (normal . u > 0),
  /// farther than t_min and nearer than t_max. Rays cannot slip between facets that share vertices.
  std::optional<RayHit> exit(const Vec<D>& x, const Vec<D>& u, double t_min = 0,
                             double t_max = 1e300) const;
  /// Nearest point and signed distance. The sign comes from pseudo-normals: the normal of the
  /// facet, the sum of the facets' at an edge, the angle-weighted sum at a vertex. The surface must
  /// have at least one facet.
  SignedNearest<D> signed_nearest(const Vec<D>& x) const;
  /// Distance to the surface, negative inside; +infinity when the surface has no facet.
  double signed_distance(const Vec<D>& x) const;
  bool inside(const Vec<D>& x) const { return signed_distance(x) < 0; }
  /// Unit outward normal of a facet; zero for a facet without measure.
  Vec<D> normal(std::int32_t facet) const;
  /// Diagonal of the surface's box, mm.
  double diagonal() const;
  bool empty() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lamella
