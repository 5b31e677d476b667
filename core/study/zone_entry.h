#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/multidomain/zone.h"

namespace lamella {

/// Shapes of a zone that is no file but a formula. Lengths in mm.
struct ZoneBall {
  Vec<3> center = Vec<3>::Zero();
  double radius = 0;  ///< > 0

  bool operator==(const ZoneBall&) const = default;
};
struct ZoneBox {
  Vec<3> low = Vec<3>::Zero(), high = Vec<3>::Zero();  ///< low < high along each axis

  bool operator==(const ZoneBox&) const = default;
};
/// Of flat ends, between their centers.
struct ZoneCylinder {
  Vec<3> from = Vec<3>::Zero(), to = Vec<3>::Zero();
  double radius = 0;  ///< > 0

  bool operator==(const ZoneCylinder&) const = default;
};
/// Where normal . x < offset; the normal has any length but zero.
struct ZoneHalfSpace {
  Vec<3> normal = Vec<3>::UnitX();
  double offset = 0;

  bool operator==(const ZoneHalfSpace&) const = default;
};
/// What is nearer to the seed than to the seeds of all other cells of the same set.
struct ZoneCell {
  Vec<3> seed = Vec<3>::Zero();
  std::string set{};

  bool operator==(const ZoneCell&) const = default;
};

/// A body given by a formula. Its settings are the BodySettings of its name, as a part's.
struct StudyZone {
  std::string name;
  std::variant<ZoneBall, ZoneBox, ZoneCylinder, ZoneHalfSpace, ZoneCell> shape;

  bool operator==(const StudyZone&) const = default;
};

/// The zone of an entry; `all`, the zones of its study, hold the other seeds of a cell.
ZonePtr<3> make_zone(const StudyZone& zone, const std::vector<StudyZone>& all);

/// The domain is the union of the bodies: nothing is around them.
struct DomainBodies {
  bool operator==(const DomainBodies&) const = default;
};
/// The box around all bodies, grown on every side by a share of its diagonal.
struct DomainMargin {
  double share = 0.1;  ///< > 0

  bool operator==(const DomainMargin&) const = default;
};
/// One of the bodies, a part or a zone: the others are what is in it.
struct DomainBody {
  std::string name;

  bool operator==(const DomainBody&) const = default;
};

/// The domain Omega (chapter 6) that the one mesh of several bodies fills.
struct StudyDomain {
  std::variant<DomainBodies, ZoneBox, ZoneCylinder, DomainMargin, DomainBody> shape;

  bool operator==(const StudyDomain&) const = default;
};

}  // namespace lamella
