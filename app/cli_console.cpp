#include "app/cli_console.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace lamella::cli {

namespace {

sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGUSR2);  // our own: the watcher shall end
  return set;
}

}  // namespace

Interrupt::Interrupt() {
  // A reader that goes away must not kill us between a temporary file and its renaming.
  ::signal(SIGPIPE, SIG_IGN);
  const sigset_t set = stop_signals();
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
  watcher_ = std::jthread([this, set] {
    int signal = 0;
    while (::sigwait(&set, &signal) == 0 && signal != SIGUSR2)
      if (!stop_.request_stop()) ::_exit(130);
  });
}

Interrupt::~Interrupt() { ::pthread_kill(watcher_.native_handle(), SIGUSR2); }

Console::Console(bool json, std::stop_token stop)
    : json_(json),
      terminal_(::isatty(STDERR_FILENO) != 0),
      stop_(std::move(stop)),
      start_(std::chrono::steady_clock::now()) {}

Console::~Console() { erase(); }

Progress Console::progress() {
  if (!terminal_) return Progress({}, stop_);
  return Progress([this](double fraction, std::string_view phase) { draw(fraction, phase); },
                  stop_);
}

void Console::draw(double fraction, std::string_view phase) {
  using namespace std::chrono;
  const auto now = steady_clock::now();
  if (drawn_ && now - last_ < milliseconds(100) && fraction < 1) return;
  last_ = now;
  drawn_ = true;
  constexpr int kWidth = 30;
  const int full = static_cast<int>(std::lround(fraction * kWidth));
  const double spent = duration<double>(now - start_).count();
  char left[32] = "";
  if (fraction > 0.05 && spent > 2) {
    const auto seconds = static_cast<int>(spent * (1 - fraction) / fraction);
    std::snprintf(left, sizeof left, ", %d:%02d left", seconds / 60, seconds % 60);
  }
  std::string bar(static_cast<std::size_t>(full), '#');
  bar.resize(kWidth, '-');
  std::fprintf(stderr, "\r[%s] %3.0f %%  %.*s%s\033[K", bar.c_str(), 100 * fraction,
               static_cast<int>(phase.size()), phase.data(),
               stop_.stop_requested() ? ", stopping" : left);
  std::fflush(stderr);
}

void Console::erase() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

void Console::say(const std::string& line) {
  if (json_) return;
  erase();
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

void Console::emit(const std::string& object) {
  if (!json_) return;
  erase();
  std::printf("%s\n", object.c_str());
  std::fflush(stdout);
}

int Console::fail(const Error& error) {
  erase();
  const int status = exit_code(error.code);
  std::fprintf(stderr, "lamella-cli: %s\n", error.message.c_str());
  if (!error.hint.empty()) std::fprintf(stderr, "  %s\n", error.hint.c_str());
  if (json_) {
    const nlohmann::ordered_json json = {
        {"phase", "error"}, {"status", status}, {"message", error.message}, {"hint", error.hint}};
    emit(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  }
  return status;
}

}  // namespace lamella::cli
