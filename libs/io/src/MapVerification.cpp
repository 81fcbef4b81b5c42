// SPDX-License-Identifier: BSD-3-Clause
// Whether a map file is as it was written.
#include <csom/core/Error.h>
#include <csom/io/InputFile.h>
#include <csom/io/MapRepair.h>

#include <stdexcept>

#include "MapTables.h"
#include "PageSeals.h"
#include "Sqlite.h"

namespace csom {

namespace {

using detail::Database;

class Faults {
 public:
  explicit Faults(MapVerification& result) : result_(result) {}
  void add(const std::string& fault) {
    if (result_.faults.size() < MapVerification::kMaxFaults)
      result_.faults.push_back(fault);
    else
      ++more_;
  }
  /// Runs a part of the check that ends where it throws.
  template <class Check>
  void collect(Check&& check) {
    try {
      check();
    } catch (const std::runtime_error& error) {
      add(error.what());
    }
  }
  void close() {
    if (more_ > 0) result_.faults.push_back("and " + std::to_string(more_) + " more");
  }

 private:
  MapVerification& result_;
  std::size_t more_ = 0;
};

void checkTrees(const Database& database, Faults& faults) {
  detail::Statement check(database, "PRAGMA integrity_check(20)");
  while (check.step()) {
    if (check.text(0) != "ok") faults.add(database.shownName() + ": " + check.text(0));
  }
}

std::uint64_t checkScans(const Database& database, Faults& faults, MapVerification& result) {
  detail::ScanReader reader(database, detail::kFormatVersion);
  for (ScanRecord scan; reader.step();) {
    faults.collect([&] {
      reader.read(scan);
      ++result.scans;
    });
  }
  return reader.sumOfHashes();
}

std::uint64_t checkChunks(const Database& database, const Options& options, Faults& faults,
                          MapVerification& result) {
  detail::ChunkReader reader(database, detail::kFormatVersion, options.number_of_classes);
  while (reader.step()) {
    faults.collect([&] {
      reader.read();
      // Checks what a hash cannot: that the record is one.
      SemanticMap(options).addChunkRecord(reader.index(), reader.record().data(),
                                          reader.record().size());
      ++result.chunks;
    });
  }
  return reader.sumOfHashes();
}

void checkResume(const Database& database) {
  detail::Statement rows(database, "SELECT key, value, hash FROM resume");
  while (rows.step()) {
    const std::string key = rows.text(0);
    if (static_cast<std::int64_t>(detail::resumeHash(key, rows.blob(1))) != rows.integer(2))
      throw FileError(database.shownName(),
                      "table resume, key " + key + ": its hash does not match" + detail::kDamaged);
  }
}

void checkDescription(const Database& database, const std::string& description) {
  detail::Statement rows(database, "SELECT hash, bytes FROM description");
  if (!rows.step() || rows.blob(1) != description ||
      rows.integer(0) !=
          static_cast<std::int64_t>(detail::computeHash(description.data(), description.size())))
    throw FileError(
        database.shownName(),
        std::string("table description is no copy of options, labels and meta") + detail::kDamaged);
}

void checkTotals(const Database& database, const detail::Totals& totals) {
  detail::Statement rows(database, "SELECT chunks, scans, digest, checksum, hash FROM totals");
  if (!rows.step() || rows.integer(0) != static_cast<std::int64_t>(totals.chunks) ||
      rows.integer(1) != static_cast<std::int64_t>(totals.scans) || rows.text(2) != totals.digest ||
      rows.text(3) != totals.checksum ||
      rows.integer(4) != static_cast<std::int64_t>(detail::totalsHash(totals)))
    throw FileError(database.shownName(),
                    std::string("table totals is not that of the other tables") + detail::kDamaged);
}

void checkTables(const Database& database, Faults& faults, MapVerification& result) {
  const std::string& file = database.shownName();
  const detail::Texts option_texts = detail::readTexts(database, "options");
  const Options options = detail::optionsOf(option_texts, file);
  const std::string yaml = detail::readLabels(database);
  detail::labelsOf(yaml, options.number_of_classes, file);
  const detail::Texts meta = detail::readTexts(database, "meta");
  result.finished = meta.count(detail::kStateKey) == 0;
  const std::uint64_t scans = checkScans(database, faults, result);
  const std::uint64_t chunks = checkChunks(database, options, faults, result);
  result.digest = detail::computeDigest(options, chunks);
  const auto stated = [&](const char* key) {
    const auto found = meta.find(key);
    return found == meta.end() ? std::string() : found->second;
  };
  if (result.digest != stated(detail::kDigestKey))
    faults.add(file + ": its intact chunks have digest " + result.digest + ", table meta says '" +
               stated(detail::kDigestKey) + "'");
  const std::string description = detail::describe(option_texts, yaml, meta);
  const std::string checksum = detail::computeChecksum(description, scans, result.scans);
  if (checksum != stated(detail::kChecksumKey))
    faults.add(file + ": options, label set, scans and meta do not have the checksum '" +
               stated(detail::kChecksumKey) + "'");
  faults.collect([&] { checkDescription(database, description); });
  faults.collect([&] {
    checkTotals(database, {result.chunks, result.scans, result.digest, checksum});
  });
  checkResume(database);
}

/// A file of version 1 has nothing that could be checked piece by piece.
MapVerification verifyVersion1(const std::string& file) {
  MapVerification result;
  Faults faults(result);
  faults.collect([&] {
    const MapDocument document = loadMap(file);
    result.chunks = document.map.chunks().chunkCount();
    result.scans = document.scans.size();
    result.digest = mapDigest(document.map);
  });
  return result;
}

bool isOfVersion(const std::string& file, std::int64_t version) {
  try {
    return detail::checkFormat(Database(file, file, Database::Mode::ReadOnly)) == version;
  } catch (const detail::LaterVersionError&) {
    throw;
  } catch (const FileError&) {
    return false;
  }
}

}  // namespace

MapVerification verifyMap(const std::string& file) {
  detail::requireRegularFile(file);
  if (isOfVersion(file, 1)) return verifyVersion1(file);
  MapVerification result;
  Faults faults(result);
  faults.collect([&] {
    Database database(file, file, Database::Mode::ReadOnly);
    database.execute("BEGIN");
    detail::checkFormat(database);
    checkTables(database, faults, result);
    checkTrees(database, faults);
  });
  if (result.finished) {
    for (const std::string& fault : detail::checkSeals(file)) faults.add(file + ": " + fault);
  }
  faults.close();
  return result;
}

}  // namespace csom
