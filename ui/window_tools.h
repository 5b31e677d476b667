#pragma once

#include <QObject>

#include "ui/session/recovery.h"

class QMenu;

namespace lamella::ui {

class Journal;
class MainWindow;
class Palette;

/// What a window has beside its work: the search for actions, the sheet of keys, preferences,
/// recent files, the command line of the study, and what a crash has left.
class WindowTools : public QObject {
  Q_OBJECT

 public:
  explicit WindowTools(MainWindow& window);

  /// Fills itself whenever it is opened.
  QMenu* recent_menu() { return recent_; }
  const Journal& journal() const { return *journal_; }
  /// Asks what is to become of what programs that are gone have left unsaved, then opens `files`
  /// unless something was recovered.
  void offer_recovery(const QStringList& files);

 private:
  void copy_command();
  void fill_recent();
  void show_journal(QWidget* parent);
  /// Opens it, and lets go of what was left once it is open here.
  void recover(const Recovery::Left& left);
  void forget_journals();

  MainWindow& window_;
  QMenu* recent_;
  Palette* palette_;
  Recovery* recovery_;
  Journal* journal_;
};

}  // namespace lamella::ui
