#include "ui/window_tools.h"

#include <QApplication>
#include <QClipboard>
#include <QMenu>
#include <QStandardPaths>

#include "ui/actions/actions.h"
#include "ui/main_window.h"
#include "ui/panels/banner.h"
#include "ui/panels/journal_view.h"
#include "ui/panels/palette.h"
#include "ui/panels/preferences.h"
#include "ui/panels/recovery_dialog.h"
#include "ui/panels/shortcut_sheet.h"
#include "ui/session/command_line.h"
#include "ui/session/journal.h"
#include "ui/session/recent_files.h"
#include "ui/session/session.h"
#include "ui/theme.h"
#include "ui/views/model_view.h"

namespace lamella::ui {

WindowTools::WindowTools(MainWindow& window) : QObject(&window), window_(window) {
  Actions& act = window.actions();
  recent_ = new QMenu(tr("Open &recent"), &window);
  palette_ = new Palette(&window);
  const std::filesystem::path kept =
      QStandardPaths::writableLocation(QStandardPaths::AppDataLocation).toStdString() + "/recovery";
  recovery_ = new Recovery(window.session(), kept);
  journal_ = new Journal(window.session(), kept);
  for (int a = 0; a < int(Act::count); ++a)
    connect(act[Act(a)], &QAction::triggered, journal_, [this, action = act[Act(a)]] {
      journal_->add(tr("Action: %1").arg(action->text().remove('&')));
    });
  connect(act[Act::journal], &QAction::triggered, this, [this] { show_journal(&window_); });
  connect(recent_, &QMenu::aboutToShow, this, &WindowTools::fill_recent);
  connect(&window.session(), &Session::saved, this,
          [](const QString& file) { remember_file(file); });
  const auto all = [&act] {
    std::vector<QAction*> actions;
    for (int a = 0; a < int(Act::count); ++a) actions.push_back(act[Act(a)]);
    return actions;
  };
  connect(act[Act::search], &QAction::triggered, this, [this, all] { palette_->open(all()); });
  connect(act[Act::shortcuts], &QAction::triggered, this, [this, all] {
    auto* sheet = new ShortcutSheet(all(), &window_);
    sheet->setAttribute(Qt::WA_DeleteOnClose);
    sheet->show();
  });
  connect(act[Act::preferences], &QAction::triggered, this, [this] {
    auto* preferences = new Preferences(&window_);
    preferences->setAttribute(Qt::WA_DeleteOnClose);
    connect(preferences, &Preferences::theme_changed, this, [this](bool dark) {
      apply_theme(*qApp, dark);
      window_.actions().refresh_icons();
      window_.view().refresh_theme();
    });
    preferences->show();
  });
  connect(act[Act::copy_command], &QAction::triggered, this, &WindowTools::copy_command);
}

void WindowTools::copy_command() {
  const Session& session = window_.session();
  Result<std::string> line = command_line(session.study());
  // What options cannot say a saved study can.
  if (!line && !session.file().empty() && !session.modified())
    line = command_line_for(session.file().string());
  if (!line) {
    window_.banner().show_message(Banner::Kind::info, QString::fromStdString(line.error().message),
                                  QString::fromStdString(line.error().hint));
    return;
  }
  const QString text = QString::fromStdString(*line);
  QApplication::clipboard()->setText(text);
  window_.banner().show_message(Banner::Kind::done, tr("Copied"), text);
}

void WindowTools::show_journal(QWidget* parent) {
  auto* view = new JournalView(journal_->left_behind(), journal_->text(), parent);
  view->setAttribute(Qt::WA_DeleteOnClose);
  view->show();
}

void WindowTools::fill_recent() {
  recent_->clear();
  for (const QString& file : recent_files())
    recent_->addAction(file, this, [this, file] { window_.open_files({file}); });
  if (recent_->isEmpty()) recent_->addAction(tr("Nothing yet"))->setEnabled(false);
}

void WindowTools::offer_recovery(const QStringList& files) {
  const std::vector<Recovery::Left> left = recovery_->left_behind();
  if (left.empty()) return window_.open_files(files);
  auto* dialog = new RecoveryDialog(left, &window_);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  connect(dialog, &RecoveryDialog::recover_asked, this, &WindowTools::recover);
  connect(dialog, &RecoveryDialog::discard_asked, this, [this](const Recovery::Left& one) {
    Recovery::discard(one);
    forget_journals();
  });
  connect(dialog, &RecoveryDialog::journal_asked, dialog, [this, dialog] { show_journal(dialog); });
  connect(dialog, &QDialog::rejected, this, [this, files] { window_.open_files(files); });
  dialog->open();
}

void WindowTools::recover(const Recovery::Left& left) {
  Session& session = window_.session();
  // Where it could not be opened it is offered again.
  connect(&session, &Session::study_opened, this, [this, left](const QString& opened) {
    if (opened != QString::fromStdString(left.file.string())) return;
    recovery_->keep();
    Recovery::discard(left);
    forget_journals();
  });
  session.open_study(left.file, left.made_for);
}

void WindowTools::forget_journals() {
  // They tell of all that was left.
  if (recovery_->left_behind().empty()) journal_->discard_left();
}

}  // namespace lamella::ui
