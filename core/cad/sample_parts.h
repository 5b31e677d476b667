#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace lamella {

/// Names of the parts made by code: plate, ribbed_tray, curved_shell, t_junction, twisted_tube,
/// l_profile, cross_junction, wedge, spiral_mold.
std::vector<std::string> sample_names();

/// Writes one of them in mm, as IGES or BREP where the ending says so, otherwise as STEP AP214. The
/// twisted tube has two solids, the tube and the block around it. Errors: usage (unknown name), io,
/// failed.
Result<void> write_sample(std::string_view name, const std::filesystem::path& file);

}  // namespace lamella
