#include "ui/session/worker.h"

#include <cassert>

#ifdef __linux__
#include <sys/resource.h>
#endif

namespace lamella::ui {
namespace {

/// The window is to be drawn whatever the job does, so the job, with the threads it starts, goes
/// second where both want the processor.
void go_second() {
#ifdef __linux__
  // 0 is the calling thread here, and lowering one's priority is always allowed.
  setpriority(PRIO_PROCESS, 0, 10);
#endif
}

}  // namespace

Worker::Worker(QObject* parent) : QObject(parent) {
  timer_.setInterval(40);
  connect(&timer_, &QTimer::timeout, this, &Worker::sample);
}

Worker::~Worker() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void Worker::start(Job job) {
  assert(!busy_);
  busy_ = true;
  {
    std::lock_guard lock(mutex_);
    fraction_ = 0;
    phase_.clear();
    fresh_ = true;
    hold_ = false;
  }
  paused_ = false;
  timer_.start();
  thread_ = std::jthread([this, job = std::move(job)](std::stop_token stop) {
    go_second();
    const Progress progress(
        [this, stop](double fraction, std::string_view phase) {
          std::unique_lock lock(mutex_);
          fraction_ = fraction;
          phase_ = phase;
          fresh_ = true;
          released_.wait(lock, stop, [this] { return !hold_; });
        },
        stop);
    Done done = job(progress);
    post([this, done = std::move(done)] {
      thread_.join();
      timer_.stop();
      sample();
      busy_ = false;
      if (done) done();
      Q_EMIT finished();
    });
  });
}

void Worker::pause(bool on) {
  paused_ = on;
  {
    std::lock_guard lock(mutex_);
    hold_ = on;
  }
  released_.notify_all();
}

void Worker::cancel() { thread_.request_stop(); }

void Worker::post(std::function<void()> call) {
  QMetaObject::invokeMethod(this, std::move(call), Qt::QueuedConnection);
}

void Worker::sample() {
  double fraction = 0;
  QString phase;
  {
    std::lock_guard lock(mutex_);
    if (!fresh_) return;
    fresh_ = false;
    fraction = fraction_;
    phase = QString::fromStdString(phase_);
  }
  Q_EMIT progressed(fraction, phase);
}

}  // namespace lamella::ui
