#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/optimize/generate.h"

namespace lamella {

struct FirstMesh {
  SimplexMesh<3> mesh;
  std::string made_by;             ///< name of the mesher
  std::vector<std::string> notes;  ///< which meshers gave up before, and why
};

/// The first valid mesh that one of the meshers, asked in order, makes of the part.
/// Errors: failed (none could), with the last mesher's reason; cancelled.
Result<FirstMesh> first_mesh(const Part& part,
                             const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
                             const Progress& progress = {});

}  // namespace lamella
