// SPDX-License-Identifier: BSD-3-Clause
// saveMap(): a document into the tables of a map file.
#include <csom/core/Error.h>
#include <csom/io/MapFile.h>
#include <csom/io/OutputFile.h>

#include <stdexcept>

#include "ChunkCodec.h"
#include "MapTables.h"
#include "PageSeals.h"
#include "Sqlite.h"

namespace csom {

namespace {

using detail::Database;
using detail::Statement;

/// Both return the sum of the hashes of their rows.
std::uint64_t writeScans(const Database& database, const std::vector<ScanRecord>& scans) {
  detail::ScanWriter writer(database);
  std::uint64_t sum = 0;
  std::int64_t id = 0;
  for (const ScanRecord& scan : scans) sum += writer.write(++id, scan);
  return sum;
}

std::uint64_t writeChunks(const Database& database, const ChunkStore& chunks) {
  Statement insert(database, "INSERT INTO chunks (x, y, z, hash, record) VALUES (?, ?, ?, ?, ?)");
  detail::ChunkCodec codec;
  std::uint64_t sum = 0;
  for (const auto& [index, chunk] : chunks.sorted()) {
    const std::string_view frame = codec.compress(chunk->record(), chunk->recordSize());
    const std::uint64_t hash = detail::chunkHash(index, chunk->record(), chunk->recordSize());
    insert.bind(1, std::int64_t{index.x}).bind(2, std::int64_t{index.y});
    insert.bind(3, std::int64_t{index.z}).bind(4, static_cast<std::int64_t>(hash));
    insert.bindBlob(5, frame.data(), frame.size()).run();
    sum += hash;
  }
  return sum;
}

}  // namespace

void saveMap(const MapDocument& document, const std::string& file) {
  if (document.map.options().number_of_classes != document.labels.numberOfClasses())
    throw std::invalid_argument("saveMap: the map and its label set differ in number of classes");
  OutputFile output(file);
  if (output.isDirect()) throw FileError(file, "is not a regular file; a map needs one");

  Database database(output.path(), file, Database::Mode::ReadWrite);
  database.reserveForSeals();
  // The temporary file is worth nothing before it is complete, and is flushed once at the end.
  database.execute("PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF; BEGIN");
  database.execute(detail::createTables());
  const Options& options = document.map.options();
  detail::Texts meta = document.meta;
  meta.erase(detail::kStateKey);  // what is saved is finished
  const std::string description =
      detail::writeDescription(database, options, document.labels, meta);
  const std::uint64_t scans = writeScans(database, document.scans);
  const std::uint64_t chunks = writeChunks(database, document.map.chunks());
  detail::writeTotals(database,
                      {document.map.chunks().chunkCount(), document.scans.size(),
                       detail::computeDigest(options, chunks),
                       detail::computeChecksum(description, scans, document.scans.size())});
  database.execute("COMMIT");
  database.close();
  detail::sealPages(output.path(), file);
  output.commit();
}

}  // namespace csom
