#pragma once

#include <string>

#include "core/base/result.h"
#include "core/study/group.h"

namespace lamella::cli {

/// The group that one --group asks for. Its kind is the one of its name, if it is called as a kind.
/// Errors: usage.
Result<BoundaryGroup> read_group(const std::string& text);

}  // namespace lamella::cli
