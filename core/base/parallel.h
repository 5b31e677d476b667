#pragma once

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstddef>

#include "core/base/progress.h"

namespace lamella {

/// True in a process forked from one with threads: it has none of them, nor can it make new ones
/// safely, and `parallel_each` works in place.
inline bool without_threads = false;

/// An arena of `threads` threads (0: all cores).
inline tbb::task_arena thread_arena(int threads) {
  const int cores = tbb::info::default_concurrency();
  return tbb::task_arena(threads > 0 ? std::min(threads, cores) : cores);
}

/// Calls work(i) once for every i in [0, count), on `threads` threads (0: all cores), in no given
/// order: each call must write only what belongs to i, so that the thread count changes nothing.
/// Reports progress. Returns false when cancelled, some calls then being left out.
template <class Work>
bool parallel_each(std::size_t count, int threads, const Progress& progress, Work&& work,
                   std::size_t grain = 64) {
  if (without_threads) {
    for (std::size_t i = 0; i < count && !progress.cancelled(); ++i) work(i);
    if (!progress.cancelled()) progress.report(1);
    return !progress.cancelled();
  }
  std::atomic<std::size_t> done{0};
  thread_arena(threads).execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
      if (progress.cancelled()) return;
      for (auto i = range.begin(); i != range.end(); ++i) work(i);
      progress.report(static_cast<double>(done += range.size()) / static_cast<double>(count));
    });
  });
  return !progress.cancelled();
}

/// Calls work(first, last) for ranges of at most `size` that together are [0, count); otherwise as
/// `parallel_each`.
template <class Work>
void parallel_ranges(std::size_t count, std::size_t size, int threads, Work&& work) {
  if (count <= size) {
    if (count > 0) work(std::size_t{0}, count);
    return;
  }
  parallel_each((count + size - 1) / size, threads, {},
                [&](std::size_t r) { work(r * size, std::min(count, (r + 1) * size)); }, 1);
}

}  // namespace lamella
