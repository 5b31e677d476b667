#include "ui/panels/export_dialog.h"

#include <QComboBox>
#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QLineEdit>
#include <QMessageBox>
#include <QPushButton>
#include <QSettings>
#include <QVBoxLayout>
#include <algorithm>

#include "ui/panels/form.h"

namespace lamella::ui {
namespace {

QString unit_key(const MeshFormat& format) {
  return "export/unit_of_" + QString::fromStdString(format.name);
}

QString first_ending(const MeshFormat& format) {
  return QString::fromStdString(format.endings.front());
}

}  // namespace

ExportDialog::ExportDialog(const MeshFormats& formats, const QString& folder, const QString& name,
                           QWidget* parent)
    : QDialog(parent), formats_(formats) {
  setWindowTitle(tr("Export mesh"));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(20, 16, 20, 16);
  layout->setSpacing(12);
  auto* form = new Form;
  format_ = new QComboBox;
  format_->setObjectName("export_format");
  for (const MeshFormat& format : formats.all()) {
    QStringList endings;
    for (const std::string& ending : format.endings) endings << QString::fromStdString(ending);
    format_->addItem(
        QString("%1 (%2)").arg(QString::fromStdString(format.title), endings.join(", ")),
        QString::fromStdString(format.name));
  }
  format_->setCurrentIndex(
      std::max(0, format_->findData(QSettings().value("export/format").toString())));
  form->add(tr("Format"), format_);
  unit_ = new QComboBox;
  unit_->setObjectName("export_unit");
  unit_->addItem(tr("millimeters"));
  unit_->addItem(tr("meters"));
  form->add(tr("Lengths in"), unit_);
  auto* row = new QWidget;
  auto* place = new QHBoxLayout(row);
  place->setContentsMargins(0, 0, 0, 0);
  file_ = new QLineEdit;
  file_->setObjectName("export_file");
  file_->setText((folder.isEmpty() ? QString() : folder + "/") + name + first_ending(format()));
  place->addWidget(file_, 1);
  auto* browse = new QPushButton(tr("Browse…"));
  browse->setAutoDefault(false);
  place->addWidget(browse);
  form->add(tr("File"), row);
  row->setMinimumWidth(460);  // a form lets its fields become narrow
  layout->addLayout(form);
  contents_ = styled_label({}, "soft");
  contents_->setWordWrap(true);
  layout->addWidget(contents_);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
  buttons->button(QDialogButtonBox::Ok)->setText(tr("Export"));
  layout->addWidget(buttons);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  connect(browse, &QPushButton::clicked, this, &ExportDialog::browse);
  connect(format_, &QComboBox::currentIndexChanged, this, &ExportDialog::follow_format);
  connect(file_, &QLineEdit::editingFinished, this, &ExportDialog::follow_name);
  connect(file_, &QLineEdit::textChanged, this, [this, buttons] {
    contents_->setText(contents());
    buttons->button(QDialogButtonBox::Ok)->setEnabled(!file_->text().trimmed().isEmpty());
  });
  follow_format();
}

const MeshFormat& ExportDialog::format() const {
  return formats_.all()[static_cast<std::size_t>(std::max(0, format_->currentIndex()))];
}

QString ExportDialog::file() const { return file_->text().trimmed(); }

ExportOptions ExportDialog::options() const {
  return {format().name, unit_->currentIndex() == 1 ? LengthUnit::m : LengthUnit::mm};
}

void ExportDialog::follow_format() {
  const MeshFormat& chosen = format();
  unit_->setCurrentIndex(
      chosen.meters || QSettings().value(unit_key(chosen)).toString() == "m" ? 1 : 0);
  unit_->setEnabled(!chosen.meters);
  unit_->setToolTip(chosen.meters ? tr("This format knows no other unit") : QString());
  // An ending of ours gives way; any other one belongs to the name.
  QString name = file_->text();
  for (const MeshFormat& other : formats_.all())
    for (const std::string& ending : other.endings)
      if (const QString old = QString::fromStdString(ending);
          name.endsWith(old, Qt::CaseInsensitive)) {
        name.chop(old.size());
        file_->setText(name + first_ending(chosen));
        return;
      }
  file_->setText(name + first_ending(chosen));
  contents_->setText(contents());
}

void ExportDialog::follow_name() {
  const Result<const MeshFormat*> named = formats_.of_file(file().toStdString());
  if (!named) {
    if (!file().isEmpty()) file_->setText(file() + first_ending(format()));
    return;
  }
  const int index = format_->findData(QString::fromStdString((*named)->name));
  if (index == format_->currentIndex()) return;
  const QString typed = file();
  format_->setCurrentIndex(index);
  file_->setText(typed);
}

void ExportDialog::browse() {
  QStringList patterns;
  for (const std::string& ending : format().endings)
    patterns << "*" + QString::fromStdString(ending);
  const QString chosen = QFileDialog::getSaveFileName(
      this, tr("Export mesh"), file(),
      QString("%1 (%2)").arg(QString::fromStdString(format().title), patterns.join(' ')), nullptr,
      QFileDialog::DontConfirmOverwrite);
  if (chosen.isEmpty()) return;
  file_->setText(chosen);
  follow_name();
}

QString ExportDialog::contents() const {
  const MeshFormat& f = format();
  if (f.boundary_only) return tr("The triangles of the boundary alone, without any names.");
  QStringList inside, beside;
  const auto tell = [&](bool held, const QString& what) { (held ? inside : beside) << what; };
  tell(f.bodies, tr("bodies"));
  tell(f.groups, tr("groups"));
  tell(f.filling, tr("filling ratios"));
  tell(f.metric, tr("metric"));
  const QString name = QFileInfo(file()).fileName();
  QString text = inside.isEmpty() ? tr("The file holds nodes and elements.")
                                  : tr("In the file: %1.").arg(inside.join(", "));
  if (!beside.isEmpty())
    text += ' ' + tr("Beside it, in %1.json and a .sol: %2.").arg(name, beside.join(", "));
  if (f.meters) text += ' ' + tr("The case is the folder that the file lies in.");
  return text;
}

void ExportDialog::done(int result) {
  if (result == QDialog::Accepted) {
    follow_name();
    if (QFileInfo::exists(file()) &&
        QMessageBox::question(
            this, windowTitle(),
            tr("%1 is there already. Replace it?").arg(QFileInfo(file()).fileName())) !=
            QMessageBox::Yes)
      return;
    QSettings settings;
    settings.setValue("export/format", QString::fromStdString(format().name));
    if (!format().meters)
      settings.setValue(unit_key(format()), unit_->currentIndex() == 1 ? "m" : "mm");
  }
  QDialog::done(result);
}

}  // namespace lamella::ui
