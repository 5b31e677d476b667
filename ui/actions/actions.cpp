#include "ui/actions/actions.h"

#include <QActionGroup>

#include "ui/theme.h"

namespace lamella::ui {
namespace {

enum class Check { no, off, on };

struct Row {
  Act act;
  const char* text;
  const char* icon;
  const char* shortcut;
  const char* tip;
  Check check = Check::no;
};

constexpr Row table[] = {
    {Act::open, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Open…"), "open", "Ctrl+O",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Open a study, a STEP or an STL file")},
    {Act::add, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Add body…"), "add", "Ctrl+Shift+O",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Add the bodies of another file")},
    {Act::save, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Save study"), "save", "Ctrl+S",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "Save the study, its mesh and its report in one file")},
    {Act::save_as, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Save study &as…"), "", "Ctrl+Shift+S",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Save the study under another name")},
    {Act::remove, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Remove"), "remove", "Del",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Remove what is selected in the study")},
    {Act::export_mesh, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Export mesh…"), "export",
     "Ctrl+E", QT_TRANSLATE_NOOP("lamella::ui::Actions", "Write the shown mesh for a solver")},
    {Act::save_report, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Save repor&t…"), "", "",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Save the report of the run as PDF or HTML")},
    {Act::save_picture, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Save &picture…"), "camera",
     "Ctrl+P",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Save the 3D view as a picture of any resolution")},
    {Act::copy_command, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Copy as command line"), "",
     "Ctrl+Shift+C",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "Copy the lamella-cli command that makes the same mesh")},
    {Act::preferences, QT_TRANSLATE_NOOP("lamella::ui::Actions", "P&references"), "", "Ctrl+,",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Theme, language, unit, memory, threads")},
    {Act::quit, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Quit"), "", "Ctrl+Q", ""},
    {Act::undo, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Undo"), "undo", "Ctrl+Z", ""},
    {Act::redo, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Redo"), "redo", "Ctrl+Shift+Z", ""},
    {Act::run, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Run"), "run", "F5",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Make the mesh")},
    {Act::pause, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Pa&use"), "pause", "Ctrl+F5",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "Hold the run and leave the processors to others; once more goes on"),
     Check::off},
    {Act::cancel, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Cancel"), "cancel", "Shift+F5",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Stop and keep the best mesh so far")},
    {Act::forecast, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Forecast"), "forecast", "F6",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "Tell the nodes and the memory to expect, without meshing")},
    {Act::overlaps, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Find &overlaps and gaps"),
     "overlaps", "F7",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "Look where bodies overlap, and where they leave gaps between them")},
    {Act::solve_flow, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Solve the flow"), "flow", "F8",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "Solve the flow between gates and vents through the mesh that is shown")},
    {Act::add_group, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Add boundary &group"), "group", "G",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "Name a part of the boundary: gate, vent, symmetry")},
    {Act::zone_ball, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Body by formula: &ball"), "sphere",
     "",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "A body that needs no file; it is meshed in one mesh of all bodies")},
    {Act::zone_box, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Body by formula: b&ox"), "box", "",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "A body that needs no file; it is meshed in one mesh of all bodies")},
    {Act::zone_cylinder, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Body by formula: &cylinder"),
     "cylinder", "",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "A body that needs no file; it is meshed in one mesh of all bodies")},
    {Act::zone_half_space,
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Body by formula: &half-space"), "half-space", "",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "What is on one side of a plane, as far as the domain reaches")},
    {Act::add_sphere,
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Add a &sphere with a size of its own"), "sphere",
     "", ""},
    {Act::add_box, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Add a &box with a size of its own"),
     "box", "", ""},
    {Act::add_cylinder,
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Add a c&ylinder with a size of its own"),
     "cylinder", "", ""},
    {Act::pick_faces, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Pick faces of the group"), "pick",
     "Shift+G",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "Click faces to add them to the selected group, or to take them out"),
     Check::off},
    {Act::pick_flood, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Flood from a point"), "flood", "",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "Click where the group is to begin: it spreads until the surface turns"),
     Check::off},
    {Act::correct_near, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Correct &near a point"),
     "sphere", "N",
     QT_TRANSLATE_NOOP(
         "lamella::ui::Actions",
         "Click a place, such as the gate: a sphere with a size of its own is put there"),
     Check::off},
    {Act::correct_face, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Correct on a &face"), "pick",
     "Shift+N",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "Click a CAD face that is to have a size of its own"),
     Check::off},
    {Act::measure, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Measure distances"), "measure", "M",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "Click two places to see their distance; a third click begins anew"),
     Check::off},
    {Act::ellipsoid, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Show the metric at a &click"),
     "ellipsoid", "J",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "Click the mesh to see the element sizes asked there, as an ellipsoid"),
     Check::off},
    {Act::box_zoom, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Zoom to a box"), "box-zoom", "Z",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Draw a rectangle to bring it close"), Check::off},
    {Act::section, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Section"), "section", "S",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Cut the model open with a plane you can drag"),
     Check::off},
    {Act::section_x, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Section across X"), "", "Shift+X",
     "", Check::off},
    {Act::section_y, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Section across Y"), "", "Shift+Y",
     "", Check::off},
    {Act::section_z, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Section across Z"), "", "Shift+Z",
     "", Check::off},
    {Act::flip, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Flip section"), "flip", "Shift+F",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Show the other side of the section")},
    {Act::add_cut, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Another section"), "add", "Shift+S",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Cut with one more plane")},
    {Act::crinkle, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Cut by &whole elements"), "crinkle",
     "W",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "Leave whole elements at the section instead of cutting through them"),
     Check::on},
    {Act::edges, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Mesh &edges"), "edges", "E",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Show the edges of the elements"), Check::on},
    {Act::features, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Feature e&dges"), "features", "D",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Show the edges of the CAD model"), Check::on},
    {Act::flow_arrows, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Flow &arrows"), "", "A",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "Show the flow as arrows, on the section or within the mesh"),
     Check::off},
    {Act::flow_lines, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Stream&lines"), "", "L",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Show the ways of the fluid from the gates"),
     Check::off},
    {Act::flow_levels, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Le&vel sets"), "", "V",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "Show lines of equal velocity on the section, or of equal pressure"),
     Check::off},
    {Act::fit, QT_TRANSLATE_NOOP("lamella::ui::Actions", "F&it"), "fit", "F",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "See everything")},
    {Act::perspective, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Perspective"), "perspective",
     "P", QT_TRANSLATE_NOOP("lamella::ui::Actions", "Perspective instead of parallel projection"),
     Check::off},
    {Act::compare, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Two views side b&y side"), "compare",
     "B",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "Show another iteration beside this one, with the same camera and cuts"),
     Check::off},
    {Act::view_iso, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Isometric"), "iso", "0",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Isometric view")},
    {Act::view_front, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Front"), "", "1", ""},
    {Act::view_back, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Back"), "", "2", ""},
    {Act::view_left, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Left"), "", "3", ""},
    {Act::view_right, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Right"), "", "4", ""},
    {Act::view_top, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Top"), "", "5", ""},
    {Act::view_bottom, QT_TRANSLATE_NOOP("lamella::ui::Actions", "Bottom"), "", "6", ""},
    {Act::show_study, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Study"), "", "Ctrl+1", "",
     Check::on},
    {Act::show_properties, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Properties"), "", "Ctrl+2",
     "", Check::on},
    {Act::show_results, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Convergence, report and log"),
     "", "Ctrl+3", "", Check::on},
    {Act::search, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Search actions…"), "search", "Ctrl+K",
     QT_TRANSLATE_NOOP("lamella::ui::Actions", "Find any action by its name")},
    {Act::shortcuts, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Keyboard shortcuts"), "", "F1",
     ""},
    {Act::journal, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&Journal"), "", "",
     QT_TRANSLATE_NOOP("lamella::ui::Actions",
                       "What was done, line by line, in this window and in one that crashed")},
    {Act::about, QT_TRANSLATE_NOOP("lamella::ui::Actions", "&About Lamella"), "", "", ""},
};
static_assert(std::size(table) == static_cast<std::size_t>(Act::count));

}  // namespace

Actions::Actions(QObject* parent) : QObject(parent) {
  for (const Row& row : table) {
    auto* action = new QAction(tr(row.text), this);
    if (*row.icon) action->setIcon(icon(row.icon));
    if (*row.shortcut) action->setShortcut(QKeySequence(QString(row.shortcut)));
    QString tip = *row.tip ? tr(row.tip) : tr(row.text).remove('&');
    if (*row.shortcut)
      tip += QString("  (%1)").arg(action->shortcut().toString(QKeySequence::NativeText));
    action->setToolTip(tip);
    action->setCheckable(row.check != Check::no);
    action->setChecked(row.check == Check::on);
    actions_[static_cast<std::size_t>(row.act)] = action;
  }
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
  for (const Row& row : table)
    if (*row.icon) (*this)[row.act]->setIcon(icon(row.icon));
}

}  // namespace lamella::ui
