#pragma once

#include <QWidget>

class QLineEdit;

namespace lamella::ui {

class PointBox;
class Session;

/// Properties of the selected cut.
class CutPage : public QWidget {
  Q_OBJECT

 public:
  explicit CutPage(Session& session, QWidget* parent = nullptr);
  void refresh();

 private:
  Session& session_;
  QLineEdit* name_;
  PointBox* origin_;
  PointBox* normal_;
};

}  // namespace lamella::ui
