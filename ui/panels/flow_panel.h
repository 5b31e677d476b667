#pragma once

#include <QTimer>
#include <QWidget>
#include <memory>
#include <optional>

#include "core/study/flow_of_mesh.h"
#include "ui/session/worker.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QPushButton;
class QSlider;
class QSpinBox;

namespace lamella::ui {

class Actions;
class LengthBox;
class Plot;
class Session;

/// The flow through the shown mesh, or the field of another solver on it: what it came to, and how
/// it is to correct the mesh.
class FlowPanel : public QWidget {
  Q_OBJECT

 public:
  FlowPanel(Session& session, Actions& actions, QWidget* parent = nullptr);
  /// Of the correction at the shown mesh; nothing while it is not known.
  std::optional<FlowPreview> preview() const;
  /// Whether the preview is on its way.
  bool busy() const { return wait_.isActive() || worker_.busy(); }

 Q_SIGNALS:
  /// The user wants to choose the result of another solver.
  void result_asked();

 private:
  QWidget* make_settings();
  QWidget* make_source();
  void connect_source();
  void connect_boxes();
  /// One undoable step; steps of one `merge` (not 0) become one.
  void edit(const QString& what, const std::function<void(StudyFlow&)>& change, int merge = 0);
  void refresh();
  void show_flow();
  /// What the mesh is corrected by, with what is known of the result.
  void show_source(const StudyFlow& flow);
  QString result_text() const;
  void count();
  bool is_previewed() const;
  QString preview_text() const;

  Session& session_;
  QCheckBox* correct_;
  QComboBox* from_;
  QWidget* source_;  ///< file, field and unit
  QPushButton* file_;
  QComboBox* field_;
  QComboBox* unit_;
  QComboBox* method_;
  QLabel* weight_title_;
  QSlider* weight_;
  QLabel* weight_text_;
  QDoubleSpinBox* growth_;
  QSpinBox* rounds_;
  LengthBox* h_min_;
  QLabel* expected_;
  QLabel* found_;
  Plot* residuals_;
  int merge_ = 0;
  QTimer wait_;
  std::optional<FlowPreview> preview_;
  QString no_preview_;  ///< why there is none
  std::shared_ptr<const MeshState> previewed_;
  StudyFlow previewed_with_;
  std::shared_ptr<const MeshState> plotted_;
  Worker worker_;  // last: its destructor waits for the job that uses the rest
};

}  // namespace lamella::ui
