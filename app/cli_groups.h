#pragma once

#include <optional>
#include <string>

#include "app/cli_options.h"

namespace lamella::cli {

/// The group that one --group asks for. Its kind is the one of its name, if it is called as a kind.
/// Errors: usage.
Result<BoundaryGroup> read_group(const std::string& text);

/// "GROUP=NUMBER"; without a number it is `otherwise`, and without that an error.
Result<std::pair<std::string, double>> group_and_number(const std::string& text,
                                                        std::optional<double> otherwise);

/// What --flow and its companions ask for. Errors: usage.
Result<void> add_flow(const MeshCommand& command, Study& study);

}  // namespace lamella::cli
