#pragma once

#include <string>
#include <vector>

#include "core/study/study.h"

namespace lamella {

/// Makes what the study asks of faces by number name the same places of parts that were read again:
/// the numbers of CAD faces change with the model. A face goes to the one of its part most like it
/// in place, area and direction; those of a part without other numbers stay as they are. What has
/// no such face is left out. Returns notes that tell of it, one a face.
std::vector<std::string> move_faces(Study& study, const std::vector<Part>& before,
                                    const std::vector<Part>& after);

}  // namespace lamella
