#pragma once

#include <QFrame>

class QLabel;
class QSpinBox;
class QDoubleSpinBox;
class QTreeView;

namespace lamella::ui {

class Actions;
class BodyModel;
class Session;

/// The bodies with their settings, what is known of the selected one, and how to run.
class BodiesPanel : public QFrame {
  Q_OBJECT

 public:
  BodiesPanel(Session& session, Actions& actions, QWidget* parent = nullptr);

 private:
  void follow_parts();
  void follow_selection();
  void follow_study();

  Session& session_;
  BodyModel* model_;
  QTreeView* tree_;
  QLabel* details_;
  QSpinBox* layers_;
  QDoubleSpinBox* alpha_;
  QDoubleSpinBox* h_min_;
  QSpinBox* iterations_;
  QSpinBox* threads_;
  QWidget* settings_;
};

}  // namespace lamella::ui
