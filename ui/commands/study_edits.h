#pragma once

#include <QString>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/study/study.h"

namespace lamella::ui {

class Session;

/// Entries of the study: each call is one undoable step, and a new entry is selected.
void add_group(Session& session, GroupKind kind, const std::string& body,
               std::vector<std::int32_t> faces);
void add_sizing(Session& session, const std::string& body, const QString& name,
                const SizingShape& shape);
/// A sphere around the faces of the group, with a size of its own. Nothing where it has none.
void correct_near_group(Session& session, int group);
void add_cut(Session& session, const Vec<3>& origin, const Vec<3>& normal);

/// Changes one entry; steps one after another with the same `merge` (not 0) become one.
void edit_group(Session& session, int index, const QString& what,
                const std::function<void(BoundaryGroup&)>& change, int merge = 0);
void edit_sizing(Session& session, int index, const QString& what,
                 const std::function<void(SizingObject&)>& change, int merge = 0);
void edit_cut(Session& session, int index, const QString& what,
              const std::function<void(CutPlane&)>& change, int merge = 0);

/// A further body by formula. Only one mesh of all bodies knows such bodies: without a domain the
/// study gets one.
void add_zone(Session& session, const QString& name, decltype(StudyZone::shape) shape);
void edit_zone(Session& session, int zone, const QString& what,
               const std::function<void(StudyZone&)>& change, int merge = 0);
/// Wherever the study names it. False, without a change, where the name is empty or taken.
bool rename_zone(Session& session, int zone, const std::string& name);
/// A shape with knobs in the view; nothing: it has none.
std::optional<SizingShape> knobs_of(const StudyZone& zone);
/// The other way round.
void set_shape(StudyZone& zone, const SizingShape& shape);

/// Another domain of one mesh of all bodies, or none: one mesh for each body. What is around the
/// bodies comes and goes with it.
void edit_domain(Session& session, const QString& what, const std::optional<StudyDomain>& domain,
                 int merge = 0);

/// Shows every body; what is around them stays as it is.
void show_all_bodies(Session& session);

/// Gives the face to the group, or takes it away if the group has it. Other groups lose it.
void toggle_face(Session& session, int group, const std::string& body, std::int32_t face);

/// "gate", "vent": what the user reads.
QString kind_title(GroupKind kind);
/// "cavity", "mold".
QString role_title(BodyRole role);
/// "Box, margin 10 %"
QString domain_title(const StudyDomain& domain);

}  // namespace lamella::ui
