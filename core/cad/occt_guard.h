#pragma once

#include <functional>
#include <string>

#include "core/base/result.h"

namespace lamella {

/// Held while OCCT works or the process is copied: its settings are global, one caller at a time.
class OcctLock {
 public:
  OcctLock();
  ~OcctLock();
  OcctLock(const OcctLock&) = delete;
  OcctLock& operator=(const OcctLock&) = delete;
};

/// Runs OCCT code under an OcctLock: exceptions of OCCT and of the standard library, and crashes
/// inside OCCT, become an Error that begins with `subject`.
Result<void> guarded(const std::string& subject, const std::function<Result<void>()>& action);

/// The same without the lock: in a child process, which has no other caller.
Result<void> guarded_alone(const std::string& subject, const std::function<Result<void>()>& action);

}  // namespace lamella
