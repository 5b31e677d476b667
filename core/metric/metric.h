#pragma once

#include <vector>

#include "core/geometry/simplex.h"

namespace lamella {

/// Symmetric positive definite matrix (definition 1.1); unit mm^-2: a vector e has the length
/// sqrt(e^T M e) in units of the asked mesh size.
template <int D>
using Metric = Mat<D>;

/// One metric a node, indexed by NodeId like SimplexMesh::points; entry 0 (the virtual node) is
/// the identity and is never read.
template <int D>
using MetricField = std::vector<Metric<D>>;

}  // namespace lamella
