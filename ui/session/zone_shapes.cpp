#include "ui/session/zone_shapes.h"

#include "core/study/domain.h"
#include "core/study/zone_surface.h"

namespace lamella::ui {
namespace {

/// Of the hull's diagonal: chords that look round.
constexpr double chord = 3e-4;

/// The domain, or without one a box around whatever has an end.
StudyZone drawn_hull(const Study& study, const std::vector<Part>& parts) {
  if (Result<StudyZone> hull = domain_hull(study, parts)) return *hull;
  Study other = study;
  other.domain = StudyDomain{DomainMargin{}};
  if (Result<StudyZone> hull = domain_hull(other, parts)) return *hull;
  return {"", ZoneBox{Vec<3>::Constant(-1), Vec<3>::Constant(1)}};
}

}  // namespace

ZoneShapes zone_shapes(const Study& study, const std::vector<Part>& parts,
                       const Progress& progress) {
  ZoneShapes shapes;
  const StudyZone hull = drawn_hull(study, parts);
  const Box<3> box = make_zone(hull, {hull})->box();
  const double tolerance = chord * (box.hi - box.lo).norm();
  if (has_background(study) && !std::holds_alternative<DomainBodies>(study.domain->shape))
    if (Result<ReferenceSurface<3>> surface = zone_surface(hull, {hull}, hull, tolerance))
      shapes.hull = std::move(*surface);
  for (const StudyZone& zone : study.zones) {
    if (progress.cancelled()) break;
    Result<ReferenceSurface<3>> surface = zone_surface(zone, study.zones, hull, tolerance);
    shapes.volumes.push_back(surface ? zone_volume(zone, *surface, hull) : 0);
    shapes.zones.push_back(surface ? std::move(*surface) : ReferenceSurface<3>{});
  }
  return shapes;
}

}  // namespace lamella::ui
