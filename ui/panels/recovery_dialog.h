#pragma once

#include <QDialog>
#include <vector>

#include "ui/session/recovery.h"

class QLabel;
class QListWidget;
class QPushButton;

namespace lamella::ui {

/// Asks what is to become of the studies that a crash has left unsaved: recover the chosen one,
/// discard it, or leave all to the next start.
class RecoveryDialog : public QDialog {
  Q_OBJECT

 public:
  /// `left` has one at least, the latest last, which is chosen at first.
  RecoveryDialog(const std::vector<Recovery::Left>& left, QWidget* parent);

 Q_SIGNALS:
  void recover_asked(const lamella::ui::Recovery::Left& left);
  /// The dialog closes with the last one.
  void discard_asked(const lamella::ui::Recovery::Left& left);
  void journal_asked();

 private:
  void show_chosen();
  void discard();

  std::vector<Recovery::Left> left_;  // as the rows of the list
  QListWidget* list_;
  QLabel* details_;
  QPushButton* recover_;
};

}  // namespace lamella::ui
