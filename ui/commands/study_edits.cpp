#include "ui/commands/study_edits.h"

#include <QCoreApplication>
#include <algorithm>

#include "core/study/domain.h"
#include "ui/session/session.h"

namespace lamella::ui {
namespace {

QString tr(const char* text) { return QCoreApplication::translate("Edits", text); }

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
      return tr("Gate");
    case GroupKind::vent:
      return tr("Vent");
    case GroupKind::symmetry:
      return tr("Symmetry");
    case GroupKind::walls:
      return tr("Walls");
    case GroupKind::other:
      break;
  }
  return tr("Other");
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
  const QString what = tr("Add group %1").arg(QString::fromStdString(group.name));
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
  const QString what = tr("Add size %1").arg(QString::fromStdString(object.name));
  study.sizing.push_back(std::move(object));
  const int index = static_cast<int>(study.sizing.size()) - 1;
  session.edit(what, std::move(study));
  session.select_item({ItemKind::sizing, index});
}

void add_cut(Session& session, const Vec<3>& origin, const Vec<3>& normal) {
  Study study = session.study();
  CutPlane cut;
  cut.name = free_name(study.cuts, tr("Cut").toStdString());
  cut.origin = origin;
  cut.normal = normal;
  const QString what = tr("Add %1").arg(QString::fromStdString(cut.name));
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
  session.edit(tr("Show all bodies"), std::move(study));
}

QString domain_title(const StudyDomain& domain) {
  if (const auto* margin = std::get_if<DomainMargin>(&domain.shape))
    return tr("Box with a margin of %1 %").arg(100 * margin->share, 0, 'g', 4);
  if (const auto* body = std::get_if<DomainBody>(&domain.shape))
    return tr("Inside of %1").arg(QString::fromStdString(body->name));
  if (std::holds_alternative<ZoneBox>(domain.shape)) return tr("Box");
  if (std::holds_alternative<ZoneCylinder>(domain.shape)) return tr("Cylinder");
  return tr("The bodies alone");
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
  const QString what = (had ? tr("Take a face out of %1") : tr("Add a face to %1"))
                           .arg(QString::fromStdString(group.name));
  session.edit(what, std::move(study));
}

}  // namespace lamella::ui
