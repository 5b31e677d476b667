#pragma once

#include <optional>

#include "core/geometry/locator.h"
#include "core/multidomain/partition.h"

namespace lamella {

/// What a point of a mesh must stay on: planes through where it is, and borders of zones.
struct Hold {
  Vec<3> origin = Vec<3>::Zero();
  std::vector<Vec<3>> planes;  ///< unit normals
  std::vector<int> zones;

  bool free() const { return planes.empty() && zones.empty(); }
  void add_plane(const Vec<3>& normal);
  void add_zone(int zone);
  /// Whether x lies on all of them within `tolerance` mm.
  bool allows(const Partition<3>& partition, const Vec<3>& x, double tolerance) const;
  /// The point that all have in common near x, by Newton's method; nothing when it is not found.
  std::optional<Vec<3>> settle(const Partition<3>& partition, Vec<3> x, double tolerance) const;
};

/// The point, on the borders of the first `zones` zones where they are as near as `reach` mm.
Vec<3> onto_borders(const Partition<3>& partition, int zones, Vec<3> x, double reach);

/// The point, on the wall where that is as near as `reach` mm; it stays on the borders that it lies
/// on within `on` mm where they go there.
Vec<3> onto_wall(const Locator<3>& wall, const Partition<3>& partition, const Vec<3>& x,
                 double reach, double on);

}  // namespace lamella
