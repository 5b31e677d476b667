#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace lamella {

/// Progress and cancellation, passed by value down the call tree.
///
/// A `portion` owns a part of its parent's interval, so nested work reports 0..1 and the root
/// still rises monotonically. `cancelled()` may be polled from any thread, and cancel may be asked
/// from any thread through the stop token. A default-constructed Progress is silent and is never
/// cancelled.
class Progress {
 public:
  /// Called with the root fraction in [0, 1], never falling, and the innermost phase name.
  /// May be called from any worker thread, one call at a time.
  using Sink = std::function<void(double fraction, std::string_view phase)>;

  Progress() = default;
  explicit Progress(Sink sink, std::stop_token stop = {});

  /// The part [begin, end] of this interval, with 0 <= begin <= end <= 1.
  Progress portion(double begin, double end, std::string phase = {}) const;
  /// Reports a fraction of this interval, clamped to [0, 1]; a falling value is ignored.
  void report(double fraction) const;
  /// True once cancel has been asked; cheap enough for inner loops.
  bool cancelled() const { return stop_.stop_requested(); }
  std::stop_token stop_token() const { return stop_; }

 private:
  struct Root;
  std::shared_ptr<Root> root_;
  std::stop_token stop_;
  double begin_ = 0;
  double end_ = 1;
  std::string phase_;
};

/// The Error every cancelled action returns.
Error cancelled_error();

}  // namespace lamella
