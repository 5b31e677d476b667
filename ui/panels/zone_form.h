#pragma once

#include <QWidget>
#include <functional>

#include "core/study/study.h"

class QDoubleSpinBox;
class QLineEdit;

namespace lamella::ui {

class Form;
class LengthBox;
class PointBox;
class Session;

/// Name and shape of a body that is a formula.
class ZoneForm : public QWidget {
  Q_OBJECT

 public:
  explicit ZoneForm(Session& session, QWidget* parent = nullptr);
  /// Shows the zone; -1 hides all.
  void show_zone(int zone);

 private:
  void edit_shape();
  void rename();

  Session& session_;
  int zone_ = -1;
  Form* rows_;
  QLineEdit* name_;
  PointBox* center_;  // of a ball; seed of a cell
  PointBox* low_;     // corner of a box, end of a cylinder
  PointBox* high_;
  PointBox* normal_;
  QDoubleSpinBox* offset_;
  LengthBox* radius_;
};

}  // namespace lamella::ui
