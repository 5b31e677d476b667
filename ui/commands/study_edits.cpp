#include "ui/commands/study_edits.h"

#include <QCoreApplication>
#include <algorithm>

#include "core/geometry/triangles.h"
#include "core/study/domain.h"
#include "ui/box_of.h"
#include "ui/session/session.h"
#include "ui/units.h"

namespace lamella::ui {
namespace {

struct Texts {
  Q_DECLARE_TR_FUNCTIONS(lamella::ui::Edits)
};

template <class List>
std::string free_name(const List& list, const std::string& base) {
  const auto taken = [&](const std::string& name) {
    return std::any_of(list.begin(), list.end(), [&](const auto& i) { return i.name == name; });
  };
  if (!taken(base)) return base;
  for (int k = 2;; ++k)
    if (std::string name = base + " " + std::to_string(k); !taken(name)) return name;
}

template <class List>
void change_entry(Session& session, List Study::*list, int index, const QString& what,
                  const auto& change, int merge) {
  Study study = session.study();
  if (index < 0 || index >= static_cast<int>((study.*list).size())) return;
  auto& entry = (study.*list)[static_cast<std::size_t>(index)];
  change(entry);
  session.edit(what.contains("%1") ? what.arg(QString::fromStdString(entry.name)) : what,
               std::move(study), merge);
}

}  // namespace

QString kind_title(GroupKind kind) {
  switch (kind) {
    case GroupKind::gate:
      return Texts::tr("Gate");
    case GroupKind::vent:
      return Texts::tr("Vent");
    case GroupKind::symmetry:
      return Texts::tr("Symmetry");
    case GroupKind::walls:
      return Texts::tr("Walls");
    case GroupKind::other:
      break;
  }
  return Texts::tr("Other");
}

QString role_title(BodyRole role) {
  switch (role) {
    case BodyRole::none:
      break;
    case BodyRole::cavity:
      return Texts::tr("cavity");
    case BodyRole::channel:
      return Texts::tr("channel");
    case BodyRole::insert:
      return Texts::tr("insert");
    case BodyRole::mold:
      return Texts::tr("mold");
  }
  return Texts::tr("not said");
}

void add_group(Session& session, GroupKind kind, const std::string& body,
               std::vector<std::int32_t> faces) {
  Study study = session.study();
  BoundaryGroup group;
  group.kind = kind;
  group.name = free_name(study.groups, kind == GroupKind::other ? "group" : group_kind_name(kind));
  group.body = body;
  group.faces = std::move(faces);
  for (BoundaryGroup& other : study.groups)
    if (other.body == body)
      std::erase_if(other.faces, [&](std::int32_t f) {
        return std::find(group.faces.begin(), group.faces.end(), f) != group.faces.end();
      });
  const QString what = Texts::tr("Add group %1").arg(QString::fromStdString(group.name));
  study.groups.push_back(std::move(group));
  const int index = static_cast<int>(study.groups.size()) - 1;
  session.edit(what, std::move(study));
  session.select_item({ItemKind::group, index});
}

void add_sizing(Session& session, const std::string& body, const QString& name,
                const SizingShape& shape) {
  Study study = session.study();
  SizingObject object;
  object.name = free_name(study.sizing, name.toStdString());
  object.body = body;
  object.shape = shape;
  SizeCorrection half;
  half.factor = 0.5;
  object.asks = half;
  const QString what = Texts::tr("Add size %1").arg(QString::fromStdString(object.name));
  study.sizing.push_back(std::move(object));
  const int index = static_cast<int>(study.sizing.size()) - 1;
  session.edit(what, std::move(study));
  session.select_item({ItemKind::sizing, index});
}

void correct_near_group(Session& session, int index) {
  const BoundaryGroup& group = session.study().groups[static_cast<std::size_t>(index)];
  for (const Part& part : session.parts()) {
    if (part.name != group.body && !(group.body.empty() && session.parts().size() == 1)) continue;
    const auto facets = facets_of(group, part.surface);
    if (!facets || facets->empty()) continue;
    std::vector<Vec<3>> points;
    for (const std::int32_t f : *facets)
      for (const auto node : part.surface.facets[static_cast<std::size_t>(f)])
        points.push_back(part.surface.points[static_cast<std::size_t>(node)]);
    const auto [low, high] = box_of(points);
    // A point gate is smaller than the region around it.
    const double reach =
        std::max(0.75 * (high - low).norm(), 0.02 * diagonal_of(part.surface.points));
    add_sizing(session, part.name, Texts::tr("near %1").arg(QString::fromStdString(group.name)),
               SphereShape{0.5 * (low + high), reach});
    return;
  }
}

void add_cut(Session& session, const Vec<3>& origin, const Vec<3>& normal) {
  Study study = session.study();
  CutPlane cut;
  cut.name = free_name(study.cuts, Texts::tr("Cut").toStdString());
  cut.origin = origin;
  cut.normal = normal;
  const QString what = Texts::tr("Add %1").arg(QString::fromStdString(cut.name));
  study.cuts.push_back(std::move(cut));
  const int index = static_cast<int>(study.cuts.size()) - 1;
  session.edit(what, std::move(study));
  session.select_item({ItemKind::cut, index});
}

void edit_group(Session& session, int index, const QString& what,
                const std::function<void(BoundaryGroup&)>& change, int merge) {
  change_entry(session, &Study::groups, index, what, change, merge);
}

void edit_sizing(Session& session, int index, const QString& what,
                 const std::function<void(SizingObject&)>& change, int merge) {
  change_entry(session, &Study::sizing, index, what, change, merge);
}

void edit_cut(Session& session, int index, const QString& what,
              const std::function<void(CutPlane&)>& change, int merge) {
  change_entry(session, &Study::cuts, index, what, change, merge);
}

void add_zone(Session& session, const QString& name, decltype(StudyZone::shape) shape) {
  Study study = session.study();
  StudyZone zone{free_name(study.bodies, name.toStdString()), std::move(shape)};
  const QString what = Texts::tr("Add %1").arg(QString::fromStdString(zone.name));
  study.zones.push_back(std::move(zone));
  if (!study.domain) {
    study.domain = StudyDomain{DomainMargin{}};
    study.options.detector = Detector::geometric;
    // What never ends has no box that a margin could be put around.
    if (!domain_hull(study, session.parts()))
      study.domain = StudyDomain{ZoneBox{Vec<3>::Constant(-10), Vec<3>::Constant(10)}};
  }
  arrange_bodies(study, session.parts());
  const auto index = static_cast<int>(session.parts().size() + study.zones.size()) - 1;
  session.edit(what, std::move(study));
  session.select(index);
}

void edit_zone(Session& session, int zone, const QString& what,
               const std::function<void(StudyZone&)>& change, int merge) {
  const auto& zones = session.study().zones;
  if (zone < 0 || zone >= static_cast<int>(zones.size())) return;
  StudyZone after = zones[static_cast<std::size_t>(zone)];
  change(after);
  if (after == zones[static_cast<std::size_t>(zone)]) return;
  change_entry(
      session, &Study::zones, zone, what, [&](StudyZone& z) { z = after; }, merge);
}

bool rename_zone(Session& session, int index, const std::string& name) {
  Study study = session.study();
  const std::string old = study.zones[static_cast<std::size_t>(index)].name;
  for (const BodySettings& body : study.bodies)
    if (body.name == name) return false;
  if (name.empty()) return false;
  study.zones[static_cast<std::size_t>(index)].name = name;
  const auto follow = [&](std::string& known) {
    if (known == old) known = name;
  };
  for (BodySettings& body : study.bodies) follow(body.name);
  for (SizingObject& object : study.sizing) follow(object.body);
  for (BoundaryGroup& group : study.groups) follow(group.body);
  for (std::string& dropped : study.dropped) follow(dropped);
  if (study.domain)
    if (auto* body = std::get_if<DomainBody>(&study.domain->shape)) follow(body->name);
  session.edit(Texts::tr("Rename %1").arg(QString::fromStdString(old)), std::move(study));
  return true;
}

std::optional<SizingShape> knobs_of(const StudyZone& zone) {
  if (const auto* ball = std::get_if<ZoneBall>(&zone.shape))
    return SphereShape{ball->center, ball->radius};
  if (const auto* box = std::get_if<ZoneBox>(&zone.shape))
    return BoxShape{0.5 * (box->low + box->high), box->high - box->low};
  if (const auto* cylinder = std::get_if<ZoneCylinder>(&zone.shape))
    return CylinderShape{cylinder->from, cylinder->to, cylinder->radius};
  return {};
}

void set_shape(StudyZone& zone, const SizingShape& shape) {
  if (const auto* s = std::get_if<SphereShape>(&shape)) zone.shape = ZoneBall{s->center, s->radius};
  if (const auto* b = std::get_if<BoxShape>(&shape))
    zone.shape = ZoneBox{b->center - 0.5 * b->size, b->center + 0.5 * b->size};
  if (const auto* c = std::get_if<CylinderShape>(&shape))
    zone.shape = ZoneCylinder{c->from, c->to, c->radius};
}

void edit_domain(Session& session, const QString& what, const std::optional<StudyDomain>& domain,
                 int merge) {
  Study study = session.study();
  if (study.domain == domain) return;
  study.domain = domain;
  // The only one that one mesh of all bodies knows.
  if (domain) study.options.detector = Detector::geometric;
  arrange_bodies(study, session.parts());
  session.edit(what, std::move(study), merge);
}

void show_all_bodies(Session& session) {
  Study study = session.study();
  const std::size_t around = has_background(study) ? 1 : 0;
  for (std::size_t k = 0; k + around < study.bodies.size(); ++k) study.bodies[k].visible = true;
  session.edit(Texts::tr("Show all bodies"), std::move(study));
}

QString domain_title(const StudyDomain& domain) {
  if (const auto* margin = std::get_if<DomainMargin>(&domain.shape))
    return Texts::tr("Box, margin %1 %").arg(written(100 * margin->share, 'g', 4));
  if (const auto* body = std::get_if<DomainBody>(&domain.shape))
    return Texts::tr("Inside of %1").arg(QString::fromStdString(body->name));
  if (std::holds_alternative<ZoneBox>(domain.shape)) return Texts::tr("Box");
  if (std::holds_alternative<ZoneCylinder>(domain.shape)) return Texts::tr("Cylinder");
  return Texts::tr("The bodies alone");
}

void toggle_face(Session& session, int index, const std::string& body, std::int32_t face) {
  Study study = session.study();
  if (index < 0 || index >= static_cast<int>(study.groups.size())) return;
  BoundaryGroup& group = study.groups[static_cast<std::size_t>(index)];
  // A group without faces goes where its first one is picked.
  if (group.faces.empty() && group.face_names.empty() && group.floods.empty()) group.body = body;
  if (group.body.empty() && session.parts().size() == 1) group.body = body;
  if (group.body != body) return;
  const bool had = std::erase(group.faces, face) > 0;
  if (!had) {
    for (BoundaryGroup& other : study.groups)
      if (other.body == body) std::erase(other.faces, face);
    group.faces.push_back(face);
    std::sort(group.faces.begin(), group.faces.end());
  }
  const QString what = (had ? Texts::tr("Take a face out of %1") : Texts::tr("Add a face to %1"))
                           .arg(QString::fromStdString(group.name));
  session.edit(what, std::move(study));
}

}  // namespace lamella::ui
