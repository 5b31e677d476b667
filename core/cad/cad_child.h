#pragma once

#include <functional>
#include <string>

#include "core/cad/cad_reader.h"

namespace lamella {

using CadWork = std::function<Result<void>(const std::filesystem::path&, const LoadParams&,
                                           const Progress&, CadContent&)>;

/// `read_cad` in a child process, within the limits of `params`: OCCT crashes on some files and
/// finds no end in others. `content` is what the child found, bit by bit. `work` is what the child
/// does: tests give their own. Errors: those of `work`; failed (crash, time limit), memory,
/// cancelled.
Result<void> read_cad_in_child(const std::filesystem::path& file, const LoadParams& params,
                               const Progress& progress, CadContent& content,
                               const CadWork& work = read_cad);

/// What the child hands back, and back again; false when the bytes are no such thing.
std::string to_bytes(const CadContent& content, const Result<void>& outcome);
bool from_bytes(const std::string& bytes, CadContent& content, Result<void>& outcome);

}  // namespace lamella
