#pragma once

#include "app/cli_options.h"

namespace CLI {
class App;
}

namespace lamella::cli {

/// The options of `run` and of `case`.
void add_run(CLI::App* app, RunCommand& run);
void add_case(CLI::App* e, CaseCommand& made);

}  // namespace lamella::cli
