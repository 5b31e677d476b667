#pragma once

#include <QDialog>

namespace lamella::ui {

/// What holds for every study on this computer; each choice acts at once.
class Preferences : public QDialog {
  Q_OBJECT

 public:
  explicit Preferences(QWidget* parent);

 Q_SIGNALS:
  void theme_changed(bool dark);
};

}  // namespace lamella::ui
