#pragma once

#include <memory>

#include "core/study/run.h"

namespace lamella {

/// All bodies in one mesh with their fields, in the order given. Nodes are not shared between
/// bodies. The boundary of a body belongs to the groups that `groups` (one a body, or none at all)
/// has for its faces, and else to "NAME walls", or "walls" when there is one body only. Groups of
/// one name on several bodies become one.
std::shared_ptr<const MeshState> join(const std::vector<const MeshState*>& bodies,
                                      const std::vector<std::string>& names,
                                      const std::vector<const FaceGroups*>& groups = {});

/// Number of the group in the list, to which it is added if need be.
std::int32_t group_called(const std::string& name, std::vector<std::string>& groups);

/// The mean weighted by places, the smallest 5 % quantile and median, the largest 95 % quantile.
LayerStats join(const std::vector<const LayerStats*>& layers);

/// The record of all bodies together, of one record each: sums, means weighted by elements, the
/// worst quality; of the layers the mean weighted by places, and the smallest 5 % quantile and
/// median, and the largest 95 % quantile.
IterationRecord join(const std::vector<const IterationRecord*>& records);

}  // namespace lamella
