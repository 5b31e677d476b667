#pragma once

#include <functional>
#include <string>

#include "core/cad/step_reader.h"

namespace lamella {

using StepWork = std::function<Result<void>(const std::filesystem::path&, const LoadParams&,
                                            const Progress&, StepContent&)>;

/// `read_step` in a child process, within the limits of `params`: OCCT crashes on some files and
/// finds no end in others. `content` is what the child found, bit by bit. `work` is what the child
/// does: tests give their own. Errors: those of `work`; failed (crash, time limit), memory,
/// cancelled.
Result<void> read_step_in_child(const std::filesystem::path& file, const LoadParams& params,
                                const Progress& progress, StepContent& content,
                                const StepWork& work = read_step);

/// What the child hands back, and back again; false when the bytes are no such thing.
std::string to_bytes(const StepContent& content, const Result<void>& outcome);
bool from_bytes(const std::string& bytes, StepContent& content, Result<void>& outcome);

}  // namespace lamella
