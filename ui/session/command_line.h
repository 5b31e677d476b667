#pragma once

#include "core/base/result.h"
#include "core/study/study.h"

namespace lamella::ui {

/// The lamella-cli command that makes the mesh of the study, with its inputs as they are named
/// there. Errors: usage, when the options of the command cannot say what the study does.
Result<std::string> command_line(const Study& study);

/// The same for a study that is in a file.
std::string command_line_for(const std::string& study_file);

}  // namespace lamella::ui
