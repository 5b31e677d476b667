#pragma once

#include <QImage>
#include <QPointF>
#include <QWidget>
#include <memory>
#include <optional>

#include "ui/views/scene.h"
#include "ui/views/section_tool.h"

class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QMouseEvent;
class QSlider;

namespace lamella::ui {

class Actions;
class Overlay;
class Session;
class VtkView;

/// The 3D view of the session with its bar: coloring, edges, section and standard views.
class ModelView : public QWidget {
  Q_OBJECT

 public:
  ModelView(Session& session, Actions& actions, QWidget* parent = nullptr);
  ~ModelView() override;

  /// The picture as seen, with legend and scale; without the section's handle.
  QImage picture();
  const std::optional<Section>& section() const { return section_; }
  void set_section(const std::optional<Section>& section);
  void set_color_by(ColorBy color_by);
  ColorBy color_by() const;
  void fit();
  /// Looks along `direction`, `up` upward.
  void look(const Vec<3>& direction, const Vec<3>& up);
  void look_isometric();
  /// Cuts in the middle, if nothing is cut yet, and looks at the cut from near.
  void look_at_section();
  /// Brings the cube of half width `radius` (mm) around `center` close.
  void look_near(const Vec<3>& center, double radius);
  const Scene* scene() const { return scene_.get(); }
  VtkView* vtk_view() const { return view_; }

 private:
  QWidget* make_bar();
  void connect_session();
  void connect_actions();
  void follow_parts();
  void follow_surfaces();
  void follow_selection();
  bool mouse(QMouseEvent* event);
  Vec<3> first_direction() const;
  void follow_study();
  void follow_mesh();
  void apply_section();
  void update_section_controls();
  void start_section(int axis);
  void refresh();

  Session& session_;
  Actions& actions_;
  VtkView* view_ = nullptr;  // null where OpenGL is missing
  Overlay* overlay_ = nullptr;
  std::unique_ptr<Scene> scene_;
  std::unique_ptr<SectionTool> tool_;
  std::optional<QPointF> pressed_;  // where a click may have begun
  QComboBox* colors_ = nullptr;
  QWidget* section_bar_ = nullptr;
  QSlider* slider_ = nullptr;
  QDoubleSpinBox* position_ = nullptr;
  std::optional<Section> section_;
  bool section_pending_ = false;
};

}  // namespace lamella::ui
