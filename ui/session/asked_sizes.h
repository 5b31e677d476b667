#pragma once

#include "ui/session/wall_map.h"

namespace lamella::ui {

/// The smallest size (mm) that the study asks for on the surfaces of its bodies, in the place of
/// the thickness of `walls`: that over n within h_min and h_max, with the sizing objects. Of one
/// whose shape is not right yet nothing is taken.
WallMap::Maps asked_sizes(const Session& session, const WallMap::Maps& walls);

}  // namespace lamella::ui
