#include "ui/commands/edit_study.h"

#include "ui/session/session.h"

namespace lamella::ui {

EditStudy::EditStudy(Session& session, const QString& what, std::shared_ptr<const Study> after,
                     int merge)
    : QUndoCommand(what),
      session_(session),
      before_(session.study_value()),
      after_(std::move(after)),
      merge_(merge) {}

bool EditStudy::mergeWith(const QUndoCommand* later) {
  const auto* next = static_cast<const EditStudy*>(later);  // all commands are of this class
  if (merge_ == 0 || next->merge_ != merge_) return false;
  after_ = next->after_;
  return true;
}

void EditStudy::undo() { session_.set_study(before_); }

void EditStudy::redo() { session_.set_study(after_); }

}  // namespace lamella::ui
