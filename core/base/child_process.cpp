#include "core/base/child_process.h"

#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <utility>

#include "core/base/parallel.h"

namespace lamella {
namespace {

// A message is one byte that tells what follows, and that. Those of progress come first, with a
// length; what follows an answer reaches to the end.
constexpr char kProgress = 'p';
constexpr char kValue = 'v';
constexpr char kThrown = 't';
constexpr char kNoMemory = 'm';

void write_all(int pipe, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t n = ::write(pipe, bytes, count);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) ::_exit(1);
    bytes += n;
    count -= static_cast<std::size_t>(n);
  }
}

void answer(int pipe, char kind, const std::string& bytes) {
  write_all(pipe, &kind, 1);
  write_all(pipe, bytes.data(), bytes.size());
}

struct ProgressHead {
  char kind = kProgress;
  std::uint8_t phase_length = 0;
  float fraction = 0;
};
static_assert(sizeof(ProgressHead) + 255 < PIPE_BUF, "a message of progress goes out in one piece");

/// Sends what the child's work reports, but not every small step.
Progress progress_through(int pipe) {
  auto told = std::make_shared<std::pair<double, std::string>>(-1, "");
  return Progress([pipe, told](double fraction, std::string_view phase) {
    phase = phase.substr(0, 255);
    if (fraction < told->first + 0.002 && phase == told->second) return;
    *told = {fraction, std::string(phase)};
    ProgressHead head;
    head.phase_length = static_cast<std::uint8_t>(phase.size());
    head.fraction = static_cast<float>(fraction);
    std::string message(reinterpret_cast<const char*>(&head), sizeof head);
    message += phase;
    write_all(pipe, message.data(), message.size());
  });
}

/// Hands the messages of progress at the beginning of `bytes` on, from `at`; returns where they
/// end.
std::size_t tell_progress(const std::string& bytes, std::size_t at, const Progress& progress) {
  ProgressHead head;
  while (bytes.size() - at >= sizeof head && bytes[at] == kProgress) {
    std::memcpy(&head, bytes.data() + at, sizeof head);
    const std::size_t end = at + sizeof head + head.phase_length;
    if (bytes.size() < end) break;
    progress.portion(0, 1, bytes.substr(at + sizeof head, head.phase_length)).report(head.fraction);
    at = end;
  }
  return at;
}

/// The child's limit counts the memory that it has of the caller.
void limit_memory(std::uint64_t bytes) {
  unsigned long long data = 0;  // pages
  std::FILE* statm = std::fopen("/proc/self/statm", "r");
  if (statm == nullptr) return;
  if (std::fscanf(statm, "%*u %*u %*u %*u %*u %llu", &data) != 1) data = 0;
  std::fclose(statm);
  const rlim_t most = data * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + bytes;
  rlimit now{};
  ::getrlimit(RLIMIT_DATA, &now);
  now.rlim_cur = std::min(most, now.rlim_max);
  ::setrlimit(RLIMIT_DATA, &now);
}

[[noreturn]] void be_the_child(int pipe, pid_t parent, const ChildWork& work,
                               std::uint64_t memory) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  // A crash is reported by the parent: no handler of its own, no core file.
  for (const int s : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS}) ::signal(s, SIG_DFL);
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  if (const int nothing = ::open("/dev/null", O_RDWR); nothing >= 0)
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nothing, stream);
  if (memory > 0) limit_memory(memory);
  without_threads = true;
  try {
    answer(pipe, kValue, work(progress_through(pipe)));
  } catch (const std::bad_alloc&) {
    answer(pipe, kNoMemory, "");
  } catch (const std::exception& e) {
    answer(pipe, kThrown, e.what());
  } catch (...) {
    answer(pipe, kThrown, "it threw an unknown exception.");
  }
  ::_exit(0);
}

class Child {
 public:
  Child(pid_t pid, int pipe) : pid_(pid), pipe_(pipe) {}
  ~Child() {
    ::close(pipe_);
    if (ended_) return;
    ::kill(pid_, SIGKILL);
    reap(0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Waits a moment for bytes; true once the child has ended and all of them are in `bytes`.
  bool drain(std::string& bytes) {
    pollfd ready{pipe_, POLLIN, 0};
    ::poll(&ready, 1, 20);
    // Asked before reading: what an ended child wrote is all there. The end of the pipe alone
    // would not do, a child forked meanwhile by another thread holds it open.
    if (!ended_) reap(WNOHANG);
    char block[65536];
    for (;;) {
      const ssize_t n = ::read(pipe_, block, sizeof block);
      if (n > 0) bytes.append(block, static_cast<std::size_t>(n));
      if (n < 0 && errno == EINTR) continue;
      if (n == 0 && !ended_) reap(0);
      if (n <= 0) return ended_;
    }
  }
  int status() const { return status_; }

 private:
  void reap(int how) {
    pid_t got = 0;
    do got = ::waitpid(pid_, &status_, how);
    while (got < 0 && errno == EINTR);
    ended_ = got != 0;
  }

  pid_t pid_;
  int pipe_;
  int status_ = 0;
  bool ended_ = false;
};

Error no_memory() {
  return {Code::memory, "it ran out of memory.", "Use a coarser surface, or more memory."};
}

/// What a child that ended with `status` answered, `at` being where its answer begins.
Result<std::string> judge(int status, std::string bytes, std::size_t at) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGKILL) return no_memory();  // we did not, so the system did
    const char* text = ::sigdescr_np(signal);
    return Error{Code::failed,
                 std::string("it crashed (") + (text ? text : "unknown signal") + ").", ""};
  }
  if (WEXITSTATUS(status) != 0 || bytes.size() == at)
    return Error{Code::failed,
                 "it ended early (exit code " + std::to_string(WEXITSTATUS(status)) + ").", ""};
  const char kind = bytes[at];
  bytes.erase(0, at + 1);
  if (kind == kNoMemory) return no_memory();
  if (kind == kThrown) return Error{Code::failed, std::move(bytes), ""};
  if (kind != kValue) return Error{Code::failed, "it gave no answer.", ""};
  return bytes;
}

}  // namespace

Result<std::string> run_in_child(const ChildWork& work, const ChildLimits& limits,
                                 const Progress& progress, const std::function<void()>& copied) {
  using Clock = std::chrono::steady_clock;
  if (progress.cancelled()) return cancelled_error();
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    return Error{Code::failed, std::string("no pipe could be opened: ") + std::strerror(errno), ""};
  const pid_t parent = ::getpid();
  const auto start = Clock::now();
  const pid_t pid = ::fork();
  if (pid == 0) {
    ::close(ends[0]);
    be_the_child(ends[1], parent, work, limits.bytes);
  }
  const int why = errno;
  ::close(ends[1]);
  if (copied) copied();
  if (pid < 0) {
    ::close(ends[0]);
    return Error{Code::failed, std::string("no process could be started: ") + std::strerror(why),
                 ""};
  }
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  Child child(pid, ends[0]);
  std::string bytes;
  std::size_t at = 0;
  while (!child.drain(bytes)) {
    at = tell_progress(bytes, at, progress);
    if (progress.cancelled()) return cancelled_error();
    if (std::chrono::duration<double>(Clock::now() - start).count() > limits.seconds) {
      char text[64];
      std::snprintf(text, sizeof text, "it found no end within %g s.", limits.seconds);
      return Error{Code::failed, text, ""};
    }
  }
  at = tell_progress(bytes, at, progress);
  return judge(child.status(), std::move(bytes), at);
}

}  // namespace lamella
