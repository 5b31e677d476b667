#pragma once

#include <string>

#include "core/base/result.h"
#include "core/io/mesh_fields.h"
#include "core/metric/metric.h"

namespace lamella::cli {

/// The metric at the nodes that a mesh file asks for: by the field called `name`, or without a name
/// its metric, or its only tensor. A field of tensors is a metric, one of numbers is a size, mm;
/// what elements have is averaged at the nodes as M^(-1/2), weighted by volume. Errors: bad_input
/// (no such field; a size that is not positive, a matrix that is not positive definite), naming the
/// fields that there are.
Result<MetricField<3>> metric_in_file(const MeshContent& content, const std::string& name);

}  // namespace lamella::cli
