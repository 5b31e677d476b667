#pragma once

#include "core/base/progress.h"
#include "core/mesh/simplex_mesh.h"
#include "core/metric/metric.h"

namespace lamella {

struct EaseParams {
  double quality = 0.3;  ///< c(T) below which an element is poor
  double off = 0;        ///< mm that a node may leave the planes of curved borders by
  double across = 0;     ///< mm that one of interfaces may be moved off its planes
};

/// Moves nodes of poor elements, one after another, to where the worst element around them is
/// best: inner nodes by up to their shortest edge, those of the boundary and of borders between
/// bodies along the plane or the straight edge that they lie on, and off them by what is allowed;
/// borders of groups stay. What is reconnected where a metric function jumps from place to place is
/// left poor by it: here the metric of a moved node is averaged (M^-1/2) in the element that holds
/// it, and a move has to help in its old metric too. Returns the number of moves; the mesh is valid
/// whenever it is cancelled.
std::size_t ease_poor(SimplexMesh<3>& mesh, MetricField<3>& metric, const EaseParams& params = {},
                      const Progress& progress = {});

}  // namespace lamella
