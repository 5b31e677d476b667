#pragma once

#include <QPlainTextEdit>

namespace lamella::ui {

/// What happened, line by line with the time.
class LogPanel : public QPlainTextEdit {
  Q_OBJECT

 public:
  explicit LogPanel(QWidget* parent = nullptr);

 public Q_SLOTS:
  void add(const QString& line);
};

}  // namespace lamella::ui
