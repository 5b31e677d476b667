#pragma once

#include <string>

namespace CLI {
class App;
}

namespace lamella::cli {

/// A script for bash that completes the subcommands of the program, their options, the values of
/// options that take one of a few, and files for all others.
std::string bash_completion(const CLI::App& app);

}  // namespace lamella::cli
