#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/bvh.h"
#include "core/geometry/surface.h"

namespace lamella {

/// Signed distance of a point to the boundary of a zone, and where it grows.
template <int D>
struct ZoneDistance {
  double distance = std::numeric_limits<double>::infinity();  ///< mm, negative inside
  Vec<D> normal = Vec<D>::Zero();  ///< unit gradient of the distance; zero where it has none
};

/// A subdomain omega of space (definition 6.1), known by its signed distance. Immutable and
/// thread-safe.
template <int D>
class Zone {
 public:
  virtual ~Zone() = default;
  /// The distance's absolute value is at most that to the boundary, and equal to it but outside of
  /// Voronoi cells, near holes of open surfaces and for zones made of others.
  virtual ZoneDistance<D> at(const Vec<D>& x) const = 0;
  double distance(const Vec<D>& x) const { return at(x).distance; }
  /// The same where it is below `reach` mm; farther from the boundary perhaps only a distance of
  /// the right sign between both, without a normal: cheaper.
  virtual ZoneDistance<D> within(const Vec<D>& x, double /*reach*/) const { return at(x); }
  /// Contains the zone; without end where the zone is.
  virtual Box<D> box() const = 0;
};
template <int D>
using ZonePtr = std::shared_ptr<const Zone<D>>;

/// How a surface tells inside from outside.
enum class Inside {
  normals,  ///< pseudo-normals: exact for closed surfaces that do not cross themselves
  winding   ///< winding number above 1/2: for open, crossing or doubled ones too (3D)
};
template <int D>
ZonePtr<D> surface_zone(const ReferenceSurface<D>& surface, Inside inside = Inside::normals);

template <int D>
ZonePtr<D> ball_zone(const Vec<D>& center, double radius);
/// The box [low, high].
template <int D>
ZonePtr<D> box_zone(const Vec<D>& low, const Vec<D>& high);
/// Where normal . x < offset; the normal has any length but zero.
template <int D>
ZonePtr<D> half_space_zone(const Vec<D>& normal, double offset);
/// The cylinder of flat ends between two points.
ZonePtr<3> cylinder_zone(const Vec<3>& from, const Vec<3>& to, double radius);
/// The points nearer to seeds[cell] than to any other seed.
template <int D>
ZonePtr<D> voronoi_zone(const std::vector<Vec<D>>& seeds, std::size_t cell);

/// What is in every one of the zones (a maximum of distances), in at least one (a minimum), and
/// outside of one. `zones` must not be empty.
template <int D>
ZonePtr<D> intersection_zone(std::vector<ZonePtr<D>> zones);
template <int D>
ZonePtr<D> union_zone(std::vector<ZonePtr<D>> zones);
template <int D>
ZonePtr<D> complement_zone(ZonePtr<D> zone);

}  // namespace lamella
