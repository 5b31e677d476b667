#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/base/bytes.h"
#include "core/base/progress.h"
#include "core/base/result.h"

namespace lamella {

struct ChildLimits {
  double seconds = 0;       ///< after which the child is ended
  std::uint64_t bytes = 0;  ///< it may allocate beyond what the caller has; 0: no limit
};

using ChildWork = std::function<std::string(const Progress&)>;

/// Runs `work` in a forked copy of this process and returns the bytes it returns, so that a crash
/// or an endless loop in someone else's library ends there and not here. The copy has the memory of
/// the caller but none of its other threads: `parallel_each` works in place there, and `work` must
/// wait for no lock that another thread may hold. What it prints is lost; nothing it changes comes
/// back but the progress it reports.
///
/// Errors: failed (it crashed, threw, left early, or took too long; the message is a clause
/// beginning with "it", or what the exception says), memory (the system killed it, or it found
/// none), cancelled. The child is gone when this returns.
/// `copied` is called as soon as the child exists, or cannot.
Result<std::string> run_in_child(const ChildWork& work, const ChildLimits& limits,
                                 const Progress& progress,
                                 const std::function<void()>& copied = {});

/// The same for answers that are large: `work` hands bytes to the sink, and `take` gets them from
/// the source while the child still writes; neither keeps a copy. Progress is told until the first
/// of them. What `take` made is worth something only when this returns no error.
Result<void> stream_from_child(const std::function<void(const ByteSink&, const Progress&)>& work,
                               const ChildLimits& limits, const Progress& progress,
                               const std::function<void(const ByteSource&)>& take,
                               const std::function<void()>& copied = {});

}  // namespace lamella
