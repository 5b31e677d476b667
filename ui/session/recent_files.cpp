#include "ui/session/recent_files.h"

#include <QFileInfo>
#include <QSettings>

namespace lamella::ui {
namespace {

constexpr int most = 10;
constexpr const char* key = "recent_files";

}  // namespace

QStringList recent_files() {
  QStringList files;
  for (const QString& file : QSettings().value(key).toStringList())
    if (QFileInfo::exists(file)) files << file;
  return files;
}

void remember_file(const QString& file) {
  const QString path = QFileInfo(file).absoluteFilePath();
  QStringList files = recent_files();
  files.removeAll(path);
  files.prepend(path);
  QSettings().setValue(key, files.mid(0, most));
}

}  // namespace lamella::ui
