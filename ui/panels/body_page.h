#pragma once

#include <QWidget>
#include <functional>

#include "core/study/study.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QFormLayout;
class QLabel;
class QPushButton;
class QSpinBox;

namespace lamella::ui {

class Folded;
class LengthBox;
class Session;
class ZoneForm;

/// Properties of the selected bodies: what is known of them, and the layers through their walls.
class BodyPage : public QWidget {
  Q_OBJECT

 public:
  explicit BodyPage(Session& session, QWidget* parent = nullptr);
  void refresh();
  void show_details();

 private:
  void connect_boxes();
  void show_automatic();

  Session& session_;
  QLabel* title_;
  QLabel* details_;
  ZoneForm* zone_;
  QComboBox* role_;
  QSpinBox* layers_;
  QDoubleSpinBox* alpha_;
  LengthBox* h_min_;
  LengthBox* h_max_;
  LengthBox* interface_;
  QCheckBox* flow_;
  QFormLayout* rows_;
  Folded* more_;
  QSpinBox* layers2_;
  QDoubleSpinBox* alpha2_;
  QSpinBox* layers3_;
  QPushButton* color_;
};

}  // namespace lamella::ui
