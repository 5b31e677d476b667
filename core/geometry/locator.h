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
  /// Nearest among the facets of one CAD face.
  std::optional<Nearest<D>> nearest_on_face(const Vec<D>& x, std::int32_t face) const;
  /// First facet hit from x along the unit direction u, leaving the body only (normal . u > 0),
  /// farther than t_min.
  std::optional<RayHit> exit(const Vec<D>& x, const Vec<D>& u, double t_min = 0) const;
  /// Distance to the surface, negative inside, by pseudo-normals at edges and vertices.
  double signed_distance(const Vec<D>& x) const;
  bool inside(const Vec<D>& x) const { return signed_distance(x) < 0; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lamella
