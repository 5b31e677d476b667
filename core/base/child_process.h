#pragma once

#include <functional>
#include <string>

#include "core/base/progress.h"
#include "core/base/result.h"

namespace lamella {

/// Runs `work` in a forked copy of this process and returns the bytes it returns, so that a crash
/// or an endless loop in someone else's library ends there and not here. The copy has the memory of
/// the caller but none of its other threads: `work` must wait for none, neither TBB's nor a lock
/// that another thread may hold. What it prints is lost; nothing it changes comes back.
///
/// Errors: failed (it crashed, threw, left early, or took more than `time_limit` seconds; the
/// message is a clause beginning with "it", or what the exception says), memory (the system killed
/// it, or it found none), cancelled. The child is gone when this returns.
Result<std::string> run_in_child(const std::function<std::string()>& work, double time_limit,
                                 const Progress& progress);

}  // namespace lamella
