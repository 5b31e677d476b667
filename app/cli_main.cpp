#include <tbb/global_control.h>

#include <exception>
#include <optional>
#include <string>

#include "app/cli_commands.h"
#include "core/base/freed_memory.h"
#include "core/base/overloaded.h"

namespace {

/// The command line as it may be typed again.
std::string command_line(int argc, char** argv) {
  std::string line = "lamella-cli";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool plain =
        !word.empty() && word.find_first_of(" \t\n'\"\\$&|;<>()*?[]{}!#`~") == word.npos;
    line += ' ';
    if (plain) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace lamella;
  using namespace lamella::cli;
  keep_freed_memory();
  bool json = false;
  const Interrupt interrupt;
  try {
    int status = 0;
    const std::optional<Command> command = parse(argc, argv, status);
    if (!command) return status;
    json = std::visit(
        [](const auto& c) {
          if constexpr (requires { c.json; })
            return c.json;
          else
            return false;
        },
        *command);
    const int threads = std::visit(
        [](const auto& c) {
          if constexpr (requires { c.threads.value_or(0); })
            return c.threads.value_or(0);
          else if constexpr (requires { c.threads; })
            return c.threads;
          else
            return 0;
        },
        *command);
    std::optional<tbb::global_control> limit;
    if (threads > 0)
      limit.emplace(tbb::global_control::max_allowed_parallelism,
                    static_cast<std::size_t>(threads));
    Console console(json, interrupt.token());
    return std::visit(
        Overloaded{
            [&](const MeshCommand& c) { return run_mesh(c, command_line(argc, argv), console); },
            [&](const RunCommand& c) { return run_study(c, command_line(argc, argv), console); },
            [&](const AdaptCommand& c) { return run_adapt(c, console); },
            [&](const GenerateCommand& c) { return run_generate(c, console); },
            [&](const ExportCommand& c) { return run_export(c, console); },
            [&](const CheckCommand& c) { return run_check(c, console); },
            [&](const InfoCommand& c) { return run_info(c, console); },
            [&](const SampleCommand& c) { return run_sample(c, console); },
            [&](const CaseCommand& c) { return run_case(c, console); },
            [&](const BoxCommand& c) { return run_box(c, console); },
            [&](const SliceCommand& c) { return run_slice(c, console); },
            [&](const FlowCommand& c) { return run_flow(c, console); }},
        *command);
  } catch (const std::bad_alloc&) {
    return Console(json, interrupt.token())
        .fail({Code::memory, "There is not enough memory for this mesh.",
               "Ask for fewer layers or a larger --h-min."});
  } catch (const std::exception& error) {
    return Console(json, interrupt.token())
        .fail({Code::failed, std::string("Something went wrong that should not: ") + error.what(),
               "Please report it with the input."});
  }
}
