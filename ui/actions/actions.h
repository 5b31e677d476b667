#pragma once

#include <QAction>
#include <QObject>
#include <array>

namespace lamella::ui {

/// Everything the user can do that has a name.
enum class Act {
  open,
  add,
  remove,
  export_mesh,
  save_picture,
  quit,
  undo,
  redo,
  run,
  cancel,
  section,
  section_x,
  section_y,
  section_z,
  flip,
  crinkle,
  edges,
  features,
  fit,
  perspective,
  view_iso,
  view_front,
  view_back,
  view_left,
  view_right,
  view_top,
  view_bottom,
  show_bodies,
  show_results,
  about,
  count
};

/// One QAction for each Act, with text, icon, shortcut and tip from one table.
class Actions : public QObject {
  Q_OBJECT

 public:
  explicit Actions(QObject* parent = nullptr);
  QAction* operator[](Act act) const { return actions_[static_cast<std::size_t>(act)]; }

 private:
  std::array<QAction*, static_cast<std::size_t>(Act::count)> actions_{};
};

}  // namespace lamella::ui
