#include "ui/panels/recovery_dialog.h"

#include <QDialogButtonBox>
#include <QLabel>
#include <QListWidget>
#include <QLocale>
#include <QPushButton>
#include <QVBoxLayout>

#include "core/study/study_file.h"
#include "ui/panels/form.h"

namespace lamella::ui {
namespace {

QString when(const Recovery::Left& left) {
  return QLocale().toString(left.written, QLocale::ShortFormat);
}

/// "2 bodies (box, lid), 1 group, 3 sizes".
QString contents(const Study& study) {
  QStringList names;
  for (const BodySettings& body : study.bodies) names << QString::fromStdString(body.name);
  constexpr qsizetype most = 4;
  if (names.size() > most) {
    names.resize(most);
    names << "…";
  }
  QStringList parts;
  const auto add = [&](std::size_t count, const QString& one, const QString& many) {
    if (count > 0) parts << (count == 1 ? one : many.arg(count));
  };
  add(study.bodies.size(), RecoveryDialog::tr("1 body"), RecoveryDialog::tr("%1 bodies"));
  if (!parts.isEmpty()) parts.back() += " (" + names.join(", ") + ")";
  add(study.groups.size(), RecoveryDialog::tr("1 group"), RecoveryDialog::tr("%1 groups"));
  add(study.sizing.size(), RecoveryDialog::tr("1 size"), RecoveryDialog::tr("%1 sizes"));
  add(study.cuts.size(), RecoveryDialog::tr("1 cut"), RecoveryDialog::tr("%1 cuts"));
  return parts.isEmpty() ? RecoveryDialog::tr("an empty study") : parts.join(", ");
}

}  // namespace

RecoveryDialog::RecoveryDialog(const std::vector<Recovery::Left>& left, QWidget* parent)
    : QDialog(parent), left_(left.rbegin(), left.rend()) {
  setWindowTitle(tr("Recovery"));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(20, 16, 20, 16);
  layout->setSpacing(10);
  layout->addWidget(styled_label(tr("Lamella ended without saving your work."), "panel_title"));
  auto* text = styled_label(tr("The study was kept with its last edit. Meshes since the last save "
                               "are not in it: run it again."),
                            "soft");
  text->setWordWrap(true);
  layout->addWidget(text);
  list_ = new QListWidget;
  list_->setObjectName("recovery_list");
  list_->setAccessibleName(tr("Studies that were kept"));
  for (const Recovery::Left& one : left_)
    list_->addItem((one.made_for.empty()
                        ? tr("never saved")
                        : QString::fromStdString(one.made_for.filename().string())) +
                   "  –  " + when(one));
  list_->setCurrentRow(0);
  list_->setMaximumHeight(110);
  list_->setVisible(left_.size() > 1);
  layout->addWidget(list_);
  details_ = new QLabel;
  details_->setObjectName("recovery_details");
  details_->setTextFormat(Qt::RichText);
  details_->setWordWrap(true);
  details_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  layout->addWidget(details_);
  layout->addSpacing(6);

  auto* buttons = new QDialogButtonBox;
  recover_ = buttons->addButton(tr("&Recover"), QDialogButtonBox::AcceptRole);
  recover_->setObjectName("primary");
  recover_->setDefault(true);
  auto* drop = buttons->addButton(tr("&Discard"), QDialogButtonBox::DestructiveRole);
  auto* later = buttons->addButton(tr("Decide &later"), QDialogButtonBox::RejectRole);
  auto* done = buttons->addButton(tr("&What was done"), QDialogButtonBox::HelpRole);
  for (QPushButton* button : {drop, later, done}) button->setAutoDefault(false);
  layout->addWidget(buttons);
  recover_->setFocus();
  connect(list_, &QListWidget::currentRowChanged, this, &RecoveryDialog::show_chosen);
  connect(list_, &QListWidget::itemActivated, recover_, &QPushButton::click);
  connect(buttons, &QDialogButtonBox::accepted, this, [this] {
    const Recovery::Left chosen = left_[static_cast<std::size_t>(list_->currentRow())];
    accept();
    Q_EMIT recover_asked(chosen);
  });
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  connect(drop, &QPushButton::clicked, this, &RecoveryDialog::discard);
  connect(done, &QPushButton::clicked, this, &RecoveryDialog::journal_asked);
  show_chosen();
  setMinimumWidth(560);
}

void RecoveryDialog::show_chosen() {
  const int row = list_->currentRow();
  if (row < 0) return;
  const Recovery::Left& left = left_[static_cast<std::size_t>(row)];
  const Result<Study> study = read_study(left.file);
  QString html;
  const auto line = [&](const QString& what, const QString& value) {
    html += QString(
                "<tr><td style='padding: 2px 16px 2px 0'>%1</td>"
                "<td style='padding: 2px 0'>%2</td></tr>")
                .arg(what, value.toHtmlEscaped());
  };
  if (study) line(tr("Study"), QString::fromStdString(study->name));
  line(tr("Project"),
       left.made_for.empty() ? tr("never saved") : QString::fromStdString(left.made_for.string()));
  line(tr("Last edit"), when(left));
  line(tr("Kept"), study ? contents(*study) : QString::fromStdString(study.error().message));
  details_->setText("<table cellspacing='0'>" + html + "</table>");
  recover_->setEnabled(study.ok());
}

void RecoveryDialog::discard() {
  const int row = list_->currentRow();
  const auto at = left_.begin() + row;
  const Recovery::Left chosen = *at;
  left_.erase(at);
  delete list_->takeItem(row);
  Q_EMIT discard_asked(chosen);
  if (left_.empty()) reject();
}

}  // namespace lamella::ui
