#pragma once

#include <filesystem>
#include <optional>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/diagnosis.h"
#include "core/geometry/surface.h"
#include "core/geometry/wrap.h"

namespace lamella {

/// How much of a broken surface may be changed. Every change is told in the notes of a part.
enum class Repair {
  none,       ///< nothing but the order of points and windings
  automatic,  ///< small named repairs (core/geometry/repair.h), and a wrap where they do not do
  wrap        ///< every body is wrapped (core/geometry/wrap.h)
};

struct LoadParams {
  std::optional<double> chord_tolerance{};  ///< mm; unset: 1e-3 of each solid's box diagonal
  double angle_tolerance = 0.35;            ///< radians
  double unit = 1;                          ///< mm per file unit, for files that have none (STL)
  Repair repair = Repair::automatic;
  std::optional<double> wrap_spacing{};  ///< mm between the grid planes of a wrap; unset: 1/160 of
                                         ///< the diagonal, finer where walls would be lost
  double cad_seconds = 600;              ///< that reading a STEP file may take in its own process
  std::optional<double> cad_memory{};    ///< MB that it may take; unset: 3/4 of the machine's
};

/// The bodies of a STEP, IGES, BREP or STL file, by its ending, one a solid, in mm. The file is not
/// changed.
/// Errors: io (missing, unreadable), bad_input (empty, no such format, no solid, open shell), each
/// naming the file, the finding and what to try; failed and memory (the CAD library crashed, or
/// went beyond a limit: it runs in a process of its own); cancelled.
Result<std::vector<Part>> load_parts(const std::filesystem::path& file,
                                     const LoadParams& params = {}, const Progress& progress = {});

/// A wrap that replaced a surface: how far the two lie from each other, measured both ways.
struct WrapReport {
  std::vector<std::string> bodies;  ///< parts that it became
  double spacing = 0;               ///< mm between the planes of its grid
  Deviation to_file;                ///< from the wrap to the file's surface, away from holes
  Deviation from_file;              ///< back
  double bridged = 0;               ///< share of the wrap's area that closes holes
  std::size_t specks = 0;           ///< shells smaller than two cells that were left out
};

/// What a file holds as it is, what was wrapped, and its bodies or why there are none.
struct Inspection {
  FileDiagnosis diagnosis;
  std::vector<WrapReport> wraps;
  Result<std::vector<Part>> parts;
};
/// `load_parts` with a diagnosis before any repair, which a refused file gets too.
Inspection inspect_parts(const std::filesystem::path& file, const LoadParams& params = {},
                         const Progress& progress = {});

}  // namespace lamella
