#pragma once

#include <QFrame>

class QFormLayout;
class QLabel;
class QSpinBox;
class QDoubleSpinBox;
class QTreeView;
class QVBoxLayout;

namespace lamella::ui {

class Actions;
class BodyModel;
class LengthBox;
class Session;

/// The bodies with their settings, what is known of the selected ones, and how to mesh.
class BodiesPanel : public QFrame {
  Q_OBJECT

 public:
  BodiesPanel(Session& session, Actions& actions, QWidget* parent = nullptr);

 private:
  void make_list(Actions& actions, QVBoxLayout* layout);
  void make_body_settings(QVBoxLayout* layout);
  void make_mesh_settings(QVBoxLayout* layout);
  void follow_parts();
  void follow_selection();
  void follow_study();
  void show_automatic();
  void show_details();
  void select_in_session();

  Session& session_;
  BodyModel* model_;
  QTreeView* tree_;
  QLabel* details_;
  QLabel* body_title_;
  QSpinBox* layers_;
  QDoubleSpinBox* alpha_;
  LengthBox* h_min_;
  LengthBox* h_max_;
  LengthBox* chord_;
  QSpinBox* iterations_;
  QSpinBox* seed_;
  QSpinBox* threads_;
  QWidget* settings_;
  bool following_ = false;
};

}  // namespace lamella::ui
