#pragma once

#include <memory>

#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/multidomain/chord_metric.h"
#include "core/natural/natural_metric.h"
#include "core/study/study.h"

namespace lamella {

/// Sizes are asked finer than wanted by this: the best elements on average are a little larger than
/// unit. LayerCorrection does the rest.
inline constexpr double kAskedFiner = 1.02;

/// Layers that the average place is to have, of n, so that the poor ones have nearly n.
inline constexpr double kWantedLayers = 1.08;

/// What is around the bodies in one mesh of all, where the domain is no body itself.
inline constexpr const char* kBackground = "background";

/// Whether the study makes sense for these parts. Errors: usage.
Result<void> check_request(const Study& study, const std::vector<Part>& parts);

/// The natural metric that the study asks for the part, defaults filled in.
NaturalParams natural_params(const Study& study, const Part& part);

/// mm, how far the part's mesh may be from its shape.
double chord_tolerance_of(const Study& study, const Part& part);

/// What curves and details of the part's surface ask for beside the natural metric, no finer than
/// h_min: elements would else be poor where the mesh has to follow them.
std::unique_ptr<const ChordField> chords_of(const Study& study, const Part& part,
                                            const Progress& progress = {});

}  // namespace lamella
