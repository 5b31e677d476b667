#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"

class TopoDS_Shape;

namespace lamella {

/// What a STEP file says about one of its solids.
struct SolidInfo {
  std::string name;                         ///< of the product, unique in the file, never empty
  std::array<double, 3> color{-1, -1, -1};  ///< sRGB in [0, 1]; negative: none
  std::vector<std::array<double, 3>> face_colors;  ///< [face], in the order of the solid's faces
  std::vector<std::string> notes;
};

/// Called once a solid, in mm and placed as in the assembly.
using SolidVisitor =
    std::function<Result<void>(const TopoDS_Shape& solid, SolidInfo info, const Progress&)>;

/// Reads the leaves of the assembly of a STEP file. Free shells and faces are left out, with a
/// note. Must run inside `guarded`. Errors: io; bad_input (empty, not STEP, truncated, no solid);
/// cancelled; those of `visit`.
Result<void> read_step(const std::filesystem::path& file, const Progress& progress,
                       const SolidVisitor& visit);

}  // namespace lamella
