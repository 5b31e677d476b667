#pragma once

#include <functional>
#include <string>

#include "core/base/result.h"

namespace lamella {

/// Runs OCCT code, one caller at a time (its settings are global): exceptions of OCCT and of the
/// standard library, and crashes inside OCCT, become an Error that begins with `subject`.
Result<void> guarded(const std::string& subject, const std::function<Result<void>()>& action);

}  // namespace lamella
