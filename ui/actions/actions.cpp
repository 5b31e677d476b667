#include "ui/actions/actions.h"

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
    {Act::open, QT_TR_NOOP("&Open…"), "open", "Ctrl+O", QT_TR_NOOP("Open a STEP or STL file")},
    {Act::add, QT_TR_NOOP("&Add body…"), "add", "Ctrl+Shift+O",
     QT_TR_NOOP("Add the bodies of another file")},
    {Act::remove, QT_TR_NOOP("&Remove body"), "remove", "Del",
     QT_TR_NOOP("Remove the selected body")},
    {Act::export_mesh, QT_TR_NOOP("&Export mesh…"), "export", "Ctrl+E",
     QT_TR_NOOP("Write the shown mesh for a solver")},
    {Act::save_picture, QT_TR_NOOP("Save &picture…"), "camera", "Ctrl+P",
     QT_TR_NOOP("Save the 3D view as a picture")},
    {Act::quit, QT_TR_NOOP("&Quit"), "", "Ctrl+Q", ""},
    {Act::undo, QT_TR_NOOP("&Undo"), "undo", "Ctrl+Z", ""},
    {Act::redo, QT_TR_NOOP("&Redo"), "redo", "Ctrl+Shift+Z", ""},
    {Act::run, QT_TR_NOOP("&Run"), "run", "F5", QT_TR_NOOP("Make the mesh")},
    {Act::cancel, QT_TR_NOOP("&Cancel"), "cancel", "Shift+F5",
     QT_TR_NOOP("Stop and keep the best mesh so far")},
    {Act::section, QT_TR_NOOP("&Section"), "section", "S",
     QT_TR_NOOP("Cut the model open with a plane you can drag"), Check::off},
    {Act::section_x, QT_TR_NOOP("Section across X"), "", "Shift+X", "", Check::off},
    {Act::section_y, QT_TR_NOOP("Section across Y"), "", "Shift+Y", "", Check::off},
    {Act::section_z, QT_TR_NOOP("Section across Z"), "", "Shift+Z", "", Check::off},
    {Act::flip, QT_TR_NOOP("&Flip section"), "flip", "Shift+F",
     QT_TR_NOOP("Show the other side of the section")},
    {Act::crinkle, QT_TR_NOOP("Cut by &whole elements"), "crinkle", "W",
     QT_TR_NOOP("Leave whole elements at the section instead of cutting through them"), Check::on},
    {Act::edges, QT_TR_NOOP("Mesh &edges"), "edges", "E",
     QT_TR_NOOP("Show the edges of the elements"), Check::on},
    {Act::features, QT_TR_NOOP("Feature e&dges"), "features", "D",
     QT_TR_NOOP("Show the edges of the CAD model"), Check::on},
    {Act::fit, QT_TR_NOOP("F&it"), "fit", "F", QT_TR_NOOP("See everything")},
    {Act::perspective, QT_TR_NOOP("&Perspective"), "perspective", "P",
     QT_TR_NOOP("Perspective instead of parallel projection"), Check::off},
    {Act::view_iso, QT_TR_NOOP("Isometric"), "iso", "0", QT_TR_NOOP("Isometric view")},
    {Act::view_front, QT_TR_NOOP("Front"), "", "1", ""},
    {Act::view_back, QT_TR_NOOP("Back"), "", "2", ""},
    {Act::view_left, QT_TR_NOOP("Left"), "", "3", ""},
    {Act::view_right, QT_TR_NOOP("Right"), "", "4", ""},
    {Act::view_top, QT_TR_NOOP("Top"), "", "5", ""},
    {Act::view_bottom, QT_TR_NOOP("Bottom"), "", "6", ""},
    {Act::show_bodies, QT_TR_NOOP("&Bodies and settings"), "", "Ctrl+1", "", Check::on},
    {Act::show_results, QT_TR_NOOP("&Convergence, report and log"), "", "Ctrl+2", "", Check::on},
    {Act::about, QT_TR_NOOP("&About Lamella"), "", "", ""},
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
}

}  // namespace lamella::ui
