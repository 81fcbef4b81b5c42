// SPDX-License-Identifier: BSD-3-Clause
// Chunks on their way into a file that has some already.
#include "ChunkWriter.h"

#include <csom/core/Error.h>

#include <stdexcept>
#include <string>

#include "MapTables.h"

namespace csom::detail {

ChunkWriter::ChunkWriter(const Database& database, int number_of_classes, Sums& sums)
    : database_(database),
      number_of_classes_(number_of_classes),
      sums_(sums),
      select_(database, "SELECT rowid, hash, record FROM chunks WHERE z = ? AND y = ? AND x = ?"),
      insert_(database, "INSERT INTO chunks (x, y, z, hash, record) VALUES (?, ?, ?, ?, ?)"),
      update_(database, "UPDATE chunks SET hash = ?, record = ? WHERE rowid = ?") {}

void ChunkWriter::write(const ChunkIndex& index, const Chunk& chunk, MapStore::Voxels voxels) {
  select_.reset();
  select_.bind(1, std::int64_t{index.z}).bind(2, std::int64_t{index.y});
  select_.bind(3, std::int64_t{index.x});
  if (!select_.step()) {
    insert(index, chunk);
    return;
  }
  const std::int64_t row = select_.integer(0);
  const auto old_hash = static_cast<std::uint64_t>(select_.integer(1));
  ChunkRef sum;
  if (voxels == MapStore::Voxels::Add) sum = added(index, chunk, old_hash);
  select_.reset();
  update(row, index, sum ? *sum : chunk, old_hash);
}

ChunkRef ChunkWriter::added(const ChunkIndex& index, const Chunk& chunk, std::uint64_t hash) {
  ChunkRef sum;
  const std::string place = "table chunks, chunk (" + std::to_string(index.x) + ", " +
                            std::to_string(index.y) + ", " + std::to_string(index.z) + ")";
  explainedAt(database_.shownName(), place, [&] {
    const std::string_view record =
        codec_.decompress(select_.blob(2), maxRecordSize(number_of_classes_));
    if (chunkHash(index, record.data(), record.size()) != hash)
      throw std::runtime_error("its hash does not match");
    const ChunkRef base = Chunk::fromRecord(record.data(), record.size(), number_of_classes_);
    sum = Chunk::sum(base.get(), chunk.toIncrements());
  });
  return sum;
}

void ChunkWriter::insert(const ChunkIndex& index, const Chunk& chunk) {
  const std::uint64_t hash = chunkHash(index, chunk.record(), chunk.recordSize());
  const std::string_view frame = codec_.compress(chunk.record(), chunk.recordSize());
  insert_.bind(1, std::int64_t{index.x}).bind(2, std::int64_t{index.y});
  insert_.bind(3, std::int64_t{index.z}).bind(4, static_cast<std::int64_t>(hash));
  insert_.bindBlob(5, frame.data(), frame.size()).run();
  sums_.chunks += hash;
  ++sums_.chunk_count;
}

void ChunkWriter::update(std::int64_t row, const ChunkIndex& index, const Chunk& chunk,
                         std::uint64_t old_hash) {
  const std::uint64_t hash = chunkHash(index, chunk.record(), chunk.recordSize());
  if (hash == old_hash) return;
  const std::string_view frame = codec_.compress(chunk.record(), chunk.recordSize());
  update_.bind(1, static_cast<std::int64_t>(hash));
  update_.bindBlob(2, frame.data(), frame.size()).bind(3, row).run();
  sums_.chunks += hash - old_hash;
}

}  // namespace csom::detail
