#include "ui/language.h"

#include <QCoreApplication>
#include <QLibraryInfo>
#include <QLocale>
#include <QTranslator>
#include <string_view>

// A macro that must stand outside of any namespace: the linker drops resources of libraries.
static void load_translations() { Q_INIT_RESOURCE(translations); }

namespace lamella::ui {
namespace {

/// What the buttons of dialogs say where Qt's own translations are not installed.
class ButtonTexts : public QTranslator {
 public:
  using QTranslator::QTranslator;
  bool isEmpty() const override { return false; }
  QString translate(const char* context, const char* source, const char*, int) const override {
    if (std::string_view(context) != "QPlatformTheme") return {};
    const std::pair<std::string_view, QString> texts[] = {
        {"Cancel", QCoreApplication::translate("Language", "Cancel")},
        {"Close", QCoreApplication::translate("Language", "Close")},
        {"Discard", QCoreApplication::translate("Language", "Discard")},
        {"Save", QCoreApplication::translate("Language", "Save")}};
    for (const auto& [english, own] : texts)
      if (english == source) return own;
    return {};
  }
};

}  // namespace

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
  application.installTranslator(new ButtonTexts(&application));
  auto* qt = new QTranslator(&application);
  if (qt->load(locale, "qtbase", "_", QLibraryInfo::path(QLibraryInfo::TranslationsPath)))
    application.installTranslator(qt);
}

}  // namespace lamella::ui
