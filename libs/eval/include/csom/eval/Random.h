// SPDX-License-Identifier: BSD-3-Clause
// Random numbers that are the same everywhere: the standard leaves its distributions open.
#pragma once

#include <cstdint>
#include <random>

namespace csom {

/// A stream of random numbers, fixed by (seed, stream). Not thread-safe.
class Random {
 public:
  /// Streams of one seed are independent: one for each sensor keeps the others' numbers when one is
  /// added.
  Random(std::uint64_t seed, std::uint64_t stream);

  /// Uniform in [0, 1), a multiple of 2⁻⁵³.
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal, by Box and Muller's transform; two uniform numbers each.
  double gaussian();

 private:
  std::mt19937_64 engine_;
};

}  // namespace csom
