#include "ui/commands/edit_study.h"

#include <utility>

namespace lamella::ui {

EditStudy::EditStudy(Session& session, const QString& what, std::shared_ptr<const Study> after,
                     int merge)
    : QUndoCommand(what),
      session_(session),
      before_(session.study_value()),
      after_(std::move(after)),
      merge_(merge) {}

bool EditStudy::mergeWith(const QUndoCommand* later) {
  const auto* next = static_cast<const EditStudy*>(later);  // all with its id are of this class
  if (merge_ == 0 || next->merge_ != merge_) return false;
  after_ = next->after_;
  return true;
}

void EditStudy::undo() { session_.set_study(before_); }

void EditStudy::redo() { session_.set_study(after_); }

RemovePart::RemovePart(Session& session, int index, std::shared_ptr<const Study> after)
    : QUndoCommand(Session::tr("Remove %1").arg(QString::fromStdString(session.body(index).name))),
      session_(session),
      index_(index),
      before_(session.study_value()),
      after_(std::move(after)) {}

void RemovePart::undo() {
  session_.put_back(index_, *std::exchange(taken_, std::nullopt), before_);
}

void RemovePart::redo() { taken_ = session_.take_part(index_, after_); }

ReloadParts::ReloadParts(Session& session, Session::ReadState after)
    : QUndoCommand(Session::tr("Reload the parts")), session_(session), other_(std::move(after)) {}

void ReloadParts::undo() { other_ = session_.exchange_parts(std::move(other_)); }

void ReloadParts::redo() { other_ = session_.exchange_parts(std::move(other_)); }

}  // namespace lamella::ui
