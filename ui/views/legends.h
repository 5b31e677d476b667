#pragma once

#include <string>

#include "core/study/run.h"
#include "ui/views/color_map.h"

namespace lamella::ui {

/// The scale of a field that the mesh has. `layers_asked` centers that of ColorBy::layers; `body`:
/// whose filling is shown.
Legend field_legend(ColorBy field, const MeshState& state, int layers_asked,
                    const std::string& body);

/// The scales of wall thicknesses and of smallest sizes, mm.
Legend thickness_legend(std::vector<double> values);
Legend size_legend(std::vector<double> values);

/// Why nothing is colored by the field.
Legend missing_legend(ColorBy field, bool meshed);

}  // namespace lamella::ui
