#pragma once

#include <QFile>
#include <QObject>
#include <filesystem>

namespace lamella::ui {

class Session;

/// What is done, as lines of a file that outlives a crash: edits of the study by their names, and
/// whatever else is told to it. The file goes when the program ends in order.
class Journal : public QObject {
  Q_OBJECT

 public:
  Journal(Session& session, const std::filesystem::path& folder);
  ~Journal() override;

  /// Adds a line, with the time before it.
  void add(const QString& line);
  /// The lines so far.
  QString text() const;
  /// Those of programs that are gone, the last one last; empty: none crashed.
  QString left_behind() const;
  void discard_left() const;

 private:
  void follow_edits();

  Session& session_;
  std::filesystem::path folder_;
  QFile file_;
  int done_ = 0;       // steps of the undo stack that were done
  QString last_step_;  // what the topmost one is called
  QString undone_;     // and the one that was undone last
};

}  // namespace lamella::ui
