#pragma once

#include "core/multidomain/zone.h"

namespace lamella {

/// A border between regions near a point.
template <int D>
struct Border {
  int zone = -1;       ///< whose boundary it is
  ZoneDistance<D> of;  ///< distance >= 0, the normal towards the other side
};

/// A named subdomain of a partition.
template <int D>
struct Region {
  std::string name;
  ZonePtr<D> zone;
};

/// Space divided among regions: a point belongs to the first that contains it, and to the
/// background, which is the last region, when none does. Regions are given by falling priority, so
/// that bodies may overlap. Immutable and thread-safe.
template <int D>
class Partition {
 public:
  explicit Partition(std::vector<Region<D>> regions, std::string background = "background");

  /// Regions and background.
  int count() const { return static_cast<int>(regions_.size()) + 1; }
  int background() const { return count() - 1; }
  std::vector<std::string> names() const;  ///< the background's last
  /// The zone as it was given, whatever lies over it. `region` is not the background.
  const Zone<D>& zone(int region) const { return *regions_[region].zone; }
  const Box<D>& box(int region) const { return boxes_[region]; }

  /// A point that rounding puts on the border of regions without anything between them belongs to
  /// one of them.
  int region_of(const Vec<D>& x) const;
  /// Signed distance to the part of the region that is its own, max(phi_k, -min phi_j) with the j
  /// of higher priority. Beyond the zone's own box by more than `reach` mm a positive lower bound.
  ZoneDistance<D> at(int region, const Vec<D>& x,
                     double reach = std::numeric_limits<double>::infinity()) const;
  double distance(int region, const Vec<D>& x) const { return at(region, x).distance; }
  /// Distance (>= 0) to the nearest border between two regions, the normal towards its other side;
  /// beyond `reach` a lower bound.
  ZoneDistance<D> border(const Vec<D>& x,
                         double reach = std::numeric_limits<double>::infinity()) const;
  /// The borders of all zones nearer than `reach`, each once, unless hidden under a region of
  /// higher priority; the normals as those of `border`. `found` is overwritten.
  void borders(const Vec<D>& x, double reach, std::vector<Border<D>>& found) const;
  /// Signed distance of the zone itself; where it is `reach` or more perhaps a bound of its sign.
  ZoneDistance<D> zone_at(int region, const Vec<D>& x, double reach) const;

 private:
  std::vector<Region<D>> regions_;
  std::string background_;
  std::vector<Box<D>> boxes_;
};

}  // namespace lamella
