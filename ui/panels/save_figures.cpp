#include "ui/panels/save_figures.h"

#include <QCoreApplication>
#include <QFileDialog>
#include <QFileInfo>
#include <QPixmap>

#include "core/base/atomic_file.h"
#include "ui/theme.h"

namespace lamella::ui {
namespace {

struct Texts {
  Q_DECLARE_TR_FUNCTIONS(lamella::ui::Figures)
};

}  // namespace

QString ask_figures_file(QWidget* parent, const QString& name) {
  const QString csv = Texts::tr("Comma-separated values (*.csv)");
  QString kind;
  QString file = QFileDialog::getSaveFileName(parent, Texts::tr("Save figures"), name + ".csv",
                                              csv + ";;" + Texts::tr("Picture (*.png)"), &kind);
  if (!file.isEmpty() && QFileInfo(file).suffix().isEmpty()) file += kind == csv ? ".csv" : ".png";
  return file;
}

Result<void> save_figures(const QString& file, const QString& csv, QWidget& plots) {
  const QString ending = QFileInfo(file).suffix().toLower();
  if (ending == "csv") return write_file(file.toStdString(), csv.toStdString());
  if (ending != "png")
    return Error{Code::usage,
                 Texts::tr("%1: figures are written as .csv or .png.").arg(file).toStdString(),
                 Texts::tr("Give the file one of these endings.").toStdString()};
  constexpr double scale = 2;
  QPixmap picture(plots.size() * scale);
  picture.setDevicePixelRatio(scale);
  picture.fill(theme::panel);
  plots.render(&picture, QPoint(), QRegion(), QWidget::DrawChildren);
  if (picture.save(file, "PNG")) return {};
  return Error{Code::io, Texts::tr("%1 could not be written.").arg(file).toStdString(),
               Texts::tr("Is the folder writable?").toStdString()};
}

}  // namespace lamella::ui
