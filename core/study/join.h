#pragma once

#include <memory>

#include "core/study/run.h"

namespace lamella {

/// All bodies in one mesh with their fields, in the order given. Nodes are not shared between
/// bodies. The boundary group of a body is "NAME walls", or "walls" when there is one body only.
std::shared_ptr<const MeshState> join(const std::vector<const MeshState*>& bodies,
                                      const std::vector<std::string>& names);

/// The record of all bodies together, of one record each: sums, means weighted by elements, the
/// worst quality; of the layers the mean weighted by places, and the smallest 5 % quantile and
/// median, and the largest 95 % quantile.
IterationRecord join(const std::vector<const IterationRecord*>& records);

}  // namespace lamella
