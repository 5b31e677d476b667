#include "core/base/version.h"

namespace lamella {

std::string version() { return LAMELLA_VERSION; }

}  // namespace lamella
