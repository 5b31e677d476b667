#pragma once

#include "core/optimize/adapt.h"

namespace lamella {

/// The nodal metric of a mesh as a function of position that `adapt` may ask in place of carrying
/// the metric from node to node, so that it does not blur from pass to pass.
///
/// With X the quantity of `mean` (M, M^(1/2), M^(-1/2), log M or h, section 3.2.2) and w_k the
/// barycentric weights of x in the element it lies in, X(x) = sum w_k X(S_k): continuous, equal to
/// the nodal values at the nodes, and exact where X is linear. Outside the mesh the value is that
/// of the nearest point of the mesh.
///
/// The function owns copies of what it needs and shares them among its own copies; it is
/// thread-safe, and its values do not depend on earlier queries. Time and memory grow linearly with
/// the elements, a query with their logarithm.
/// Errors: bad_input (no elements, a metric of another length, or one that is not positive
/// definite), cancelled.
template <int D>
Result<MetricFunction<D>> background_metric(const SimplexMesh<D>& mesh,
                                            const MetricField<D>& metric,
                                            MetricMean mean = MetricMean::size,
                                            const Progress& progress = {});

}  // namespace lamella
