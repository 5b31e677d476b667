#pragma once

#include <vector>

#include "core/base/progress.h"
#include "core/geometry/surface.h"
#include "core/study/study.h"

namespace lamella::ui {

/// What has no file as surfaces, for the eye. What has none is left empty.
struct ZoneShapes {
  std::vector<ReferenceSurface<3>> zones;  ///< one a zone of the study, cut by the domain
  std::vector<double> volumes;             ///< theirs, mm^3
  ReferenceSurface<3> hull;                ///< of the domain, unless bodies are it
};
ZoneShapes zone_shapes(const Study& study, const std::vector<Part>& parts,
                       const Progress& progress);

}  // namespace lamella::ui
