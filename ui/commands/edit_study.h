#pragma once

#include <QUndoCommand>
#include <memory>

#include "core/study/study.h"

namespace lamella::ui {

class Session;

/// Holds the study before and after an edit. Studies are values, so undo is a swap.
class EditStudy : public QUndoCommand {
 public:
  EditStudy(Session& session, const QString& what, std::shared_ptr<const Study> after);
  void undo() override;
  void redo() override;

 private:
  Session& session_;
  std::shared_ptr<const Study> before_;
  std::shared_ptr<const Study> after_;
};

}  // namespace lamella::ui
