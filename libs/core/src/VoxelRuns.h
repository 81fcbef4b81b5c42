// SPDX-License-Identifier: BSD-3-Clause
// Collects the increments of a chunk voxel by voxel, in any order of voxels, and lists them sorted.
#pragma once

#include <csom/core/CountIncrements.h>
#include <csom/core/DirichletVoxel.h>
#include <csom/core/Grid.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace csom::detail {

/// Kernel mass rounded once to the quantum.
inline std::uint32_t toCount(double mass) {
  const double quanta = std::floor(mass / kCountQuantum + 0.5);
  if (!(quanta > 0)) return 0;
  return quanta >= static_cast<double>(kMaxCount) ? kMaxCount : static_cast<std::uint32_t>(quanta);
}

class VoxelRuns {
 public:
  /// Between begin() and end() of a voxel: its classes in ascending order. A voxel comes once.
  void begin(int index_in_chunk) {
    voxel_ = static_cast<std::uint16_t>(index_in_chunk);
    run_begin_[voxel_] = static_cast<std::uint32_t>(entries_.size());
  }
  void add(ClassId k, double mass) {
    if (const std::uint32_t count = toCount(mass); count > 0)
      entries_.push_back({voxel_, k, count});
  }
  void end() {
    run_end_[voxel_] = static_cast<std::uint32_t>(entries_.size());
    if (run_end_[voxel_] > run_begin_[voxel_]) ++voxels_;
  }

  std::size_t voxelCount() const { return voxels_; }

  /// Everything since the last call, sorted by voxel and class.
  std::vector<CountIncrement> take() {
    std::vector<CountIncrement> sorted;
    sorted.reserve(entries_.size());
    for (std::size_t voxel = 0; voxel < kVoxelsPerChunk; ++voxel) {
      sorted.insert(sorted.end(), entries_.begin() + run_begin_[voxel],
                    entries_.begin() + run_end_[voxel]);
    }
    run_begin_.fill(0);
    run_end_.fill(0);
    entries_.clear();
    voxels_ = 0;
    return sorted;
  }

 private:
  std::vector<CountIncrement> entries_;
  std::array<std::uint32_t, kVoxelsPerChunk> run_begin_{};
  std::array<std::uint32_t, kVoxelsPerChunk> run_end_{};
  std::size_t voxels_ = 0;
  std::uint16_t voxel_ = 0;
};

}  // namespace csom::detail
