#pragma once

#include "app/cli_options.h"

namespace CLI {
class App;
}

namespace lamella::cli {

/// The options of `run`.
void add_run(CLI::App* app, RunCommand& run);

}  // namespace lamella::cli
