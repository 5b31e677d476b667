#include "core/natural/thickness_detector.h"

#include "core/natural/natural_metric.h"
#include "core/natural/neighborhood.h"

namespace lamella {

Result<void> check_params(const NaturalParams& p) {
  if (p.layers < 1)
    return Error{Code::usage,
                 "The number of layers must be at least 1, not " + std::to_string(p.layers) + ".",
                 "Ask for 1 to 16 layers."};
  if (p.layers2.value_or(1) < 1 || p.layers3.value_or(1) < 1)
    return Error{Code::usage, "The numbers of layers n2 and n3 must be at least 1.",
                 "Leave them out for long directions that are not to be divided."};
  if (!(p.alpha >= 0) || !(p.alpha2 >= 0))
    return Error{Code::usage, "alpha must not be negative.",
                 "0 divides the thinnest direction only; 1 is the usual value."};
  if (!(p.h_min >= 0) || !(p.h_max >= 0) || (p.h_max > 0 && p.h_min > p.h_max))
    return Error{Code::usage, "The smallest size h_min is above the largest, h_max.",
                 "Lengths are in mm; h_max = 0 means the diagonal of the part."};
  if (p.max_anisotropy != 0 && !(p.max_anisotropy >= 1))
    return Error{Code::usage, "The largest anisotropy must be 1 or more.",
                 "It is the longest over the shortest size of an element."};
  return {};
}

std::unique_ptr<ThicknessDetector> make_detector(Detector kind,
                                                 const ReferenceSurface<3>& surface) {
  if (kind == Detector::neighborhood) return std::make_unique<NeighborhoodDetector>();
  return std::make_unique<NaturalDetector>(surface);
}

}  // namespace lamella
