#include <QCloseEvent>
#include <QDragEnterEvent>
#include <QEventLoop>
#include <QFileDialog>
#include <QFileInfo>
#include <QInputDialog>
#include <QMessageBox>
#include <QMimeData>
#include <QPushButton>
#include <QSettings>

#include "ui/main_window.h"
#include "ui/panels/banner.h"
#include "ui/panels/export_dialog.h"
#include "ui/panels/welcome.h"
#include "ui/session/recent_files.h"
#include "ui/session/session.h"
#include "ui/views/model_view.h"
#include "ui/views/vtk_view.h"

// Files of the window: opening, saving, exporting, dropping, and what is asked before they go.
namespace lamella::ui {
namespace {

bool is_study(const QString& file) { return names_study(file.toStdString()); }

bool is_mesh(const QString& file, const MeshFormats& formats) {
  const Result<const MeshFormat*> format = formats.of_file(file.toStdString());
  return format && (*format)->read;
}

/// "*.msh *.vtu ..": what can be read as a mesh.
QString mesh_patterns(const MeshFormats& formats) {
  QStringList patterns;
  for (const MeshFormat& format : formats.all())
    for (const std::string& ending : format.endings)
      if (format.read) patterns << "*" + QString::fromStdString(ending);
  return patterns.join(' ');
}

QStringList local_files(const QMimeData* data) {
  QStringList files;
  for (const QUrl& url : data->urls())
    if (url.isLocalFile()) files << url.toLocalFile();
  return files;
}

}  // namespace

void MainWindow::open_files(const QStringList& files, bool add) {
  if (files.isEmpty() || session_->activity() != Activity::idle) return;
  banner_->hide();
  // A mesh is opened to be seen; added, it is the shape of bodies.
  const bool mesh = !add && is_mesh(files.front(), session_->services().formats);
  add = add && session_->has_bodies() && !is_study(files.front());
  if (!add && !may_drop()) return;
  folder_ = QFileInfo(files.front()).absolutePath();
  for (const QString& file : files) remember_file(file);
  if (is_study(files.front())) {
    session_->open_study(std::filesystem::absolute(files.front().toStdString()));
    return;
  }
  if (mesh) {
    session_->open_mesh(files.front().toStdString());
    return;
  }
  std::vector<std::filesystem::path> paths;
  for (const QString& file : files) paths.emplace_back(file.toStdString());
  session_->open(paths, add);
}

void MainWindow::ask_open(bool add) {
  QStringList patterns;
  for (const char* ending : {"step", "stp", "iges", "igs", "brep", "brp", "stl"})
    patterns << QString("*.%1 *.%2").arg(ending, QString(ending).toUpper());
  const QString parts = patterns.join(' ');
  const QStringList files =
      QFileDialog::getOpenFileNames(this, add ? tr("Add bodies") : tr("Open"), folder_,
                                    (add ? tr("Parts (%1);;Bodies of meshes (%2)")
                                         : tr("Studies and parts (*.lamella *.json %1);;Meshes "
                                              "(%2);;All files (*)"))
                                        .arg(parts, mesh_patterns(session_->services().formats)));
  open_files(files, add);
}

bool MainWindow::save(bool ask_name) {
  QString file = QString::fromStdString(session_->file().string());
  if (file.isEmpty() || ask_name || !is_study(file)) {
    const QStringList kinds = {tr("Project (*.lamella)"),
                               tr("Project with copies of its parts, to hand on (*.lamella)"),
                               tr("Study as text, without meshes (*.json)")};
    const bool copies = session_->study().embed_inputs;
    QString kind = kinds[copies ? 1 : 0];
    const QString name = QString::fromStdString(session_->study().name) + ".lamella";
    file = QFileDialog::getSaveFileName(this, tr("Save study"),
                                        folder_.isEmpty() ? name : folder_ + "/" + name,
                                        kinds.join(";;"), &kind);
    if (file.isEmpty()) return false;
    if (QFileInfo(file).suffix().isEmpty()) file += kind == kinds[2] ? ".json" : ".lamella";
    if (kind != kinds[2] && copies != (kind == kinds[1])) {
      Study study = session_->study();
      study.embed_inputs = !copies;
      session_->edit(copies ? tr("Link the parts") : tr("Keep copies of the parts"),
                     std::move(study));
    }
  }
  if (session_->activity() != Activity::idle) {
    banner_->show_message(Banner::Kind::info, tr("Nothing is saved while something is under way."),
                          tr("Cancel it, or save when it is done."));
    return false;
  }
  session_->save(file.toStdString());
  // Whoever closes the window waits for its file.
  QEventLoop loop;
  connect(session_, &Session::activity_changed, &loop, [this, &loop] {
    if (session_->activity() == Activity::idle) loop.quit();
  });
  if (session_->activity() == Activity::saving) loop.exec();
  return !session_->modified();
}

bool MainWindow::may_drop() {
  if (!session_->modified() && !session_->mesh_unsaved()) return true;
  QMessageBox box(QMessageBox::NoIcon, tr("Unsaved changes"),
                  (session_->modified() ? tr("The study “%1” has changes that are not saved.")
                                        : tr("The mesh of “%1” is not saved."))
                      .arg(QString::fromStdString(session_->study().name)),
                  QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, this);
  box.setInformativeText(session_->modified() ? tr("Save them?") : tr("Save it in a project?"));
  box.setDefaultButton(QMessageBox::Save);
  const int answer = box.exec();
  return answer == QMessageBox::Discard || (answer == QMessageBox::Save && save(false));
}

void MainWindow::ask_export() {
  ExportDialog dialog(session_->services().formats, folder_,
                      QString::fromStdString(session_->study().name), this);
  if (dialog.exec() != QDialog::Accepted) return;
  folder_ = QFileInfo(dialog.file()).absolutePath();
  banner_->hide();
  session_->export_mesh(dialog.file().toStdString(), dialog.options());
}

void MainWindow::ask_report() {
  const QStringList kinds = {tr("PDF (*.pdf)"), tr("HTML page (*.html)")};
  QSettings settings;
  QString kind = kinds[settings.value("report/html").toBool() ? 1 : 0];
  const QString name = QString::fromStdString(session_->study().name) + ".report";
  QString file = QFileDialog::getSaveFileName(this, tr("Save report"),
                                              folder_.isEmpty() ? name : folder_ + "/" + name,
                                              kinds.join(";;"), &kind);
  if (file.isEmpty()) return;
  const QString ending = QFileInfo(file).suffix().toLower();
  if (ending != "pdf" && ending != "html") file += kind == kinds[1] ? ".html" : ".pdf";
  settings.setValue("report/html", file.endsWith(".html"));
  banner_->hide();
  session_->save_report(file.toStdString());
}

void MainWindow::ask_picture() {
  const QSize seen = view_->vtk_view() ? view_->vtk_view()->size() * devicePixelRatioF() : QSize();
  const auto wide = [&](int width) {
    return QSize(width, seen.width() > 0 ? width * seen.height() / seen.width() : width);
  };
  const QSize sizes[] = {seen, wide(1920), wide(3840), wide(7680)};
  QStringList kinds;
  for (const QSize& size : sizes)
    kinds << tr("PNG, %1 × %2 pixels (*.png)").arg(size.width()).arg(size.height());
  kinds << tr("PNG of another width (*.png)");
  const QString name = QString::fromStdString(session_->study().name) + ".png";
  QString kind;
  QString file = QFileDialog::getSaveFileName(this, tr("Save picture"),
                                              folder_.isEmpty() ? name : folder_ + "/" + name,
                                              kinds.join(";;"), &kind);
  if (file.isEmpty()) return;
  if (QFileInfo(file).suffix().isEmpty()) file += ".png";
  const auto chosen = std::max<qsizetype>(0, kinds.indexOf(kind));
  QSize size = chosen < qsizetype(std::size(sizes)) ? sizes[chosen] : QSize();
  if (size.isEmpty() && chosen > 0) {
    constexpr int most = 16384;  // what renderers draw at once
    bool given = false;
    size = wide(QInputDialog::getInt(this, tr("Save picture"), tr("Width in pixels"), 2560, 16,
                                     most, 1, &given));
    if (!given) return;
  }
  const QImage image = chosen == 0 ? view_->picture() : view_->picture(size);
  if (image.save(file)) {
    banner_->show_message(Banner::Kind::done, tr("Picture written"), file);
  } else {
    banner_->show_message(Banner::Kind::error, tr("%1 could not be written.").arg(file),
                          tr("Is the folder writable, and does the name end in .png?"));
  }
}

void MainWindow::ask_result() {
  const QString file =
      QFileDialog::getOpenFileName(this, tr("Result of another solver"), folder_,
                                   tr("Results (*.vtu *.vtk %1);;All files (*)")
                                       .arg(mesh_patterns(session_->services().formats)));
  if (file.isEmpty()) return;
  folder_ = QFileInfo(file).absolutePath();
  banner_->hide();
  session_->open_result(file.toStdString());
}

bool MainWindow::drop_result(const QStringList& files) {
  if (files.size() != 1 || session_->empty()) return false;
  const QString ending = QFileInfo(files.front()).suffix().toLower();
  if (ending != "vtu" && ending != "vtk") return false;
  QMessageBox box(
      QMessageBox::NoIcon, tr("What is it?"),
      tr("“%1” may be the result of another solver.").arg(QFileInfo(files.front()).fileName()),
      QMessageBox::Cancel, this);
  box.setInformativeText(tr("Its fields can show where the mesh of what is open must be finer."));
  QPushButton* correct = box.addButton(tr("Correct by its fields"), QMessageBox::AcceptRole);
  QPushButton* open =
      ending == "vtu" ? box.addButton(tr("Open as a mesh"), QMessageBox::AcceptRole) : nullptr;
  box.setDefaultButton(correct);
  box.exec();
  if (open && box.clickedButton() == open) return false;
  if (box.clickedButton() != correct) return true;
  banner_->hide();
  folder_ = QFileInfo(files.front()).absolutePath();
  session_->open_result(files.front().toStdString());
  return true;
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (session_->activity() != Activity::idle || local_files(event->mimeData()).isEmpty()) return;
  event->acceptProposedAction();
  welcome_->set_dragging(true);
}

void MainWindow::dragLeaveEvent(QDragLeaveEvent*) { welcome_->set_dragging(false); }

void MainWindow::dropEvent(QDropEvent* event) {
  welcome_->set_dragging(false);
  event->acceptProposedAction();
  const QStringList files = local_files(event->mimeData());
  if (!drop_result(files)) open_files(files);
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (session_->activity() == Activity::saving) return event->ignore();
  if (!may_drop()) return event->ignore();
  session_->cancel();
  event->accept();
}

}  // namespace lamella::ui
