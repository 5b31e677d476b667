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
#include <optional>
#include <utility>
#include <vector>

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

void answer(int pipe, char kind, const std::string& bytes = {}) {
  write_all(pipe, &kind, 1);
  write_all(pipe, bytes.data(), bytes.size());
}

using StreamWork = std::function<void(const ByteSink&, const Progress&)>;

struct ProgressHead {
  char kind = kProgress;
  std::uint8_t phase_length = 0;
  float fraction = 0;
};
static_assert(sizeof(ProgressHead) + 255 < PIPE_BUF, "a message of progress goes out in one piece");

/// Sends what the child's work reports, but not every small step, and nothing once it answers.
Progress progress_through(int pipe, const bool& answers) {
  auto told = std::make_shared<std::pair<double, std::string>>(-1, "");
  return Progress([pipe, told, &answers](double fraction, std::string_view phase) {
    if (answers) return;
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

[[noreturn]] void be_the_child(int pipe, pid_t parent, const StreamWork& work,
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
  bool answers = false;
  const auto begin = [&] {
    if (!answers) answer(pipe, kValue);
    answers = true;
  };
  // Within an answer nothing else can be told but that it ends early.
  const auto instead = [&](char kind, const std::string& bytes) {
    if (answers) ::_exit(1);
    answer(pipe, kind, bytes);
  };
  try {
    work(
        [&](const char* bytes, std::size_t count) {
          begin();
          write_all(pipe, bytes, count);
        },
        progress_through(pipe, answers));
    begin();
  } catch (const std::bad_alloc&) {
    instead(kNoMemory, "");
  } catch (const std::exception& e) {
    instead(kThrown, e.what());
  } catch (...) {
    instead(kThrown, "it threw an unknown exception.");
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

  /// So many bytes, or fewer at the end; `go_on` is asked while there are none, and false ends it.
  std::size_t read(char* to, std::size_t count, const std::function<bool()>& go_on) {
    std::size_t got = 0;
    while (got < count) {
      // Asked before reading: what an ended child wrote is all there. The end of the pipe alone
      // would not do, a child forked meanwhile by another thread holds it open.
      const bool all_written = ended_;
      const ssize_t n = ::read(pipe_, to + got, count - got);
      if (n > 0) got += static_cast<std::size_t>(n);
      if (n > 0 || (n < 0 && errno == EINTR)) continue;
      if (n == 0 || all_written || !go_on()) break;
      pollfd ready{pipe_, POLLIN, 0};
      ::poll(&ready, 1, 20);
      if (!ended_) reap(WNOHANG);
    }
    return got;
  }
  /// Waits for the end, which is near when the pipe has one.
  void wait() {
    if (!ended_) reap(0);
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

/// Why a child that ended with `status` has not answered; nothing when it has.
std::optional<Error> fault_of(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGKILL) return no_memory();  // we did not, so the system did
    const char* text = ::sigdescr_np(signal);
    return Error{Code::failed,
                 std::string("it crashed (") + (text ? text : "unknown signal") + ").", ""};
  }
  if (WEXITSTATUS(status) != 0)
    return Error{Code::failed,
                 "it ended early (exit code " + std::to_string(WEXITSTATUS(status)) + ").", ""};
  return {};
}

std::string all_of(const ByteSource& source) {
  std::string bytes;
  std::vector<char> block(1 << 16);
  for (std::size_t n = block.size(); n == block.size();) {
    n = source(block.data(), block.size());
    bytes.append(block.data(), n);
  }
  return bytes;
}

}  // namespace

Result<void> stream_from_child(const StreamWork& work, const ChildLimits& limits,
                               const Progress& progress,
                               const std::function<void(const ByteSource&)>& take,
                               const std::function<void()>& copied) {
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
  std::optional<Error> stopped;
  const ByteSource source = [&](char* to, std::size_t count) {
    return stopped ? std::size_t{0} : child.read(to, count, [&] {
      if (progress.cancelled()) {
        stopped = cancelled_error();
      } else if (std::chrono::duration<double>(Clock::now() - start).count() > limits.seconds) {
        char text[64];
        std::snprintf(text, sizeof text, "it found no end within %g s.", limits.seconds);
        stopped = Error{Code::failed, text, ""};
      }
      return !stopped;
    });
  };
  ProgressHead head;
  std::string said;
  while (source(&head.kind, 1) == 1 && head.kind == kProgress) {
    if (source(reinterpret_cast<char*>(&head) + 1, sizeof head - 1) != sizeof head - 1) break;
    said.resize(head.phase_length);
    if (source(said.data(), said.size()) != said.size()) break;
    progress.portion(0, 1, said).report(head.fraction);
  }
  if (head.kind == kValue) take(source);
  const std::string rest = all_of(source);
  if (stopped) return *stopped;
  child.wait();
  if (const std::optional<Error> fault = fault_of(child.status())) return *fault;
  if (head.kind == kNoMemory) return no_memory();
  if (head.kind == kThrown) return Error{Code::failed, rest, ""};
  if (head.kind != kValue) return Error{Code::failed, "it gave no answer.", ""};
  return {};
}

Result<std::string> run_in_child(const ChildWork& work, const ChildLimits& limits,
                                 const Progress& progress, const std::function<void()>& copied) {
  std::string bytes;
  const Result<void> done = stream_from_child(
      [&](const ByteSink& sink, const Progress& through) {
        const std::string answer = work(through);
        sink(answer.data(), answer.size());
      },
      limits, progress, [&](const ByteSource& source) { bytes = all_of(source); }, copied);
  if (!done) return done.error();
  return bytes;
}

}  // namespace lamella
