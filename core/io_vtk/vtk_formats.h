#pragma once

#include "core/io/mesh_format.h"

namespace lamella {

/// The formats that VTK writes: vtu, exodus.
std::vector<MeshFormat> vtk_formats();

}  // namespace lamella
