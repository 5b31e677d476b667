#include "core/study/zone_entry.h"

#include "core/base/overloaded.h"

namespace lamella {

namespace {

ZonePtr<3> cell_among(const ZoneCell& cell, const std::vector<StudyZone>& all) {
  std::vector<Vec<3>> seeds{cell.seed};
  for (const StudyZone& other : all)
    if (const auto* c = std::get_if<ZoneCell>(&other.shape))
      if (c->set == cell.set && c->seed != cell.seed) seeds.push_back(c->seed);
  return voronoi_zone<3>(seeds, 0);
}

}  // namespace

ZonePtr<3> make_zone(const StudyZone& zone, const std::vector<StudyZone>& all) {
  return std::visit(
      Overloaded{[](const ZoneBall& b) { return ball_zone<3>(b.center, b.radius); },
                 [](const ZoneBox& b) { return box_zone<3>(b.low, b.high); },
                 [](const ZoneCylinder& c) { return cylinder_zone(c.from, c.to, c.radius); },
                 [](const ZoneHalfSpace& h) { return half_space_zone<3>(h.normal, h.offset); },
                 [&](const ZoneCell& c) { return cell_among(c, all); }},
      zone.shape);
}

}  // namespace lamella
