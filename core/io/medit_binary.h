#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// By its ending.
inline bool is_medit_binary(const std::filesystem::path& file) {
  return file.extension() == ".meshb";
}

/// A binary Medit file (.meshb, .solb; versions 1 to 4, 2D or 3D) as the text that `read_medit` and
/// `read_sol` know, every number kept; sections that neither of them uses are left out.
/// Errors: bad_input (another byte order, truncated, a section that points nowhere).
Result<std::string> text_of_medit_binary(const std::filesystem::path& file, std::string_view bytes);

/// The bytes of a .meshb of version 2, or 3 when it has more than 2 GB. `body_refs` and
/// `group_refs`: the reference of each.
template <int D>
std::string medit_binary(const SimplexMesh<D>& mesh, const std::vector<std::int32_t>& body_refs,
                         const std::vector<std::int32_t>& group_refs);

}  // namespace lamella
