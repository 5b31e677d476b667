#pragma once

#include <QObject>

class QMenu;

namespace lamella::ui {

class Journal;
class MainWindow;
class Palette;
class Recovery;

/// What a window has beside its work: the search for actions, the sheet of keys, preferences,
/// recent files, the command line of the study, and what a crash has left.
class WindowTools : public QObject {
  Q_OBJECT

 public:
  explicit WindowTools(MainWindow& window);

  /// Fills itself whenever it is opened.
  QMenu* recent_menu() { return recent_; }
  const Journal& journal() const { return *journal_; }
  /// Offers what programs that are gone have left unsaved.
  void offer_recovery();

 private:
  void copy_command();
  void fill_recent();
  void show_journal();

  MainWindow& window_;
  QMenu* recent_;
  Palette* palette_;
  Recovery* recovery_;
  Journal* journal_;
};

}  // namespace lamella::ui
