// SPDX-License-Identifier: BSD-3-Clause
// A loop over independent pieces of work on a given number of threads.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <optional>

namespace csom::detail {

/// Calls work(begin, end) for ranges that cover [0, size). `threads` as in Options: 1 stays on the
/// calling thread, 0 takes all processors.
template <class Work>
void parallelRanges(std::size_t size, int threads, const Work& work) {
  if (size == 0) return;
  if (threads == 1) {
    work(std::size_t{0}, size);
    return;
  }
  // More threads than processors only on demand: TBB refuses them otherwise.
  std::optional<tbb::global_control> more_threads;
  if (threads > tbb::this_task_arena::max_concurrency())
    more_threads.emplace(tbb::global_control::max_allowed_parallelism,
                         static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads == 0 ? tbb::task_arena::automatic : threads);
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, size),
        [&](const tbb::blocked_range<std::size_t>& range) { work(range.begin(), range.end()); });
  });
}

}  // namespace csom::detail
