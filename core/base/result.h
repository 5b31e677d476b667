#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace lamella {

/// What kind of failure an Error is; `exit_code` maps it to the exit status of the batch program.
enum class Code {
  usage,          ///< the request itself makes no sense (unknown option, n < 1)
  bad_input,      ///< a file or a geometry cannot be used
  io,             ///< reading or writing failed for a reason outside the data
  not_converged,  ///< a valid result exists but the goal was not reached
  poor_quality,   ///< a valid result exists below the quality asked
  memory,         ///< the memory limit asked would be exceeded
  cancelled,      ///< the user asked to stop
  failed          ///< an algorithm could not do its work
};

/// A failure as a value: one sentence for the user and a hint what to try.
struct Error {
  Code code = Code::failed;
  std::string message;  ///< what broke, naming file, place and finding
  std::string hint;     ///< likely cause and what to try; may be empty
};

/// Exit status of the batch program: 1 error, 2 usage, 3 bad input, 4 not converged, 5 quality,
/// 6 memory, 130 cancelled.
constexpr int exit_code(Code code) {
  switch (code) {
    case Code::usage:
      return 2;
    case Code::bad_input:
      return 3;
    case Code::not_converged:
      return 4;
    case Code::poor_quality:
      return 5;
    case Code::memory:
      return 6;
    case Code::cancelled:
      return 130;
    case Code::io:
    case Code::failed:
      break;
  }
  return 1;
}

/// Either a value or an Error. `value()` on an error is a programming mistake (assert).
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }
  T& value() & {
    assert(ok());
    return *std::get_if<0>(&state_);
  }
  const T& value() const& {
    assert(ok());
    return *std::get_if<0>(&state_);
  }
  T&& value() && {
    assert(ok());
    return std::move(*std::get_if<0>(&state_));
  }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  const Error& error() const {
    assert(!ok());
    return *std::get_if<1>(&state_);
  }

 private:
  std::variant<T, Error> state_;
};

/// Result of an action that has no value of its own.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)), ok_(false) {}
  bool ok() const { return ok_; }
  explicit operator bool() const { return ok_; }
  const Error& error() const {
    assert(!ok_);
    return error_;
  }

 private:
  Error error_;
  bool ok_ = true;
};

}  // namespace lamella
