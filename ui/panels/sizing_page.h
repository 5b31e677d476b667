#pragma once

#include <QWidget>
#include <functional>

#include "core/study/study.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QFormLayout;
class QLabel;
class QLineEdit;

namespace lamella::ui {

class Forecaster;
class Form;
class LengthBox;
class PointBox;
class Session;

/// Properties of the selected sizing object: where it holds, what it asks, and what that costs.
class SizingPage : public QWidget {
  Q_OBJECT

 public:
  SizingPage(Session& session, Forecaster& forecaster, QWidget* parent = nullptr);
  void refresh();

 private:
  void make_shape(Form* form);
  void make_asked(Form* form);
  void edit(const QString& what, const std::function<void(SizingObject&)>& change);
  void edit_shape();
  void edit_asked();
  void show_shape(const SizingShape& shape);
  void show_asked(const SizingObject& object);
  void show_forecast();

  Session& session_;
  Forecaster& forecaster_;
  QLineEdit* name_;
  QComboBox* body_;
  QFormLayout* rows_ = nullptr;
  PointBox* center_ = nullptr;  // of a sphere or box; of a cylinder's first end
  PointBox* size_ = nullptr;    // of a box
  PointBox* end_ = nullptr;     // of a cylinder
  LengthBox* radius_ = nullptr;
  LengthBox* depth_ = nullptr;
  QLabel* faces_ = nullptr;
  QComboBox* asks_ = nullptr;
  QDoubleSpinBox* value_ = nullptr;
  QDoubleSpinBox* gradation_ = nullptr;
  QCheckBox* directions_ = nullptr;
  QLabel* zone_ = nullptr;
  QLabel* forecast_;
};

}  // namespace lamella::ui
