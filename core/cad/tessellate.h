#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/cad/cad_reader.h"
#include "core/cad/load_parts.h"

class TopoDS_Shape;

namespace lamella {

/// Triangulates a solid: watertight through the edges that its faces share, never by distance; one
/// SurfaceFace a CAD face, feature edges where faces meet at more than 0.35 radians, corners where
/// features end, branch or kink. Retries finer when the triangles do not close or cross each other.
/// Must run inside `guarded`.
/// Errors: bad_input (open, not manifold, self-intersecting, no volume), `rough` then getting the
/// triangles as they came; cancelled.
Result<Part> tessellate(const TopoDS_Shape& solid, SolidInfo info, const LoadParams& params,
                        Triangles& rough, const Progress& progress);

}  // namespace lamella
