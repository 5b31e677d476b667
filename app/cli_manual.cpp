#include "app/cli_manual.h"

#include <CLI/CLI.hpp>

#include "app/roff.h"
#include "core/base/version.h"

namespace lamella::cli {
namespace {

using roff::bold, roff::italic, roff::plain;

/// "-o, --output FILE", or the name of an argument.
std::string title_of(const CLI::Option& option) {
  std::string names;
  const auto add = [&](const std::string& name) {
    names += (names.empty() ? "" : ", ") + bold(name);
  };
  for (const std::string& name : option.get_snames()) add("-" + name);
  for (const std::string& name : option.get_lnames()) add("--" + name);
  const std::string value = option.get_option_text();
  if (names.empty()) return italic(option.get_name(true)) + (value == "..." ? "..." : "");
  return value.empty() || value == " " ? names : names + " " + italic(value);
}

std::string options_of(const CLI::App& app) {
  std::string page;
  for (const CLI::Option* option : app.get_options())
    if (option->get_name() != "--help")
      page += ".TP\n" + title_of(*option) + "\n" + plain(option->get_description()) + ".\n";
  return page;
}

/// "lamella-cli mesh PART... --output FILE [OPTION...]".
std::string synopsis_of(const CLI::App& app, const std::string& program) {
  std::string line = bold(program + " " + app.get_name()), more;
  for (const CLI::Option* option : app.get_options()) {
    if (!option->nonpositional() && option->get_lnames().empty())
      line += " " + title_of(*option);
    else if (option->get_required())
      line +=
          " " + bold("--" + option->get_lnames().front()) + " " + italic(option->get_option_text());
    else if (option->get_name() != "--help")
      more = " [" + italic("OPTION") + "...]";
  }
  return line + more;
}

}  // namespace

std::string manual_page(const CLI::App& app) {
  const std::string program = app.get_name();
  const auto subcommands = app.get_subcommands([](const CLI::App*) { return true; });
  std::string page = ".TH LAMELLA\\-CLI 1 \"\" \"Lamella " + version() + "\" \"User Commands\"\n" +
                     ".SH NAME\n" + plain(program) + " \\- " +
                     "make anisotropic tetrahedral meshes with layers through every wall\n" +
                     ".SH SYNOPSIS\n.nf\n";
  for (const CLI::App* sub : subcommands) page += synopsis_of(*sub, program) + "\n";
  page += ".fi\n.SH DESCRIPTION\n" + plain(app.get_description()) +
          "\n.PP\nNo display is needed. The mesh depends on the input, the settings and the seed, "
          "not on the number of threads. Files are written beside their target and renamed: a run "
          "that fails leaves nothing behind.\n.SH COMMANDS\n";
  for (const CLI::App* sub : subcommands) {
    page += ".SS " + plain(sub->get_name()) + "\n" + plain(sub->get_description()) + ".\n";
    if (!sub->get_footer().empty()) page += ".PP\n" + plain(sub->get_footer()) + "\n";
    page += options_of(*sub);
  }
  return page + ".SH NOTES\n.nf\n" + plain(app.get_footer()) +
         ".fi\n.SH SEE ALSO\n.BR lamella (1),\n.BR gmsh (1)\n";
}

}  // namespace lamella::cli
