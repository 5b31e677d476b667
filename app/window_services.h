#pragma once

#include <filesystem>

#include "ui/services.h"

namespace lamella {

/// The real readers, meshers, loop and writers, for the window. Sample parts go to
/// `sample_folder`, which is made when needed.
ui::Services window_services(const std::filesystem::path& sample_folder);

}  // namespace lamella
