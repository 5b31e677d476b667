#pragma once

#include <optional>
#include <string_view>

namespace lamella {

/// Who finds the wall thickness that the natural metric divides.
enum class Detector {
  geometric,    ///< medial balls and rays: depends on the surface only
  neighborhood  ///< hulls grown in the mesh (sections 4.1 to 4.3): needs no surface
};

/// "geometric", "neighborhood", as in study files and on the command line, and back.
constexpr std::string_view detector_name(Detector detector) {
  return detector == Detector::geometric ? "geometric" : "neighborhood";
}
constexpr std::optional<Detector> detector_from_name(std::string_view name) {
  for (const auto detector : {Detector::geometric, Detector::neighborhood})
    if (name == detector_name(detector)) return detector;
  return std::nullopt;
}

}  // namespace lamella
