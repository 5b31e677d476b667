#include "ui/panels/log_panel.h"

#include <QTime>

namespace lamella::ui {

LogPanel::LogPanel(QWidget* parent) : QPlainTextEdit(parent) {
  setReadOnly(true);
  setAccessibleName(tr("Log"));
  setFrameShape(QFrame::NoFrame);
  setMaximumBlockCount(20000);
  document()->setDocumentMargin(12);
}

void LogPanel::add(const QString& line) {
  appendPlainText(QTime::currentTime().toString("HH:mm:ss") + "   " + line);
}

}  // namespace lamella::ui
