#pragma once

#include <chrono>
#include <functional>
#include <stop_token>
#include <string>
#include <thread>

#include "core/base/progress.h"
#include "core/base/result.h"

namespace lamella::cli {

/// Turns Ctrl-C and SIGTERM into a stop request; a second one ends the program at once. Must be
/// made before any other thread, which would get the signals otherwise.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  std::stop_token token() const { return stop_.get_token(); }

 private:
  std::stop_source stop_;
  std::jthread watcher_;
};

/// Where the program speaks: a table or JSON lines on standard output, the progress bar and errors
/// on standard error.
class Console {
 public:
  Console(bool json, std::stop_token stop);
  ~Console();

  bool json() const { return json_; }
  /// Draws a bar on standard error when that is a terminal; carries the stop request.
  Progress progress();
  /// A line for people; nothing with --json.
  void say(const std::string& line);
  /// A line of JSON; nothing without --json.
  void emit(const std::string& object);
  /// Tells the error and returns its exit status.
  int fail(const Error& error);

 private:
  void draw(double fraction, std::string_view phase);
  void erase();
  bool json_, terminal_, drawn_ = false;
  std::stop_token stop_;
  std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace lamella::cli
