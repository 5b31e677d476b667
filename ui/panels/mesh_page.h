#pragma once

#include <QWidget>

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QSpinBox;

namespace lamella::ui {

class DomainForm;
class Folded;
class LengthBox;
class Session;

/// How the study is meshed: one mesh or several, tolerance, iterations, and what is rarely changed
/// folded away.
class MeshPage : public QWidget {
  Q_OBJECT

 public:
  explicit MeshPage(Session& session, QWidget* parent = nullptr);
  void refresh();

 private:
  Session& session_;
  DomainForm* domain_;
  LengthBox* chord_;
  QSpinBox* iterations_;
  Folded* more_;
  QCheckBox* settled_;
  QCheckBox* progressive_;
  QComboBox* detector_;
  QSpinBox* anisotropy_;
  QSpinBox* seed_;
  QSpinBox* threads_;
  QSpinBox* memory_;
};

}  // namespace lamella::ui
