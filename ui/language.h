#pragma once

#include <QString>
#include <utility>
#include <vector>

class QCoreApplication;

namespace lamella::ui {

/// Codes and names of the languages the window speaks; the first one, an empty code, is that of the
/// system.
std::vector<std::pair<QString, QString>> languages();
/// Texts and numbers from now on in the language `code`; English where there is none of it.
void speak(QCoreApplication& application, const QString& code);

}  // namespace lamella::ui
