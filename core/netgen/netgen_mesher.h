#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/optimize/generate.h"

namespace lamella {

struct NetgenParams {
  double time_limit = 180;  ///< seconds after which it is stopped and gives up with Code::failed
};

/// Calls the library, which may crash, in the calling process: only for a child of it. Returns the
/// inner nodes and the tetrahedra as bytes for the parent; throws what the library complains of.
std::string run_netgen(const ReferenceSurface<3>& surface);

using NetgenWork = std::function<std::string(const ReferenceSurface<3>& surface)>;

/// Netgen's library (LGPL) as the fallback for the first mesh. It runs in a child process, for it
/// crashes on some surfaces and keeps global state. `work` is what the child does: tests give their
/// own.
std::unique_ptr<VolumeMesher> netgen_mesher(const NetgenParams& params = {},
                                            NetgenWork work = run_netgen);

}  // namespace lamella
