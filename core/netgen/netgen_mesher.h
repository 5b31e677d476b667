#pragma once

#include <memory>

#include "core/optimize/generate.h"

namespace lamella {

/// Netgen's library (LGPL) as the fallback for the first mesh, serialized by a lock: the library
/// keeps global state.
std::unique_ptr<VolumeMesher> netgen_mesher();

}  // namespace lamella
