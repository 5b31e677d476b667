#include "ui/language.h"

#include <QCoreApplication>
#include <QLibraryInfo>
#include <QLocale>
#include <QTranslator>

// A macro that must stand outside of any namespace: the linker drops resources of libraries.
static void load_translations() { Q_INIT_RESOURCE(translations); }

namespace lamella::ui {

std::vector<std::pair<QString, QString>> languages() {
  return {{QString(), QCoreApplication::translate("Language", "that of the system")},
          {"en", "English"},
          {"fr", "Français"}};
}

void speak(QCoreApplication& application, const QString& code) {
  load_translations();
  const QLocale locale = code.isEmpty() ? QLocale::system() : QLocale(code);
  QLocale::setDefault(locale);
  if (locale.language() == QLocale::English) return;
  // Qt has a share in it: what its own buttons and dialogs say.
  auto* own = new QTranslator(&application);
  if (own->load(locale, "lamella", "_", ":/translations")) application.installTranslator(own);
  auto* qt = new QTranslator(&application);
  if (qt->load(locale, "qtbase", "_", QLibraryInfo::path(QLibraryInfo::TranslationsPath)))
    application.installTranslator(qt);
}

}  // namespace lamella::ui
