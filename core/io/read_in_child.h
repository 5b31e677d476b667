#pragma once

#include <filesystem>

#include "core/io/mesh_format.h"

namespace lamella {

/// What `read` makes of the file in a process of its own, for libraries that believe the lengths
/// which a damaged file states: what they take is bounded by the size of the file (1 GB and a
/// hundred times the file, a minute and a second for each MB), and a crash ends there.
/// Errors: those of `read`; bad_input where it crashed or went beyond a limit; cancelled.
Result<MeshContent> read_in_child(
    const std::filesystem::path& file,
    const std::function<Result<MeshContent>(const std::filesystem::path&, const Progress&)>& read,
    const Progress& progress);

}  // namespace lamella
