#pragma once

#include <QDialog>

namespace lamella::ui {

/// Lines of journals to read and to copy.
class JournalView : public QDialog {
  Q_OBJECT

 public:
  /// `left`: of a program that crashed; may be empty.
  JournalView(const QString& left, const QString& now, QWidget* parent);
};

}  // namespace lamella::ui
