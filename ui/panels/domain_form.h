#pragma once

#include <QWidget>

class QComboBox;
class QDoubleSpinBox;

namespace lamella::ui {

class Form;
class LengthBox;
class PointBox;
class Session;

/// Whether each body gets its own mesh or one mesh carries all, in which domain, and how their
/// borders lie in it.
class DomainForm : public QWidget {
  Q_OBJECT

 public:
  explicit DomainForm(Session& session, QWidget* parent = nullptr);
  void refresh();

 private:
  void connect_fields();
  void choose_domain(int kind);
  /// The shape as the boxes of numbers have it.
  void edit_shape();

  Session& session_;
  Form* rows_;
  QComboBox* meshes_;
  QComboBox* domain_;
  QDoubleSpinBox* share_;
  QComboBox* body_;
  PointBox* low_;
  PointBox* high_;
  PointBox* from_;
  PointBox* to_;
  LengthBox* radius_;
  QComboBox* interfaces_;
  QComboBox* capture_;
};

}  // namespace lamella::ui
