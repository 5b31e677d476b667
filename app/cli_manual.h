#pragma once

#include <string>

namespace CLI {
class App;
}

namespace lamella::cli {

/// The manual page of the program, section 1, from what its subcommands and options say of
/// themselves.
std::string manual_page(const CLI::App& app);

}  // namespace lamella::cli
