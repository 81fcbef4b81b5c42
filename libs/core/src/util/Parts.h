// SPDX-License-Identifier: BSD-3-Clause
// Arrays cut into a fixed number of parts: for work whose steps must cut them at the same places.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>

namespace csom::detail {

/// Number of parts, large enough to pay, into which `size` items are cut. `threads` as in Options.
inline std::size_t partsFor(std::size_t size, int threads) {
  constexpr std::size_t kMinPart = 4096;
  if (threads == 1) return 1;
  const auto most = static_cast<std::size_t>(threads);
  return std::clamp<std::size_t>(
      size / kMinPart, 1, threads > 0 ? most : std::max(1U, std::thread::hardware_concurrency()));
}

/// Part i of `parts` is partBegin(i) … partBegin(i + 1)−1.
inline std::size_t partBegin(std::size_t size, std::size_t part, std::size_t parts) {
  return size * part / parts;
}

}  // namespace csom::detail
