#pragma once

#include <filesystem>
#include <optional>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"

namespace lamella {

struct LoadParams {
  std::optional<double> chord_tolerance{};  ///< mm; unset: 1e-3 of each solid's box diagonal
  double angle_tolerance = 0.35;            ///< radians
  double unit = 1;                          ///< mm per file unit, for files that have none (STL)
};

/// The bodies of a STEP (.step, .stp) or STL (.stl) file, one a solid, in mm.
/// Errors: io (missing, unreadable), bad_input (empty, not STEP/STL, no solid, open shell), each
/// naming the file, the finding and what to try; cancelled.
Result<std::vector<Part>> load_parts(const std::filesystem::path& file,
                                     const LoadParams& params = {}, const Progress& progress = {});

}  // namespace lamella
