// SPDX-License-Identifier: BSD-3-Clause
// A loop over independent pieces of work on a given number of threads.
#pragma once

#include "util/Sanitizers.h"

#ifdef CSOM_THREAD_SANITIZED
#include <algorithm>
#include <future>
#include <thread>
#include <vector>
#else
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <optional>
#endif

#include <cstddef>

namespace csom::detail {

#ifdef CSOM_THREAD_SANITIZED

/// ThreadSanitizer cannot see how oneTBB, which is not compiled for it, hands work over: it would
/// report what is no race, or have to be told to ignore all that TBB calls, our own work included.
template <class Work>
void workOnThreads(std::size_t size, int threads, const Work& work) {
  const std::size_t wanted =
      threads == 0 ? std::thread::hardware_concurrency() : static_cast<std::size_t>(threads);
  const std::size_t parts = std::clamp<std::size_t>(wanted, 1, size);
  std::vector<std::future<void>> running;
  for (std::size_t part = 0; part < parts; ++part)
    running.push_back(std::async(std::launch::async, [&work, size, parts, part] {
      work(size * part / parts, size * (part + 1) / parts);
    }));
  for (std::future<void>& part : running) part.get();
}

#else

template <class Work>
void workOnThreads(std::size_t size, const Work& work) {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, size),
      [&](const tbb::blocked_range<std::size_t>& range) { work(range.begin(), range.end()); });
}

#endif

/// Calls work() with threads at hand for the loops in it: they are called up once, not by each
/// loop. `threads` as in Options: 1 stays on the calling thread, 0 takes all processors.
template <class Work>
void withThreads([[maybe_unused]] int threads, const Work& work) {
#ifndef CSOM_THREAD_SANITIZED
  if (threads != 1) {
    // More threads than processors only on demand: TBB refuses them otherwise.
    std::optional<tbb::global_control> more_threads;
    if (threads > tbb::this_task_arena::max_concurrency())
      more_threads.emplace(tbb::global_control::max_allowed_parallelism,
                           static_cast<std::size_t>(threads));
    tbb::task_arena(threads == 0 ? tbb::task_arena::automatic : threads).execute(work);
    return;
  }
#endif
  work();
}

/// Calls work(begin, end) for ranges that cover [0, size). `threads` as in Options: 1 stays on the
/// calling thread, others are those of withThreads() around the call, or else all processors.
template <class Work>
void parallelRanges(std::size_t size, int threads, const Work& work) {
  if (size == 0) return;
  if (threads == 1) {
    work(std::size_t{0}, size);
    return;
  }
#ifdef CSOM_THREAD_SANITIZED
  workOnThreads(size, threads, work);
#else
  workOnThreads(size, work);
#endif
}

}  // namespace csom::detail
