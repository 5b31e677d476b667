#pragma once

#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/natural/natural_metric.h"
#include "core/study/study.h"

namespace lamella {

/// Sizes are asked finer than wanted by this: the best elements on average are a little larger than
/// unit. LayerCorrection does the rest.
inline constexpr double kAskedFiner = 1.02;

/// Whether the study makes sense for these parts. Errors: usage.
Result<void> check_request(const Study& study, const std::vector<Part>& parts);

/// The natural metric that the study asks for the part, defaults filled in.
NaturalParams natural_params(const Study& study, const Part& part);

}  // namespace lamella
