#include "ui/commands/edit_study.h"

#include "ui/session/session.h"

namespace lamella::ui {

EditStudy::EditStudy(Session& session, const QString& what, std::shared_ptr<const Study> after)
    : QUndoCommand(what),
      session_(session),
      before_(session.study_value()),
      after_(std::move(after)) {}

void EditStudy::undo() { session_.set_study(before_); }

void EditStudy::redo() { session_.set_study(after_); }

}  // namespace lamella::ui
