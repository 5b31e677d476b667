#pragma once

#include <QUndoCommand>
#include <memory>

#include "core/study/study.h"

namespace lamella::ui {

class Session;

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

}  // namespace lamella::ui
