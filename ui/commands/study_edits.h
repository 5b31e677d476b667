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
void add_cut(Session& session, const Vec<3>& origin, const Vec<3>& normal);

/// Changes one entry; steps one after another with the same `merge` (not 0) become one.
void edit_group(Session& session, int index, const QString& what,
                const std::function<void(BoundaryGroup&)>& change, int merge = 0);
void edit_sizing(Session& session, int index, const QString& what,
                 const std::function<void(SizingObject&)>& change, int merge = 0);
void edit_cut(Session& session, int index, const QString& what,
              const std::function<void(CutPlane&)>& change, int merge = 0);

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
/// "Box with a margin of 10 %"
QString domain_title(const StudyDomain& domain);

}  // namespace lamella::ui
