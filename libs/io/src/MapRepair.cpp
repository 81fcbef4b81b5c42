// SPDX-License-Identifier: BSD-3-Clause
// What can be saved of a damaged map file.
#include <csom/core/Error.h>
#include <csom/io/InputFile.h>
#include <csom/io/MapRepair.h>
#include <csom/io/TemporaryFolder.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <tuple>

#include "MapTables.h"
#include "Sqlite.h"
#include "TableRows.h"
#include "WriteAheadLog.h"

namespace csom {

namespace {

using detail::Database;
using detail::RowValue;
using detail::TableRow;
using Place = std::tuple<std::int32_t, std::int32_t, std::int32_t>;

/// The longest row: a chunk of 256 classes that zstd could not make smaller, and its columns.
constexpr std::size_t kMaxBytes = 1U << 20U;
constexpr std::size_t kPlacesShown = 10;

/// The bytes of a row if it is `(INTEGER hash, BLOB bytes)` and the hash is right.
std::optional<detail::Description> asDescription(const TableRow& row) {
  if (row.size() != 2 || row[0].kind != RowValue::Kind::Integer ||
      row[1].kind != RowValue::Kind::Bytes)
    return std::nullopt;
  const std::string& bytes = row[1].bytes;
  if (static_cast<std::int64_t>(detail::computeHash(bytes.data(), bytes.size())) != row[0].integer)
    return std::nullopt;
  try {
    return detail::parseDescription(bytes);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

/// A number of a column that is declared REAL: SQLite stores whole ones as integers, NaN as null.
bool readNumber(const RowValue& value, double& number) {
  if (value.kind == RowValue::Kind::Null) number = std::numeric_limits<double>::quiet_NaN();
  if (value.kind == RowValue::Kind::Integer) number = static_cast<double>(value.integer);
  if (value.kind == RowValue::Kind::Real) number = value.real;
  return value.kind != RowValue::Kind::Bytes;
}
bool readNumber(const RowValue& value, std::size_t& number) {
  number = static_cast<std::size_t>(value.integer);
  return value.kind == RowValue::Kind::Integer && value.integer >= 0;
}

std::optional<ScanRecord> asScan(std::int64_t id, const TableRow& row) {
  constexpr std::size_t kFixed = 7;  // id, time, two texts, origin
  std::size_t columns = kFixed + 1;
  ScanRecord scan;
  visitReport(scan.report, [&](const std::string&, const auto&) { ++columns; });
  if (row.size() != columns || row[2].kind != RowValue::Kind::Bytes ||
      row[3].kind != RowValue::Kind::Bytes || !readNumber(row[1], scan.timestamp))
    return std::nullopt;
  scan.sensor_label = row[2].bytes;
  scan.observation_class = row[3].bytes;
  bool good = true;
  for (std::size_t i = 0; i < 3; ++i) good = good && readNumber(row[4 + i], scan.origin[i]);
  std::size_t column = kFixed;
  visitReport(scan.report, [&](const std::string&, auto& field) {
    good = good && readNumber(row[column++], field);
  });
  const RowValue& hash = row.back();
  if (!good || hash.kind != RowValue::Kind::Integer ||
      static_cast<std::int64_t>(detail::scanHash(id, scan)) != hash.integer)
    return std::nullopt;
  return scan;
}

std::optional<detail::Totals> asTotals(const TableRow& row) {
  using Kind = RowValue::Kind;
  if (row.size() != 5 || row[0].kind != Kind::Integer || row[1].kind != Kind::Integer ||
      row[2].kind != Kind::Bytes || row[3].kind != Kind::Bytes || row[4].kind != Kind::Integer)
    return std::nullopt;
  const detail::Totals totals{static_cast<std::uint64_t>(row[0].integer),
                              static_cast<std::uint64_t>(row[1].integer), row[2].bytes,
                              row[3].bytes};
  if (static_cast<std::int64_t>(detail::totalsHash(totals)) != row[4].integer) return std::nullopt;
  return totals;
}

struct FoundChunk {
  ChunkIndex index;
  std::string record;
};

class ChunkParser {
 public:
  /// The chunk that a row holds, if its hash is right.
  std::optional<FoundChunk> parse(const TableRow& row) {
    if (row.size() != 5 || row[4].kind != RowValue::Kind::Bytes) return std::nullopt;
    for (std::size_t i = 0; i < 4; ++i)
      if (row[i].kind != RowValue::Kind::Integer) return std::nullopt;
    FoundChunk chunk;
    std::int32_t* const axes[]{&chunk.index.x, &chunk.index.y, &chunk.index.z};
    for (std::size_t i = 0; i < 3; ++i) {
      *axes[i] = static_cast<std::int32_t>(row[i].integer);
      if (*axes[i] != row[i].integer) return std::nullopt;
    }
    try {
      chunk.record = codec_.decompress(row[4].bytes, kMaxBytes);
    } catch (const std::runtime_error&) {
      return std::nullopt;
    }
    const std::uint64_t hash =
        detail::chunkHash(chunk.index, chunk.record.data(), chunk.record.size());
    if (static_cast<std::int64_t>(hash) != row[3].integer) return std::nullopt;
    return chunk;
  }

 private:
  detail::ChunkCodec codec_;
};

/// What the trees of the database still say; every member may be missing.
struct StatedContent {
  std::optional<detail::Description> description;
  std::optional<std::set<Place>> places;  ///< of its chunks
  std::string digest;
};

template <class Read>
void tryToRead(Read&& read) {
  try {
    read();
  } catch (const std::runtime_error&) {
    // What cannot be read is not stated.
  }
}

StatedContent statedContent(const std::string& file) {
  StatedContent stated;
  tryToRead([&] {
    const Database database(file, file, Database::Mode::ReadOnly);
    detail::checkFormat(database);  // nothing is asked of a schema that may be a query of its own
    tryToRead([&] {
      const detail::Texts meta = detail::readTexts(database, "meta");
      if (const auto digest = meta.find(detail::kDigestKey); digest != meta.end())
        stated.digest = digest->second;
      stated.description = detail::Description{detail::readTexts(database, "options"),
                                               detail::readLabels(database), meta};
    });
    tryToRead([&] {
      std::set<Place> places;
      // The index has the places of chunks whose own pages are damaged.
      detail::Statement rows(database, "SELECT x, y, z FROM chunks ORDER BY z, y, x");
      while (rows.step())
        places.emplace(static_cast<std::int32_t>(rows.integer(0)),
                       static_cast<std::int32_t>(rows.integer(1)),
                       static_cast<std::int32_t>(rows.integer(2)));
      stated.places = std::move(places);
    });
  });
  return stated;
}

/// All rows of a file whose hashes are right.
struct FoundRows {
  std::optional<detail::Description> description;
  std::optional<detail::Totals> totals;
  std::map<std::int64_t, ScanRecord> scans;
  std::map<Place, std::string> chunks;
  std::set<Place> ambiguous;  ///< several different records of one place
};

FoundRows findRows(const std::string& file) {
  FoundRows found;
  ChunkParser parser;
  detail::forEachTableRow(file, kMaxBytes, [&](std::int64_t id, const TableRow& row) {
    if (auto chunk = parser.parse(row)) {
      const Place place{chunk->index.x, chunk->index.y, chunk->index.z};
      const auto [at, added] = found.chunks.emplace(place, chunk->record);
      if (!added && at->second != chunk->record) found.ambiguous.insert(place);
    } else if (const auto scan = asScan(id, row)) {
      found.scans.emplace(id, *scan);
    } else if (const auto totals = asTotals(row)) {
      found.totals = totals;
    } else if (auto description = asDescription(row)) {
      found.description = std::move(description);
    }
  });
  return found;
}

std::string describePlace(const Place& place, double resolution) {
  const double edge = resolution * kChunkSide;
  const auto [x, y, z] = place;
  return "(" + toString(x * edge) + ", " + toString(y * edge) + ", " + toString(z * edge) + ")";
}

/// Where the chunks lie that the list of chunks has and the map has not; nothing without a list.
std::string placesOfLost(const StatedContent& stated, const SemanticMap& map) {
  if (!stated.places) return "";
  const double resolution = map.options().resolution;
  std::string places;
  std::size_t lost = 0;
  for (const Place& place : *stated.places) {
    const auto [x, y, z] = place;
    const ChunkIndex index{x, y, z};
    if (isAddressable(index) && map.chunks().find(index) != nullptr) continue;
    if (++lost <= kPlacesShown)
      places += (lost == 1 ? " " : ", ") + describePlace(place, resolution);
  }
  if (lost == 0) return "";
  if (lost > kPlacesShown)
    places += " and " + std::to_string(lost - kPlacesShown) + " other places";
  return ": cubes of " + toString(resolution * kChunkSide) + " m that begin at" + places;
}

void noteLostChunks(const StatedContent& stated, const FoundRows& found, const SemanticMap& map,
                    MapRepair& repair) {
  const std::string digest = mapDigest(map);
  const std::string stated_digest = found.totals ? found.totals->digest : stated.digest;
  if (digest == stated_digest) return;
  repair.lost_chunks = true;
  const std::size_t kept = map.chunks().chunkCount();
  const std::string places = placesOfLost(stated, map);
  if (found.totals && kept < found.totals->chunks)
    repair.losses.push_back(std::to_string(found.totals->chunks - kept) + " of " +
                            std::to_string(found.totals->chunks) + " chunks are lost" + places);
  else
    repair.losses.push_back("chunks may be lost, how many cannot be told" + places +
                            "; the digest of the others, " + digest + ", is not the stated one, '" +
                            stated_digest + "'");
}

void noteLostScans(const FoundRows& found, MapRepair& repair) {
  const std::size_t kept = found.scans.size();
  if (!found.totals) {
    repair.losses.emplace_back(
        "the number of scans is damaged: the records of further ones may be lost");
  } else if (kept < found.totals->scans) {
    repair.losses.push_back("the records of " + std::to_string(found.totals->scans - kept) +
                            " of " + std::to_string(found.totals->scans) +
                            " scans are lost; what the scans saw is in the chunks");
  }
}

/// A file with what is still in the write-ahead log beside it, as a file of its own.
struct WithoutLog {
  std::optional<std::string> copy;  ///< nothing: there is no log
  std::string damage;  ///< of the log, part or all of which could not be read; empty: it is whole
};

/// One state of a file that somebody may be writing to. Throws FileError.
void copyDatabase(const std::string& file, const std::string& copy) {
  const Database source(file, file, Database::Mode::ReadOnly);
  Database target(copy, file, Database::Mode::ReadWrite);
  target.copyFrom(source);
  target.close();
}

/// The same where SQLite cannot read the log in its place, as it wants to write a third file beside
/// it. Throws FileError if the two cannot even be copied, std::runtime_error if the copy is
/// damaged.
void copyFiles(const std::string& file, const std::string& copy) {
  for (const char* ending : {"", "-wal"}) {
    std::error_code error;
    std::filesystem::copy_file(file + ending, copy + ending,
                               std::filesystem::copy_options::overwrite_existing, error);
    if (error)
      throw FileError(file + ending, "cannot be copied to " +
                                         std::filesystem::path(copy).parent_path().string() + " (" +
                                         error.message() +
                                         "): it holds what was committed last. Set TMPDIR to a "
                                         "folder with room for it, or make it readable");
  }
}

/// Empty if the log is whole; if it cannot even be read, copyFiles() will say so.
std::string logDamage(const std::string& file) {
  try {
    return detail::damageOfLog(file + "-wal");
  } catch (const FileError& error) {
    return error.what();
  }
}

/// Throws FileError if there is a log that cannot be got at: what it holds is not lost yet.
WithoutLog withoutLog(const std::string& file, const TemporaryFolder& folder) {
  std::error_code error;
  const auto status = std::filesystem::status(file + "-wal", error);
  if (status.type() == std::filesystem::file_type::not_found) return {};
  if (std::filesystem::file_size(file + "-wal", error) == 0 && !error) return {};
  const std::string copy = folder.file("map.csom");
  const std::string damage = logDamage(file);
  try {
    copyDatabase(file, copy);
    return {copy, damage};
  } catch (const std::runtime_error&) {
    for (const char* ending : {"", "-wal", "-shm", "-journal"})
      std::filesystem::remove(copy + ending, error);
  }
  copyFiles(file, copy);
  try {
    Database database(copy, file, Database::Mode::ReadWrite);
    database.execute("PRAGMA wal_checkpoint(TRUNCATE)");
    database.close();
    return {copy, damage};
  } catch (const std::runtime_error& wrong) {
    return {std::nullopt, damage.empty() ? wrong.what() : damage};
  }
}

MapRepair recoverFrom(const std::string& file, const std::string& shown_name) {
  const StatedContent stated = statedContent(file);
  FoundRows found = findRows(file);
  MapRepair repair;
  if (!found.description && stated.description) {
    found.description = stated.description;
    repair.losses.emplace_back(
        "the copy of options, label set and meta is damaged; they are there");
  } else if (!stated.description && found.description) {
    repair.losses.emplace_back(
        "the tables options, labels or meta are damaged; all of it is there from the copy");
  }
  if (!found.description)
    throw FileError(shown_name,
                    "holds no options of a map of format version 2 or later that can be read: what "
                    "chunks there are has no meaning without them");
  detail::Description& description = *found.description;
  const Options options = detail::optionsOf(description.options, shown_name);
  MapDocument& document = repair.document;
  document.labels = detail::labelsOf(description.labels, options.number_of_classes, shown_name);
  document.map = SemanticMap(options);
  document.meta = std::move(description.meta);
  for (const char* key : {detail::kDigestKey, detail::kChecksumKey, detail::kStateKey})
    document.meta.erase(key);
  for (const Place& place : found.ambiguous) found.chunks.erase(place);
  for (const auto& [place, record] : found.chunks) {
    const auto [x, y, z] = place;
    document.map.addChunkRecord({x, y, z}, record.data(), record.size());
  }
  for (const auto& [id, scan] : found.scans) document.scans.push_back(scan);
  noteLostChunks(stated, found, document.map, repair);
  noteLostScans(found, repair);
  return repair;
}

}  // namespace

MapRepair recoverMap(const std::string& file) {
  detail::requireRegularFile(file);
  const TemporaryFolder folder;
  const WithoutLog source = withoutLog(file, folder);
  MapRepair repair = recoverFrom(source.copy.value_or(file), file);
  if (!source.damage.empty()) {
    repair.lost_chunks = true;
    repair.losses.push_back(
        "what was committed last may be lost, as the log beside the file (-wal) "
        "cannot be read to its end: " +
        source.damage);
  }
  return repair;
}

}  // namespace csom
