#pragma once

#include <QUndoCommand>
#include <memory>
#include <optional>

#include "core/study/study.h"
#include "ui/session/session.h"

namespace lamella::ui {

/// Holds the study before and after an edit. Studies are values, so undo is a swap.
class EditStudy : public QUndoCommand {
 public:
  /// Follows a command with the same `merge` as one step with it; 0 never does.
  EditStudy(Session& session, const QString& what, std::shared_ptr<const Study> after,
            int merge = 0);
  void undo() override;
  void redo() override;
  int id() const override { return 1; }
  bool mergeWith(const QUndoCommand* later) override;

 private:
  Session& session_;
  std::shared_ptr<const Study> before_;
  std::shared_ptr<const Study> after_;
  int merge_;
};

/// Takes a part out of the study, and puts it back.
class RemovePart : public QUndoCommand {
 public:
  /// `after`: the study without it.
  RemovePart(Session& session, int index, std::shared_ptr<const Study> after);
  void undo() override;
  void redo() override;

 private:
  Session& session_;
  int index_;
  std::shared_ptr<const Study> before_;
  std::shared_ptr<const Study> after_;
  std::optional<Session::TakenPart> taken_;  // while it is out
};

/// Puts parts that were read again in the place of those before, and back.
class ReloadParts : public QUndoCommand {
 public:
  ReloadParts(Session& session, Session::ReadState after);
  void undo() override;
  void redo() override;

 private:
  Session& session_;
  Session::ReadState other_;
};

}  // namespace lamella::ui
