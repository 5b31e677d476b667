#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/triangles.h"

namespace lamella {

struct TessellatedBody {
  std::string name;   ///< of the file, may be empty
  TriangleSoup soup;  ///< mm
};

/// The tessellated solids of a STEP text (AP242), which OCCT passes over; of a text without any,
/// its tessellated shells. Where a text lacks what it refers to, those facets are left out.
/// Positions in an assembly are not applied.
std::vector<TessellatedBody> tessellated_bodies(std::string_view text);

}  // namespace lamella
