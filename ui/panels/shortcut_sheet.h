#pragma once

#include <QAction>
#include <QDialog>
#include <vector>

namespace lamella::ui {

/// All keys at a glance, beside the window's work.
class ShortcutSheet : public QDialog {
  Q_OBJECT

 public:
  ShortcutSheet(const std::vector<QAction*>& actions, QWidget* parent);
};

}  // namespace lamella::ui
