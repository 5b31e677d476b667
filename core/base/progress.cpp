#include "core/base/progress.h"

#include <algorithm>
#include <mutex>

namespace lamella {

struct Progress::Root {
  Sink sink;
  std::mutex mutex;
  double last = 0;
  std::string last_phase;
};

Progress::Progress(Sink sink, std::stop_token stop)
    : root_(std::make_shared<Root>()), stop_(std::move(stop)) {
  root_->sink = std::move(sink);
}

Progress Progress::portion(double begin, double end, std::string phase) const {
  Progress part = *this;
  const double width = end_ - begin_;
  part.begin_ = begin_ + width * std::clamp(begin, 0.0, 1.0);
  part.end_ = begin_ + width * std::clamp(end, begin, 1.0);
  if (!phase.empty()) part.phase_ = std::move(phase);
  return part;
}

void Progress::report(double fraction) const {
  if (!root_ || !root_->sink) return;
  const double value = begin_ + (end_ - begin_) * std::clamp(fraction, 0.0, 1.0);
  std::lock_guard lock(root_->mutex);
  if (value < root_->last || (value == root_->last && phase_ == root_->last_phase)) return;
  root_->last = value;
  root_->last_phase = phase_;
  root_->sink(value, phase_);
}

Error cancelled_error() {
  return {Code::cancelled, "Cancelled.", "The last complete state was kept."};
}

}  // namespace lamella
