// SPDX-License-Identifier: BSD-3-Clause
// Chunks on their way into a file that has some already.
#pragma once

#include <csom/io/MapStore.h>

#include <cstddef>
#include <cstdint>

#include "ChunkCodec.h"
#include "Sqlite.h"

namespace csom::detail {

/// What changes with every commit, in memory as it is in the file.
struct Sums {
  std::uint64_t chunks = 0;
  std::uint64_t scans = 0;
  std::size_t chunk_count = 0;
  std::size_t scan_count = 0;
};

/// The rows of `chunks`, one at a time by their place.
class ChunkWriter {
 public:
  /// Keeps `sums` up to date with what is written.
  ChunkWriter(const Database& database, int number_of_classes, Sums& sums);

  void write(const ChunkIndex& index, const Chunk& chunk, MapStore::Voxels voxels);

 private:
  /// The chunk in the file, the row that was selected, plus `chunk`.
  ChunkRef added(const ChunkIndex& index, const Chunk& chunk, std::uint64_t hash);
  void insert(const ChunkIndex& index, const Chunk& chunk);
  void update(std::int64_t row, const ChunkIndex& index, const Chunk& chunk,
              std::uint64_t old_hash);

  const Database& database_;
  int number_of_classes_;
  Sums& sums_;
  ChunkCodec codec_;
  Statement select_;
  Statement insert_;
  Statement update_;
};

}  // namespace csom::detail
