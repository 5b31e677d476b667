#pragma once

#include <QAction>
#include <QObject>
#include <array>

namespace lamella::ui {

/// Everything the user can do that has a name.
enum class Act {
  open,
  add,
  reload,
  save,
  save_as,
  remove,
  export_mesh,
  save_report,
  save_picture,
  copy_command,
  preferences,
  quit,
  undo,
  redo,
  run,
  pause,
  cancel,
  forecast,
  overlaps,
  solve_flow,
  add_group,
  zone_ball,
  zone_box,
  zone_cylinder,
  zone_half_space,
  add_sphere,
  add_box,
  add_cylinder,
  pick_faces,  // the modes of the view, up to box_zoom
  pick_flood,
  correct_near,
  correct_face,
  measure,
  ellipsoid,
  box_zoom,
  section,
  section_x,
  section_y,
  section_z,
  flip,
  add_cut,
  crinkle,
  edges,
  features,
  flow_arrows,
  flow_lines,
  flow_levels,
  fit,
  perspective,
  compare,
  view_iso,
  view_front,
  view_back,
  view_left,
  view_right,
  view_top,
  view_bottom,
  show_study,
  show_properties,
  show_results,
  search,
  shortcuts,
  journal,
  about,
  count
};

/// One QAction for each Act, with text, icon, shortcut and tip from one table.
class Actions : public QObject {
  Q_OBJECT

 public:
  explicit Actions(QObject* parent = nullptr);
  QAction* operator[](Act act) const { return actions_[static_cast<std::size_t>(act)]; }
  /// The mode of the view that is on; Act::count: none, a click selects.
  Act mode() const;
  void leave_mode();
  /// Draws the icons anew, for another theme.
  void refresh_icons();

 private:
  std::array<QAction*, static_cast<std::size_t>(Act::count)> actions_{};
};

}  // namespace lamella::ui
