// SPDX-License-Identifier: BSD-3-Clause
// loadMap(): a map file back into a document, believing nothing unchecked.
#include <csom/core/Error.h>
#include <csom/io/InputFile.h>
#include <csom/io/MapFile.h>

#include <set>
#include <stdexcept>
#include <utility>

#include "ChunkCodec.h"
#include "MapSchema.h"
#include "Sqlite.h"

namespace csom {

namespace {

using detail::Database;
using detail::Statement;

constexpr const char* kDamaged = "; the file is damaged, make the map again";

std::int64_t readPragma(const Database& database, const std::string& name) {
  Statement pragma(database, "PRAGMA " + name);
  return pragma.step() ? pragma.integer(0) : 0;
}

void checkFormat(const Database& database) {
  const std::string& file = database.shownName();
  if (readPragma(database, "application_id") != detail::kApplicationId)
    throw FileError(file, "is no csom map (a SQLite database of another kind)");
  const std::int64_t version = readPragma(database, "user_version");
  if (version > detail::kFormatVersion)
    throw FileError(file, "is a map of format version " + std::to_string(version) +
                              ", this program reads up to " +
                              std::to_string(detail::kFormatVersion) +
                              "; use a newer mrpt_csom to read it");
  if (version != detail::kFormatVersion)
    throw FileError(file,
                    "has the impossible format version " + std::to_string(version) + kDamaged);
}

/// A view or a virtual table could be a query that never ends.
void checkTables(const Database& database) {
  for (const char* table : {"meta", "options", "labels", "scans", "chunks"}) {
    Statement select(
        database, "SELECT 1 FROM sqlite_master WHERE type = 'table' AND rootpage > 0 AND name = ?");
    select.bind(1, std::string_view(table));
    if (!select.step())
      throw FileError(database.shownName(), std::string("has no table ") + table + kDamaged);
  }
}

std::map<std::string, std::string> readTable(const Database& database, const std::string& table) {
  std::map<std::string, std::string> result;
  Statement select(database, "SELECT key, value FROM " + table);
  while (select.step()) result[select.text(0)] = select.text(1);
  return result;
}

Options readOptions(const Database& database) {
  auto texts = readTable(database, "options");
  Options options;
  try {
    visitOptions(options, [&](const char* name, auto& field, const char*, const char*) {
      const auto it = texts.find(name);
      if (it == texts.end()) throw OptionError(std::string(name) + " is missing");
      parse(name, it->second, field);
      texts.erase(it);
    });
    if (!texts.empty()) throw OptionError("unknown option " + texts.begin()->first);
    options.validate();
  } catch (const OptionError& error) {
    throw FileError(database.shownName(), std::string("table options: ") + error.what() + kDamaged);
  }
  return options;
}

LabelSet readLabels(const Database& database, int number_of_classes) {
  Statement select(database, "SELECT yaml FROM labels");
  if (!select.step())
    throw FileError(database.shownName(), std::string("table labels is empty") + kDamaged);
  LabelSet labels = LabelSet::fromYaml(select.text(0), database.shownName() + ": table labels");
  if (labels.numberOfClasses() != number_of_classes)
    throw FileError(database.shownName(), "table labels has " +
                                              std::to_string(labels.numberOfClasses()) +
                                              " classes, the options say " +
                                              std::to_string(number_of_classes) + kDamaged);
  return labels;
}

/// Reads a column of a scan's report: a time or a count.
void readValue(const Database&, const Statement& row, int column, const std::string&,
               double& value) {
  value = row.real(column);
}
void readValue(const Database& database, const Statement& row, int column, const std::string& name,
               std::size_t& value) {
  const std::int64_t count = row.integer(column);
  if (count < 0)
    throw FileError(database.shownName(), "table scans, row " + std::to_string(row.row()) + ": " +
                                              name + " is " + std::to_string(count) + kDamaged);
  value = static_cast<std::size_t>(count);
}

std::vector<ScanRecord> readScans(const Database& database) {
  std::vector<ScanRecord> scans;
  Statement row(database, "SELECT " + detail::scanColumns() + " FROM scans ORDER BY id");
  while (row.step()) {
    ScanRecord scan;
    int column = 0;
    scan.timestamp = row.real(column++);
    scan.sensor_label = row.text(column++);
    scan.observation_class = row.text(column++);
    for (double& coordinate : scan.origin) coordinate = row.real(column++);
    visitReport(scan.report, [&](const std::string& name, auto& field) {
      readValue(database, row, column++, name, field);
    });
    scans.push_back(std::move(scan));
  }
  return scans;
}

std::int32_t chunkCoordinate(std::int64_t value) {
  const auto coordinate = static_cast<std::int32_t>(value);
  if (coordinate != value)
    throw std::runtime_error("chunk index " + std::to_string(value) + " is out of range");
  return coordinate;
}

std::size_t maxRecordSize(int number_of_classes) {
  constexpr std::size_t voxels = kVoxelsPerChunk;
  const std::size_t entries = voxels * static_cast<std::size_t>(number_of_classes);
  return sizeof(Chunk::Header) + 5 * entries + 2 * voxels + 8;
}

void readChunks(const Database& database, SemanticMap& map) {
  const std::size_t max_size = maxRecordSize(map.options().number_of_classes);
  detail::ChunkCodec codec;
  Statement row(database, "SELECT x, y, z, hash, record FROM chunks");
  while (row.step()) {
    try {
      const ChunkIndex index{chunkCoordinate(row.integer(0)), chunkCoordinate(row.integer(1)),
                             chunkCoordinate(row.integer(2))};
      const std::string_view record = codec.decompress(row.blob(4), max_size);
      if (static_cast<std::int64_t>(detail::hashOf(record.data(), record.size())) != row.integer(3))
        throw std::runtime_error("its hash does not match");
      map.addChunkRecord(index, record.data(), record.size());
    } catch (const FileError&) {
      throw;
    } catch (const std::runtime_error& error) {
      throw FileError(database.shownName(), "table chunks, row " + std::to_string(row.row()) +
                                                ": " + error.what() + kDamaged);
    }
  }
}

}  // namespace

MapDocument loadMap(const std::string& file) {
  detail::requireRegularFile(file);
  const Database database(file, file, Database::Mode::ReadOnly);
  checkFormat(database);
  checkTables(database);

  MapDocument document;
  const Options options = readOptions(database);
  document.labels = readLabels(database, options.number_of_classes);
  document.map = SemanticMap(options);
  document.scans = readScans(database);
  document.meta = readTable(database, "meta");
  readChunks(database, document.map);

  const std::string digest = std::exchange(document.meta[detail::kDigestKey], "");
  document.meta.erase(detail::kDigestKey);
  const std::string checksum = std::exchange(document.meta[detail::kChecksumKey], "");
  document.meta.erase(detail::kChecksumKey);
  const std::string found = mapDigest(document.map);
  if (found != digest)
    throw FileError(
        file, "its chunks have digest " + found + ", table meta says '" + digest + "'" + kDamaged);
  if (detail::descriptionChecksum(document) != checksum)
    throw FileError(file, std::string("its options, label set, scans or meta have been changed: "
                                      "their checksum is not '") +
                              checksum + "'" + kDamaged);
  return document;
}

}  // namespace csom
