#pragma once

#include <QImage>
#include <QPointF>
#include <QWidget>
#include <array>
#include <functional>
#include <memory>
#include <optional>

#include "ui/views/scene.h"
#include "ui/views/section_tool.h"

class QLabel;
class QMouseEvent;
class QSplitter;
class QKeyEvent;

namespace lamella::ui {

class Actions;
class CompareView;
class Overlay;
class PickTools;
class Session;
class SizeShapes;
class SizeTool;
class ViewBar;
class WallMap;
class VtkView;

/// The 3D view of the session with its bar: coloring, edges, section and standard views.
class ModelView : public QWidget {
  Q_OBJECT

 public:
  ModelView(Session& session, Actions& actions, QWidget* parent = nullptr);
  ~ModelView() override;

  /// The picture as seen, with legend and scale; without the section's handle.
  QImage picture();
  /// The same, so many pixels wide and high.
  QImage picture(const QSize& pixels);
  /// The cut that has the handle, if it is on.
  std::optional<Section> section() const;
  /// Moves that cut, or adds one; nothing turns all cuts off.
  void set_section(const std::optional<Section>& section, int merge = 0);
  void set_color_by(ColorBy color_by);
  ColorBy color_by() const;
  void fit();
  /// Draws with the colors of the theme.
  void refresh_theme();
  /// Draws only elements with a quality in the range; nothing: all.
  void set_quality_range(const std::optional<std::pair<double, double>>& range);
  /// Looks along `direction`, `up` upward.
  void look(const Vec<3>& direction, const Vec<3>& up);
  void look_isometric();
  /// Cuts in the middle, if nothing is cut yet, and looks at the cut from near.
  void look_at_section();
  /// Brings the cube of half width `radius` (mm) around `center` close.
  void look_near(const Vec<3>& center, double radius);
  /// As those of the scene; empty where nothing is drawn.
  std::array<double, 6> bounds() const;
  const Scene* scene() const { return scene_.get(); }
  /// The second view, beside this one; null while there is none.
  CompareView* compared() const { return compare_; }
  const WallMap& walls() const { return *walls_; }
  VtkView* vtk_view() const { return view_; }

 protected:
  /// Escape ends the mode of the mouse and forgets what was measured.
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void connect_session();
  void connect_actions();
  void follow_parts();
  void follow_surfaces();
  void follow_selection();
  bool mouse(QMouseEvent* event);
  void follow_study();
  void follow_mesh();
  void follow_cuts();
  void follow_groups();
  /// Name of the body whose filling is shown: the selected one.
  std::string choose_filled();
  FlowLook flow_look() const;
  void compare(bool on);
  /// Does the same to what either view draws.
  void each_scene(const std::function<void(Scene&)>& change);
  void set_parts(Scene& scene);
  /// The zone that is selected alone; -1: none is.
  int selected_zone() const;
  void follow_sizes();
  void follow_walls();
  void follow_mode();
  void apply_sections();
  void start_section(int axis);
  void add_section();
  Section section_across(const std::array<bool, 3>& axes) const;
  void slide_to(double position, int merge);
  std::optional<Picked> pick(const QPointF& at) const;
  void context_menu(const QPoint& at);
  void refresh();

  Session& session_;
  Actions& actions_;
  VtkView* view_ = nullptr;  // null where OpenGL is missing
  Overlay* overlay_ = nullptr;
  QSplitter* sides_ = nullptr;
  CompareView* compare_ = nullptr;
  std::unique_ptr<Scene> scene_;
  std::unique_ptr<SectionTool> tool_;
  std::optional<QPointF> pressed_;  // where a click may have begun
  ViewBar* bar_ = nullptr;
  std::unique_ptr<WallMap> walls_;
  std::unique_ptr<PickTools> picks_;
  std::unique_ptr<SizeShapes> shapes_;
  std::unique_ptr<SizeTool> size_tool_;
  int current_cut_ = -1;  // has the handle; -1: none
  std::vector<Section> sections_;
  int drag_merge_ = 0;
  std::pair<int, int> size_merge_{-1, 0};  // press of the size tool, and its step to undo
  bool section_pending_ = false;
  std::optional<std::pair<double, double>> quality_range_;
  std::string groups_shown_;
};

}  // namespace lamella::ui
