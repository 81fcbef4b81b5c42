// SPDX-License-Identifier: BSD-3-Clause
// loadMap(): a map file back into a document, believing nothing unchecked.
#include <csom/core/Error.h>
#include <csom/io/InputFile.h>
#include <csom/io/MapFile.h>

#include <stdexcept>
#include <utility>

#include "MapTables.h"
#include "MapVersion1.h"
#include "Sqlite.h"

namespace csom {

namespace {

using detail::Database;

/// Returns the sum of the hashes of the rows.
std::uint64_t readScans(const Database& database, std::int64_t version,
                        std::vector<ScanRecord>& scans) {
  detail::ScanReader reader(database, version);
  for (ScanRecord scan; reader.next(scan);) scans.push_back(scan);
  return reader.sumOfHashes();
}

/// The same.
std::uint64_t readChunks(const Database& database, std::int64_t version, SemanticMap& map) {
  detail::ChunkReader reader(database, version, map.options().number_of_classes);
  while (reader.next()) {
    try {
      // Its hash counts once, so the digest would not tell.
      if (isAddressable(reader.index()) && map.chunks().find(reader.index()) != nullptr)
        throw std::runtime_error("there is another row for the same place");
      map.addChunkRecord(reader.index(), reader.record().data(), reader.record().size());
    } catch (const std::runtime_error& error) {
      throw FileError(database.shownName(), "table chunks, row " + std::to_string(reader.row()) +
                                                ": " + error.what() + detail::kDamaged);
    }
  }
  return reader.sumOfHashes();
}

std::string take(detail::Texts& texts, const char* key) {
  std::string value = std::exchange(texts[key], "");
  texts.erase(key);
  return value;
}

}  // namespace

MapDocument loadMap(const std::string& file) {
  detail::requireRegularFile(file);
  Database database(file, file, Database::Mode::ReadOnly);
  // One state of a file that somebody may be writing to.
  database.execute("BEGIN");
  const std::int64_t version = detail::checkFormat(database);

  MapDocument document;
  const detail::Texts option_texts = detail::readTexts(database, "options");
  const Options options = detail::optionsOf(option_texts, file);
  const std::string yaml = detail::readLabels(database);
  document.labels = detail::labelsOf(yaml, options.number_of_classes, file);
  document.map = SemanticMap(options);
  const std::uint64_t scans = readScans(database, version, document.scans);
  document.meta = detail::readTexts(database, "meta");
  const std::uint64_t chunks = readChunks(database, version, document.map);

  const std::string digest = take(document.meta, detail::kDigestKey);
  const std::string checksum = take(document.meta, detail::kChecksumKey);
  const std::string found = version >= 2 ? detail::computeDigest(options, chunks)
                                         : detail::version1::computeDigest(document.map);
  if (found != digest)
    throw FileError(file, "its chunks have digest " + found + ", table meta says '" + digest + "'" +
                              detail::kDamaged);
  const std::string found_checksum =
      version >= 2 ? detail::computeChecksum(detail::describe(option_texts, yaml, document.meta),
                                             scans, document.scans.size())
                   : detail::version1::computeChecksum(document, option_texts);
  if (found_checksum != checksum)
    throw FileError(file, std::string("its options, label set, scans or meta have been changed: "
                                      "their checksum is not '") +
                              checksum + "'" + detail::kDamaged);
  return document;
}

}  // namespace csom
