#pragma once

#include <string>

namespace lamella {

/// Version of the program, as "0.1.0".
std::string version();

}  // namespace lamella
