#pragma once

#include "core/geometry/locator.h"

namespace lamella {

/// Ball inside the body that touches the surface on opposite sides: its diameter is the local
/// thickness.
struct MedialBall {
  Vec<3> center;
  double radius = 0;        ///< mm, distance of the center to the surface
  std::int32_t facet = -1;  ///< a nearest facet
  int rounds = 0;           ///< climbing steps taken
  /// Unit, from one contact to the other where there are two that face each other, else zero.
  Vec<3> across = Vec<3>::Zero();
};

/// The medial ball reached by climbing away from the surface, starting at x or, when x is not well
/// inside, just below its foot. The answer depends on the surface only.
///
/// Contacts are facets, re-measured at every step. They count as opposite when the hull of their
/// directions comes nearer than 0.26 to the center: walls meeting at less than about 30 degrees are
/// one thin wall. The surface must not be empty.
MedialBall climb_to_medial_ball(const Locator<3>& surface, const Vec<3>& x);

/// The balls that a place is judged by: the one climbed to from x, but at a re-entrant edge of the
/// surface one for each wall that ends there, climbed to from just below it. The surface must not
/// be empty.
std::vector<MedialBall> medial_balls(const Locator<3>& surface, const Vec<3>& x);

/// The point of the convex hull of the given points that is nearest to the origin.
Vec<3> smallest_in_hull(const std::vector<Vec<3>>& points);

}  // namespace lamella
