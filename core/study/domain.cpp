#include "core/study/domain.h"

#include <algorithm>

#include "core/geometry/triangles.h"
#include "core/study/request.h"

namespace lamella {

namespace {

Box<3> box_around(const Part& part) {
  Box<3> box;
  for (const Vec<3>& p : part.surface.points) box.add(p);
  return box;
}

}  // namespace

void append(const ReferenceSurface<3>& surface, ReferenceSurface<3>& all) {
  const auto shift = static_cast<std::int32_t>(all.points.size());
  const auto faces = static_cast<std::int32_t>(all.faces.size());
  all.points.insert(all.points.end(), surface.points.begin(), surface.points.end());
  for (const auto& f : surface.facets)
    all.facets.push_back({f[0] + shift, f[1] + shift, f[2] + shift});
  for (const std::int32_t face : surface.facet_face) all.facet_face.push_back(face + faces);
  all.faces.insert(all.faces.end(), surface.faces.begin(), surface.faces.end());
}

void append_reversed(const ReferenceSurface<3>& surface, const Zone<3>& taken_from,
                     ReferenceSurface<3>& all) {
  constexpr double kSame = 1e-7, kAlike = 0.99;  // of the facet's size; a cosine
  ReferenceSurface<3> seen = surface;
  seen.facets.clear();
  seen.facet_face.clear();
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    const auto& v = surface.facets[f];
    const std::array<Vec<3>, 3> p{surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]};
    const Vec<3> normal = facet_normal<3>(p);
    const ZoneDistance<3> border = taken_from.at((p[0] + p[1] + p[2]) / 3);
    const double size = (p[1] - p[0]).norm() + (p[2] - p[0]).norm();
    if (std::abs(border.distance) <= kSame * size &&
        border.normal.dot(normal) > kAlike * normal.norm())
      continue;
    seen.facets.push_back({v[0], v[2], v[1]});
    if (!surface.facet_face.empty()) seen.facet_face.push_back(surface.facet_face[f]);
  }
  append(seen, all);
}

bool has_background(const Study& study) {
  return study.domain && !std::holds_alternative<DomainBody>(study.domain->shape);
}

bool names_background(const Study& study) {
  return std::any_of(study.bodies.begin(), study.bodies.end(),
                     [](const BodySettings& body) { return body.name == kBackground; });
}

void arrange_bodies(Study& study, const std::vector<Part>& parts) {
  std::vector<BodySettings> bodies;
  for (const Part& part : parts) bodies.push_back(settings_of(study, part.name));
  for (const StudyZone& zone : study.zones) bodies.push_back(settings_of(study, zone.name));
  if (has_background(study)) {
    bodies.push_back(settings_of(study, kBackground));
    if (!names_background(study)) {
      bodies.back().layers = kBackgroundLayers;
      bodies.back().visible = false;
    }
  }
  study.bodies = std::move(bodies);
}

Result<StudyZone> domain_hull(const Study& study, const std::vector<Part>& parts) {
  if (!study.domain) return Error{Code::usage, "The study has no domain.", "Give it one."};
  const auto& domain = study.domain->shape;
  StudyZone hull{kBackground, ZoneBox{}};
  if (const auto* body = std::get_if<DomainBody>(&domain)) {
    for (const StudyZone& zone : study.zones)
      if (zone.name == body->name) return zone;
    for (const Part& part : parts) {
      if (part.name != body->name) continue;
      const Box<3> box = box_around(part);
      return StudyZone{part.name, ZoneBox{box.lo, box.hi}};
    }
    return Error{Code::usage, "There is no body \"" + body->name + "\" to be the domain.",
                 "Choose another domain."};
  }
  if (const auto* box = std::get_if<ZoneBox>(&domain)) {
    hull.shape = *box;
  } else if (const auto* cylinder = std::get_if<ZoneCylinder>(&domain)) {
    hull.shape = *cylinder;
  } else {
    const auto* margin = std::get_if<DomainMargin>(&domain);
    Box<3> around;
    for (const Part& part : parts) around.add(box_around(part));
    for (const StudyZone& zone : study.zones) {
      const Box<3> own = make_zone(zone, study.zones)->box();
      if ((own.hi - own.lo).allFinite()) around.add(own);
    }
    if (!((around.hi - around.lo).minCoeff() > 0))
      return Error{Code::usage, "The bodies have no box that a margin could be put around.",
                   "Give the domain as a box or a cylinder."};
    const double share = margin ? margin->share : DomainMargin{}.share;
    const Vec<3> grow = Vec<3>::Constant(share * (around.hi - around.lo).norm());
    hull.shape = ZoneBox{around.lo - grow, around.hi + grow};
  }
  return hull;
}

std::vector<RankedBody> by_rank(const Study& study, const std::vector<Part>& parts) {
  std::vector<RankedBody> bodies;
  for (const Part& part : parts) bodies.push_back({&part, nullptr});
  for (const StudyZone& zone : study.zones) bodies.push_back({nullptr, &zone});
  const auto rank = [&](const RankedBody& body) {
    return role_rank(settings_of(study, body.part ? body.part->name : body.zone->name).role);
  };
  std::stable_sort(bodies.begin(), bodies.end(),
                   [&](const RankedBody& a, const RankedBody& b) { return rank(a) < rank(b); });
  return bodies;
}

Result<StudyOverlaps> study_overlaps(const Study& study, const std::vector<Part>& parts,
                                     OverlapOptions options, const Progress& progress) {
  const auto* outside = study.domain ? std::get_if<DomainBody>(&study.domain->shape) : nullptr;
  const auto is_domain = [&](const std::string& name) { return outside && outside->name == name; };
  std::vector<Region<3>> regions;
  for (const RankedBody& body : by_rank(study, parts)) {
    if (body.part && !is_domain(body.part->name))
      regions.push_back({body.part->name, surface_zone<3>(body.part->surface)});
    if (body.zone && !is_domain(body.zone->name))
      regions.push_back({body.zone->name, make_zone(*body.zone, study.zones)});
  }
  if (study.domain) {
    const Result<StudyZone> hull = domain_hull(study, parts);
    if (!hull) return hull.error();
    const Box<3> box = make_zone(*hull, {*hull})->box();
    if ((box.hi - box.lo).allFinite()) options.within = box;
  }
  options.threads = study.options.threads;
  const Partition<3> partition(std::move(regions));
  Result<OverlapReport> report = find_overlaps(partition, options, progress);
  if (!report) return report.error();
  return StudyOverlaps{partition.names(), std::move(*report)};
}

}  // namespace lamella
