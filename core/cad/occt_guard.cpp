#include "core/cad/occt_guard.h"

#include <signal.h>

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <OSD.hxx>
#include <Standard_ErrorHandler.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <exception>
#include <mutex>
#include <new>

namespace lamella {
namespace {

/// OCCT's handlers turn a crash into an exception; every handler of the program comes back, and
/// those that ask the program to stop are never replaced.
class SignalScope {
 public:
  SignalScope() {
    for (std::size_t k = 0; k < kCount; ++k) sigaction(kSignals[k], nullptr, &before_[k]);
    OSD::SetSignal(Standard_False);
    for (std::size_t k = kCrashes; k < kCount; ++k) sigaction(kSignals[k], &before_[k], nullptr);
  }
  ~SignalScope() {
    for (std::size_t k = 0; k < kCount; ++k) sigaction(kSignals[k], &before_[k], nullptr);
  }
  SignalScope(const SignalScope&) = delete;
  SignalScope& operator=(const SignalScope&) = delete;

 private:
  static constexpr int kSignals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL,
                                     SIGSYS,  SIGINT, SIGHUP, SIGQUIT};
  static constexpr std::size_t kCount = std::size(kSignals);
  static constexpr std::size_t kCrashes = 5;
  struct sigaction before_[kCount];
};

std::mutex& occt_mutex() {
  static std::mutex mutex;
  return mutex;
}

Error crashed(const std::string& subject, const std::string& reason) {
  return {Code::bad_input, subject + ": the CAD library gave up (" + reason + ")",
          "The model is damaged; export it again, or as another format."};
}

Error no_memory(const std::string& subject) {
  return {Code::memory, subject + ": the CAD library ran out of memory",
          "Allow it more memory, or export the parts one by one."};
}

}  // namespace

OcctLock::OcctLock() { occt_mutex().lock(); }
OcctLock::~OcctLock() { occt_mutex().unlock(); }

Result<void> guarded(const std::string& subject, const std::function<Result<void>()>& action) {
  const OcctLock lock;
  return guarded_alone(subject, action);
}

Result<void> guarded_alone(const std::string& subject,
                           const std::function<Result<void>()>& action) {
  // OCCT would write its remarks to standard output, which belongs to the caller.
  Message::DefaultMessenger()->ChangePrinters().Clear();
  const SignalScope signals;
  try {
    OCC_CATCH_SIGNALS
    return action();
  } catch (const Standard_OutOfMemory&) {
    return no_memory(subject);
  } catch (const std::bad_alloc&) {
    return no_memory(subject);
  } catch (const Standard_Failure& failure) {
    const char* text = failure.GetMessageString();
    return crashed(subject,
                   text != nullptr && *text != '\0' ? text : failure.DynamicType()->Name());
  } catch (const std::exception& failure) {
    return crashed(subject, failure.what());
  }
}

}  // namespace lamella
