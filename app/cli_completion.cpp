#include "app/cli_completion.h"

#include <CLI/CLI.hpp>

namespace lamella::cli {

namespace {

std::string options_of(const CLI::App& app) {
  std::string words;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames())
      words += (words.empty() ? "--" : " --") + name;
  return words;
}

/// The words of a check for one of a few, which says of itself {a,b,c}; empty for others.
std::string choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{'), close = type.find('}');
  if (open == type.npos || close == type.npos) return "";
  std::string words = type.substr(open + 1, close - open - 1);
  for (char& c : words)
    if (c == ',') c = ' ';
  return words;
}

/// "-o|--output".
std::string pattern_of(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : option.get_snames()) names += (names.empty() ? "-" : "|-") + name;
  for (const std::string& name : option.get_lnames())
    names += (names.empty() ? "--" : "|--") + name;
  return names;
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  const std::string program = app.get_name();
  std::string commands, cases;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    commands += (commands.empty() ? "" : " ") + sub->get_name();
    cases += "    " + sub->get_name() + ")\n      options='" + options_of(*sub) + "'\n";
    std::string values, words;
    for (const CLI::Option* option : sub->get_options()) {
      const std::string choices = choices_of(*option);
      const std::string pattern = pattern_of(*option);
      if (pattern.empty()) {
        words += (words.empty() ? "" : " ") + choices;
      } else if (!choices.empty()) {
        values += "        " + pattern + ") values='" + choices + "' ;;\n";
      } else if (option->get_items_expected_max() > 0) {
        values += "        " + pattern + ") return ;;\n";  // a number or a file
      }
    }
    if (!words.empty()) cases += "      words='" + words + "'\n";
    if (!values.empty()) cases += "      case $before in\n" + values + "      esac\n";
    cases += "      ;;\n";
  }
  return "# Completion of " + program +
         " for bash.\n"
         "_lamella_cli() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
         "  local options='" +
         options_of(app) +
         "' words='' values=''\n"
         "  COMPREPLY=()\n"
         "  if ((COMP_CWORD == 1)); then\n"
         "    COMPREPLY=($(compgen -W \"" +
         commands +
         " $options\" -- \"$word\"))\n"
         "    return\n"
         "  fi\n"
         "  case ${COMP_WORDS[1]} in\n" +
         cases +
         "  esac\n"
         "  if [[ -n $values ]]; then\n"
         "    COMPREPLY=($(compgen -W \"$values\" -- \"$word\"))\n"
         "  elif [[ $word == -* ]]; then\n"
         "    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
         "  elif [[ -n $words ]]; then\n"
         "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
         "  fi\n"
         "}\n"
         "complete -o default -F _lamella_cli " +
         program + "\n";
}

}  // namespace lamella::cli
