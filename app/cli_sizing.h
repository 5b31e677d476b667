#pragma once

#include "app/cli_options.h"
#include "core/sizing/sizing_object.h"

namespace lamella::cli {

/// The sizing objects that --size-sphere and its like ask for.
/// Errors: usage, naming the option and what it expects.
Result<std::vector<SizingObject>> sizing_of(const MeshCommand& command);

}  // namespace lamella::cli
