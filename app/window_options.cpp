#include "app/window_options.h"

#include "app/roff.h"
#include "core/base/version.h"

namespace lamella {
namespace {

constexpr const char* kFiles =
    "a study (.lamella), STEP, IGES, BREP or STL parts, or one mesh (.msh, .vtu, .mesh, ..)";

}  // namespace

WindowOptions::WindowOptions() {
  parser_.setApplicationDescription(
      "Anisotropic tetrahedral meshes with n layers through every wall: the window.\n"
      "Ctrl+K finds any action by its name, F1 lists the keys. What is unsaved is kept\n"
      "every second; after a crash the next start offers to recover it.");
  parser_.addPositionalArgument("files", kFiles, "[FILE...]");
  add({"report-pdf",
       "write the report of FILE, a .report.html or a .lamella, as PDF, and leave; needs no "
       "display",
       "OUT.pdf"});
  shown_.push_back(parser_.addHelpOption());
  shown_.push_back(parser_.addVersionOption());
  const auto hidden = [&](const QString& name, const QString& text, const QString& value = {}) {
    QCommandLineOption option(name, text, value);
    option.setFlags(QCommandLineOption::HiddenFromHelp);
    add(option);
  };
  hidden("manual", "prints the manual page");
  hidden("run", "mesh the parts");
  hidden("iteration", "picture while the run goes on, after this iteration", "K");
  hidden("cut", "picture with a section");
  hidden("flat", "the section cuts through elements");
  hidden("near", "brings what is within R of a point close", "X,Y,Z,R");
  hidden("color",
         "body, quality, thickness, layers, filling, size, or of a flow speed, pressure, shear or "
         "indicator, or the field of another solver",
         "FIELD");
  hidden("flow", "arrows, lines, levels: what of the flow is drawn", "LIST");
  hidden("dark", "the dark theme");
  hidden("size", "of the window", "WIDTHxHEIGHT");
  hidden("select", "group, sizing, cut or domain whose properties are shown", "KIND");
  hidden("tab", "tab of the results, from 0", "K");
  hidden("dialog", "export, preferences, shortcuts, journal or search: that instead of the window",
         "NAME");
  hidden("leave", "leave as soon as the window can be used");
  hidden("screenshot", "picture of the window, then leave", "FILE");
  hidden("section", "picture of a section, then leave", "FILE");
}

void WindowOptions::add(const QCommandLineOption& option) {
  parser_.addOption(option);
  if (!(option.flags() & QCommandLineOption::HiddenFromHelp)) shown_.push_back(option);
}

std::string WindowOptions::manual_page() const {
  using namespace roff;
  const std::string about = parser_.applicationDescription().toStdString();
  std::string page =
      ".TH LAMELLA 1 \"\" \"Lamella " + version() + "\" \"User Commands\"\n" +
      ".SH NAME\nlamella \\- anisotropic tetrahedral meshes for injection molding\n" +
      ".SH SYNOPSIS\n" + bold("lamella") + " [" + italic("OPTION") + "...] [" + italic("FILE") +
      "...]\n.SH DESCRIPTION\n" + plain(about) + "\n.PP\n" + italic("FILE") + ": " + plain(kFiles) +
      "\n.SH OPTIONS\n";
  for (const QCommandLineOption& option : shown_) {
    std::string names;
    for (const QString& name : option.names())
      names +=
          (names.empty() ? "" : ", ") + bold((name.size() == 1 ? "-" : "--") + name.toStdString());
    if (!option.valueName().isEmpty()) names += " " + italic(option.valueName().toStdString());
    page += ".TP\n" + names + "\n" + plain(option.description().toStdString()) + "\n";
  }
  return page + ".SH SEE ALSO\n.BR lamella\\-cli (1)\n";
}

}  // namespace lamella
