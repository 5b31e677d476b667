#include "ui/session/journal.h"

#include <QDateTime>
#include <QDir>
#include <QUndoStack>

#include "ui/session/recovery.h"
#include "ui/session/session.h"

namespace lamella::ui {
namespace {

QString ending() { return QStringLiteral(".journal"); }

QString contents(const QString& name) {
  QFile file(name);
  return file.open(QIODevice::ReadOnly) ? QString::fromUtf8(file.readAll()) : QString();
}

/// Journals of programs that are gone.
QStringList left_files(const std::filesystem::path& folder) {
  const QDir dir(QString::fromStdString(folder.string()));
  QStringList files;
  for (const QFileInfo& file :
       dir.entryInfoList({"*" + ending()}, QDir::Files, QDir::Time | QDir::Reversed))
    if (!program_runs(file.completeBaseName().toStdString())) files << file.filePath();
  return files;
}

}  // namespace

Journal::Journal(Session& session, const std::filesystem::path& folder)
    : QObject(&session), session_(session), folder_(folder) {
  const QString dir = QString::fromStdString(folder.string());
  QDir().mkpath(dir);
  file_.setFileName(dir + "/" + QString::number(QCoreApplication::applicationPid()) + ending());
  // Without room for it there is no journal, and nothing else is amiss.
  (void)file_.open(QIODevice::WriteOnly | QIODevice::Truncate);
  connect(session.undo_stack(), &QUndoStack::indexChanged, this, &Journal::follow_edits);
  connect(&session, &Session::logged, this, &Journal::add);
}

Journal::~Journal() { file_.remove(); }

void Journal::add(const QString& line) {
  if (!file_.isOpen()) return;
  const QString time = QDateTime::currentDateTime().toString("yyyy-MM-dd HH:mm:ss");
  file_.write((time + "  " + QString(line).replace('\n', ' ') + "\n").toUtf8());
  // What is not in the file yet a crash would take along.
  file_.flush();
}

void Journal::follow_edits() {
  const QUndoStack& stack = *session_.undo_stack();
  if (stack.count() == 0) {  // another study is open
    done_ = 0;
    last_step_.clear();
    undone_.clear();
    return;
  }
  const int done = stack.index();
  const QString step = done > 0 ? stack.text(done - 1) : QString();
  if (done < done_)
    add(tr("Undone: %1").arg(stack.text(done)));
  else if (done > done_)
    add(step == undone_ ? tr("Done again: %1").arg(step) : tr("Edit: %1").arg(step));
  else if (step != last_step_)
    add(tr("Edit: %1").arg(step));
  done_ = done;
  last_step_ = step;
  undone_ = done < stack.count() ? stack.text(done) : QString();
}

QString Journal::text() const { return contents(file_.fileName()); }

QString Journal::left_behind() const {
  QString all;
  for (const QString& file : left_files(folder_)) all += contents(file);
  return all;
}

void Journal::discard_left() const {
  for (const QString& file : left_files(folder_)) QFile::remove(file);
}

}  // namespace lamella::ui
