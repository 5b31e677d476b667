#pragma once

#include <QDialog>

#include "core/io/mesh_format.h"

class QComboBox;
class QLabel;
class QLineEdit;

namespace lamella::ui {

/// Where a mesh goes, in which format and with what options; the last choices are offered again.
class ExportDialog : public QDialog {
  Q_OBJECT

 public:
  /// `name` is that of the file without its ending; `folder` may be empty.
  ExportDialog(const MeshFormats& formats, const QString& folder, const QString& name,
               QWidget* parent = nullptr);

  QString file() const;
  ExportOptions options() const;

 private:
  const MeshFormat& format() const;
  void follow_format();
  /// A name that was typed may tell another format.
  void follow_name();
  void browse();
  /// What the file will carry, and what goes beside it.
  QString contents() const;
  void done(int result) override;

  const MeshFormats& formats_;
  QComboBox* format_;
  QComboBox* unit_;
  QLineEdit* file_;
  QLabel* contents_;
};

}  // namespace lamella::ui
