// SPDX-License-Identifier: BSD-3-Clause
// Collects the increments of a chunk voxel by voxel, in any order of voxels, and lists them sorted.
#pragma once

#include <csom/core/CountIncrements.h>
#include <csom/core/Grid.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace csom::detail {

class VoxelRuns {
 public:
  /// Adds the counts of a voxel for `size` classes in ascending order, those that are not 0:
  /// countOf(i) for the i-th class. A voxel comes once. Free of branches inside: whether a class
  /// has any mass in a voxel cannot be foreseen.
  template <class CountOf>
  void add(int index_in_chunk, const ClassId* classes, std::size_t size, CountOf&& countOf) {
    if (entries_.size() < used_ + size) entries_.resize(2 * (used_ + size));
    const auto voxel = static_cast<std::uint16_t>(index_in_chunk);
    std::size_t end = used_;
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint32_t count = countOf(i);
      entries_[end] = {voxel, classes[i], count};
      end += count > 0 ? 1 : 0;
    }
    if (end == used_) return;
    known_[voxel >> 6U] |= std::uint64_t{1} << (voxel & 63U);
    runs_[voxel] = {static_cast<std::uint32_t>(used_), static_cast<std::uint32_t>(end - used_)};
    used_ = end;
    ++voxels_;
  }

  std::size_t voxelCount() const { return voxels_; }

  /// Everything since the last call, sorted by voxel and class.
  std::vector<CountIncrement> take() {
    std::vector<CountIncrement> sorted;
    sorted.reserve(used_);
    for (std::size_t word = 0; word < known_.size(); ++word) {
      for (std::uint64_t bits = known_[word]; bits != 0; bits &= bits - 1) {
        const Run run = runs_[word * 64 + static_cast<std::size_t>(__builtin_ctzll(bits))];
        for (std::size_t i = run.begin; i < run.begin + run.size; ++i)
          sorted.push_back(entries_[i]);
      }
    }
    known_.fill(0);
    used_ = 0;
    voxels_ = 0;
    return sorted;
  }

 private:
  struct Run {
    std::uint32_t begin;
    std::uint32_t size;
  };
  std::vector<CountIncrement> entries_;  ///< of which `used_` are in use
  std::size_t used_ = 0;
  std::array<std::uint64_t, kVoxelsPerChunk / 64> known_{};
  std::array<Run, kVoxelsPerChunk> runs_{};  ///< of the known voxels
  std::size_t voxels_ = 0;
};

}  // namespace csom::detail
