#pragma once

#include <QDateTime>
#include <QObject>
#include <QTimer>
#include <filesystem>
#include <string>
#include <vector>

namespace lamella::ui {

class Session;

/// Whether the program with this number, as text, is still there.
bool program_runs(const std::string& pid);

/// Keeps what is unsaved in a file of its own, soon after each edit, so that a crash loses nothing.
/// The file goes when the study is saved, when nothing is unsaved, and when the program ends in
/// order.
class Recovery : public QObject {
  Q_OBJECT

 public:
  Recovery(Session& session, std::filesystem::path folder);
  ~Recovery() override;

  /// A study that a program which is gone has left.
  struct Left {
    std::filesystem::path file;
    std::filesystem::path made_for;  ///< empty: it was never saved
    QDateTime written;
  };
  /// The latest last.
  std::vector<Left> left_behind() const;
  static void discard(const Left& left);
  /// Writes what is unsaved now, without waiting for the user to pause.
  void keep();

 private:
  void drop();

  Session& session_;
  std::filesystem::path folder_, file_;
  QTimer wait_;
};

}  // namespace lamella::ui
