#pragma once

#include <QObject>
#include <QTimer>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "core/base/progress.h"

namespace lamella::ui {

/// One background job at a time on a thread of its own.
///
/// A job runs off the window's thread and returns what to do with its result in the window's
/// thread. Progress is sampled every 40 ms, however often the job reports.
class Worker : public QObject {
  Q_OBJECT

 public:
  using Done = std::function<void()>;
  using Job = std::function<Done(const Progress&)>;

  explicit Worker(QObject* parent = nullptr);
  /// Asks the job to stop and waits for it; its result is dropped.
  ~Worker() override;

  bool busy() const { return busy_; }
  bool cancelling() const { return busy_ && thread_.get_stop_token().stop_requested(); }
  /// Starts `job`; must not be busy.
  void start(Job job);
  /// Holds the job at its next report of progress, or lets it go on. One that is held can be
  /// cancelled; a new job is not held.
  void pause(bool on);
  bool paused() const { return busy_ && paused_; }
  /// Asks the job to stop; `finished` comes when it has.
  void cancel();
  /// Runs `call` in the window's thread; for use by the running job.
  void post(std::function<void()> call);

 Q_SIGNALS:
  /// Fraction in [0, 1] and the phase the job is in.
  void progressed(double fraction, const QString& phase);
  void finished();

 private:
  void sample();

  std::jthread thread_;
  bool busy_ = false;
  QTimer timer_;
  bool paused_ = false;  // as `hold_`, for the window's thread
  std::mutex mutex_;     // guards what follows: written by the job, read by the timer
  double fraction_ = 0;
  std::string phase_;
  bool fresh_ = false;
  bool hold_ = false;
  std::condition_variable_any released_;
};

}  // namespace lamella::ui
