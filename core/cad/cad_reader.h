#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/cad/load_parts.h"
#include "core/geometry/triangles.h"

namespace lamella {

/// What a CAD file says about one of its solids.
struct SolidInfo {
  std::string name;                         ///< of the product, unique in the file, never empty
  std::array<double, 3> color{-1, -1, -1};  ///< sRGB in [0, 1]; negative: none
  std::vector<std::array<double, 3>> face_colors;  ///< [face], in the order of the solid's faces
  std::vector<std::string> notes;
};

/// One solid, tessellated; or, where that has no sound surface, why and its triangles as they came;
/// or, where the file has no exact geometry, its triangles alone.
struct CadBody {
  Part part;  ///< without a surface where there are but triangles
  std::optional<Error> refusal;
  Triangles rough;
  bool exact_shape_valid = true;  ///< by the kernel's own check
};

struct CadContent {
  std::vector<CadBody> bodies;
  std::size_t free_shells = 0;
  std::size_t free_faces = 0;
};

/// Lower case, with its dot.
std::string extension_of(const std::filesystem::path& file);

enum class CadFormat { step, iges, brep };

/// By the ending; nothing for others.
std::optional<CadFormat> cad_format_of(const std::filesystem::path& file);

/// Reads and tessellates the leaves of the assembly of a STEP, IGES or BREP file, in mm (a BREP
/// file has no unit and is taken to be in mm). Free shells and faces beside solids are left out,
/// with a note; without any solid they are sewn, with a note, unless `params.repair` is none. Must
/// run inside `guarded` or `guarded_alone`. What was found before an error is in `content`. Errors:
/// io; bad_input (empty, of another format, truncated, no shape); cancelled.
Result<void> read_cad(const std::filesystem::path& file, const LoadParams& params,
                      const Progress& progress, CadContent& content);

}  // namespace lamella
