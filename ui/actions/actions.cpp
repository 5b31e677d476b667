#include "ui/actions/actions.h"

#include <QActionGroup>

#include "ui/theme.h"

namespace lamella::ui {
namespace {

enum class Check { no, off, on };

constexpr const char* icon_name = "icon_name";

struct Row {
  Act act;
  const char* text;
  const char* icon;
  const char* shortcut;
  const char* tip;
  Check check = Check::no;
};

}  // namespace

Actions::Actions(QObject* parent) : QObject(parent) {
  // Here, so that lupdate knows whose texts these are.
  static constexpr Row table[] = {
      {Act::open, QT_TR_NOOP("&Open…"), "open", "Ctrl+O",
       QT_TR_NOOP("Open a study, a CAD file or an STL file")},
      {Act::add, QT_TR_NOOP("&Add body…"), "add", "Ctrl+Shift+O",
       QT_TR_NOOP("Add the bodies of another file, be it CAD, an STL or a mesh")},
      {Act::reload, QT_TR_NOOP("Re&load the parts"), "", "Ctrl+R",
       QT_TR_NOOP("Read the files of the parts again; settings, groups and sizes stay")},
      {Act::save, QT_TR_NOOP("&Save study"), "save", "Ctrl+S",
       QT_TR_NOOP("Save the study, its mesh and its report in one file")},
      {Act::save_as, QT_TR_NOOP("Save study &as…"), "", "Ctrl+Shift+S",
       QT_TR_NOOP("Save the study under another name")},
      {Act::remove, QT_TR_NOOP("&Remove"), "remove", "Del",
       QT_TR_NOOP("Remove what is selected in the study")},
      {Act::export_mesh, QT_TR_NOOP("&Export mesh…"), "export", "Ctrl+E",
       QT_TR_NOOP("Write the shown mesh for a solver")},
      {Act::save_report, QT_TR_NOOP("Save repor&t…"), "", "",
       QT_TR_NOOP("Save the report of the run as PDF or HTML")},
      {Act::save_picture, QT_TR_NOOP("Save &picture…"), "camera", "Ctrl+P",
       QT_TR_NOOP("Save the 3D view as a picture of any resolution")},
      {Act::copy_command, QT_TR_NOOP("&Copy as command line"), "", "Ctrl+Shift+C",
       QT_TR_NOOP("Copy the lamella-cli command that makes the same mesh")},
      {Act::preferences, QT_TR_NOOP("P&references"), "", "Ctrl+,",
       QT_TR_NOOP("Theme, language, unit, memory, threads")},
      {Act::quit, QT_TR_NOOP("&Quit"), "", "Ctrl+Q", ""},
      {Act::undo, QT_TR_NOOP("&Undo"), "undo", "Ctrl+Z", ""},
      {Act::redo, QT_TR_NOOP("&Redo"), "redo", "Ctrl+Shift+Z", ""},
      {Act::run, QT_TR_NOOP("&Run"), "run", "F5", QT_TR_NOOP("Make the mesh")},
      {Act::pause, QT_TR_NOOP("Pa&use"), "pause", "Ctrl+F5",
       QT_TR_NOOP("Hold the run and leave the processors to others; once more goes on"),
       Check::off},
      {Act::cancel, QT_TR_NOOP("&Cancel"), "cancel", "Shift+F5",
       QT_TR_NOOP("Stop and keep the best mesh so far")},
      {Act::forecast, QT_TR_NOOP("&Forecast"), "forecast", "F6",
       QT_TR_NOOP("Tell the nodes and the memory to expect, without meshing")},
      {Act::overlaps, QT_TR_NOOP("Find &overlaps and gaps"), "overlaps", "F7",
       QT_TR_NOOP("Look where bodies overlap, and where they leave gaps between them")},
      {Act::solve_flow, QT_TR_NOOP("&Solve the flow"), "flow", "F8",
       QT_TR_NOOP("Solve the flow between gates and vents through the mesh that is shown")},
      {Act::add_group, QT_TR_NOOP("Add boundary &group"), "group", "G",
       QT_TR_NOOP("Name a part of the boundary: gate, vent, symmetry")},
      {Act::zone_ball, QT_TR_NOOP("Body by formula: &ball"), "sphere", "",
       QT_TR_NOOP("A body that needs no file; it is meshed in one mesh of all bodies")},
      {Act::zone_box, QT_TR_NOOP("Body by formula: b&ox"), "box", "",
       QT_TR_NOOP("A body that needs no file; it is meshed in one mesh of all bodies")},
      {Act::zone_cylinder, QT_TR_NOOP("Body by formula: &cylinder"), "cylinder", "",
       QT_TR_NOOP("A body that needs no file; it is meshed in one mesh of all bodies")},
      {Act::zone_half_space, QT_TR_NOOP("Body by formula: &half-space"), "half-space", "",
       QT_TR_NOOP("What is on one side of a plane, as far as the domain reaches")},
      {Act::add_sphere, QT_TR_NOOP("Add a &sphere with a size of its own"), "sphere", "", ""},
      {Act::add_box, QT_TR_NOOP("Add a &box with a size of its own"), "box", "", ""},
      {Act::add_cylinder, QT_TR_NOOP("Add a c&ylinder with a size of its own"), "cylinder", "", ""},
      {Act::pick_faces, QT_TR_NOOP("&Pick faces of the group"), "pick", "Shift+G",
       QT_TR_NOOP("Click faces to add them to the selected group, or to take them out"),
       Check::off},
      {Act::pick_flood, QT_TR_NOOP("&Flood from a point"), "flood", "",
       QT_TR_NOOP("Click where the group is to begin: it spreads until the surface turns"),
       Check::off},
      {Act::correct_near, QT_TR_NOOP("Correct &near a point"), "sphere", "N",
       QT_TR_NOOP("Click a place, such as the gate: a sphere with a size of its own is put there"),
       Check::off},
      {Act::correct_face, QT_TR_NOOP("Correct on a &face"), "pick", "Shift+N",
       QT_TR_NOOP("Click a CAD face that is to have a size of its own"), Check::off},
      {Act::measure, QT_TR_NOOP("&Measure distances"), "measure", "M",
       QT_TR_NOOP("Click two places to see their distance; a third click begins anew"), Check::off},
      {Act::ellipsoid, QT_TR_NOOP("Show the metric at a &click"), "ellipsoid", "J",
       QT_TR_NOOP("Click the mesh to see the element sizes asked there, as an ellipsoid"),
       Check::off},
      {Act::box_zoom, QT_TR_NOOP("&Zoom to a box"), "box-zoom", "Z",
       QT_TR_NOOP("Draw a rectangle to bring it close"), Check::off},
      {Act::section, QT_TR_NOOP("&Section"), "section", "S",
       QT_TR_NOOP("Cut the model open with a plane you can drag"), Check::off},
      {Act::section_x, QT_TR_NOOP("Section across X"), "", "Shift+X", "", Check::off},
      {Act::section_y, QT_TR_NOOP("Section across Y"), "", "Shift+Y", "", Check::off},
      {Act::section_z, QT_TR_NOOP("Section across Z"), "", "Shift+Z", "", Check::off},
      {Act::flip, QT_TR_NOOP("&Flip section"), "flip", "Shift+F",
       QT_TR_NOOP("Show the other side of the section")},
      {Act::add_cut, QT_TR_NOOP("&Another section"), "add", "Shift+S",
       QT_TR_NOOP("Cut with one more plane")},
      {Act::crinkle, QT_TR_NOOP("Cut by &whole elements"), "crinkle", "W",
       QT_TR_NOOP("Leave whole elements at the section instead of cutting through them"),
       Check::on},
      {Act::edges, QT_TR_NOOP("Mesh &edges"), "edges", "E",
       QT_TR_NOOP("Show the edges of the elements"), Check::on},
      {Act::features, QT_TR_NOOP("Feature e&dges"), "features", "D",
       QT_TR_NOOP("Show the edges of the CAD model"), Check::on},
      {Act::flow_arrows, QT_TR_NOOP("Flow &arrows"), "", "A",
       QT_TR_NOOP("Show the flow as arrows, on the section or within the mesh"), Check::off},
      {Act::flow_lines, QT_TR_NOOP("Stream&lines"), "", "L",
       QT_TR_NOOP("Show the ways of the fluid from the gates"), Check::off},
      {Act::flow_levels, QT_TR_NOOP("Le&vel sets"), "", "V",
       QT_TR_NOOP("Show lines of equal velocity on the section, or of equal pressure"), Check::off},
      {Act::fit, QT_TR_NOOP("F&it"), "fit", "F", QT_TR_NOOP("See everything")},
      {Act::perspective, QT_TR_NOOP("&Perspective"), "perspective", "P",
       QT_TR_NOOP("Perspective instead of parallel projection"), Check::off},
      {Act::compare, QT_TR_NOOP("Two views side b&y side"), "compare", "B",
       QT_TR_NOOP("Show another iteration beside this one, with the same camera and cuts"),
       Check::off},
      {Act::view_iso, QT_TR_NOOP("Isometric"), "iso", "0", QT_TR_NOOP("Isometric view")},
      {Act::view_front, QT_TR_NOOP("Front"), "", "1", ""},
      {Act::view_back, QT_TR_NOOP("Back"), "", "2", ""},
      {Act::view_left, QT_TR_NOOP("Left"), "", "3", ""},
      {Act::view_right, QT_TR_NOOP("Right"), "", "4", ""},
      {Act::view_top, QT_TR_NOOP("Top"), "", "5", ""},
      {Act::view_bottom, QT_TR_NOOP("Bottom"), "", "6", ""},
      {Act::show_study, QT_TR_NOOP("&Study"), "", "Ctrl+1", "", Check::on},
      {Act::show_properties, QT_TR_NOOP("&Properties"), "", "Ctrl+2", "", Check::on},
      {Act::show_results, QT_TR_NOOP("&Convergence, report and log"), "", "Ctrl+3", "", Check::on},
      {Act::search, QT_TR_NOOP("&Search actions…"), "search", "Ctrl+K",
       QT_TR_NOOP("Find any action by its name")},
      {Act::shortcuts, QT_TR_NOOP("&Keyboard shortcuts"), "", "F1", ""},
      {Act::journal, QT_TR_NOOP("&Journal"), "", "",
       QT_TR_NOOP("What was done, line by line, in this window and in one that crashed")},
      {Act::about, QT_TR_NOOP("&About Lamella"), "", "", ""},
  };
  static_assert(std::size(table) == static_cast<std::size_t>(Act::count));
  for (const Row& row : table) {
    auto* action = new QAction(tr(row.text), this);
    action->setProperty(icon_name, row.icon);
    if (*row.shortcut) action->setShortcut(QKeySequence(QString(row.shortcut)));
    QString tip = *row.tip ? tr(row.tip) : tr(row.text).remove('&');
    if (*row.shortcut)
      tip += QString("  (%1)").arg(action->shortcut().toString(QKeySequence::NativeText));
    action->setToolTip(tip);
    action->setCheckable(row.check != Check::no);
    action->setChecked(row.check == Check::on);
    actions_[static_cast<std::size_t>(row.act)] = action;
  }
  refresh_icons();
  auto* modes = new QActionGroup(this);
  modes->setExclusionPolicy(QActionGroup::ExclusionPolicy::ExclusiveOptional);
  for (int a = int(Act::pick_faces); a <= int(Act::box_zoom); ++a)
    modes->addAction((*this)[Act(a)]);
}

Act Actions::mode() const {
  for (int a = int(Act::pick_faces); a <= int(Act::box_zoom); ++a)
    if ((*this)[Act(a)]->isChecked()) return Act(a);
  return Act::count;
}

void Actions::leave_mode() {
  if (mode() != Act::count) (*this)[mode()]->setChecked(false);
}

void Actions::refresh_icons() {
  for (QAction* action : actions_)
    if (const QString name = action->property(icon_name).toString(); !name.isEmpty())
      action->setIcon(icon(name));
}

}  // namespace lamella::ui
