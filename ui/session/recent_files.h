#pragma once

#include <QStringList>

namespace lamella::ui {

/// Files opened or saved last, the latest first; those that are gone are left out.
QStringList recent_files();
void remember_file(const QString& file);

}  // namespace lamella::ui
