#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"

namespace lamella {

/// Raw facets of an STL file, ASCII or binary (a binary file may begin with "solid"); stored
/// normals are ignored, as files often get them wrong.
/// Errors: io (missing, unreadable), bad_input (empty, not an STL, truncated).
Result<std::vector<std::array<Vec<3>, 3>>> read_stl(const std::filesystem::path& file,
                                                    const Progress& progress = {});

Result<void> write_stl(const ReferenceSurface<3>& surface, const std::filesystem::path& file);

}  // namespace lamella
