// SPDX-License-Identifier: BSD-3-Clause
// A map file that grows while a map is made, and survives whatever ends that.
#include <csom/core/Error.h>
#include <csom/io/InputFile.h>
#include <csom/io/MapStore.h>
#include <csom/io/OutputFile.h>
#include <csom/io/TextParser.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "ChunkWriter.h"
#include "FileLock.h"
#include "MapTables.h"
#include "PageSeals.h"
#include "Sqlite.h"

namespace csom {

namespace {

using detail::Database;
using detail::Statement;
using detail::Sums;

void writeState(const Database& database, const MapStore::State& state) {
  Statement(database, "DELETE FROM resume").run();
  Statement insert(database, "INSERT INTO resume VALUES (?, ?, ?)");
  for (const auto& [key, value] : state) {
    insert.bind(1, key).bindBlob(2, value.data(), value.size());
    insert.bind(3, static_cast<std::int64_t>(detail::resumeHash(key, value))).run();
  }
}

MapStore::State readStateOf(const Database& database) {
  MapStore::State state;
  Statement rows(database, "SELECT key, value, hash FROM resume");
  while (rows.step()) {
    const std::string key = rows.text(0);
    const std::string_view value = rows.blob(1);
    if (static_cast<std::int64_t>(detail::resumeHash(key, value)) != rows.integer(2))
      throw FileError(database.shownName(),
                      "table resume, key " + key + ": its hash does not match" + detail::kDamaged);
    state[key] = value;
  }
  return state;
}

void requireUnfinished(const Database& database, const detail::Texts& meta) {
  if (meta.count(detail::kStateKey) == 0)
    throw FileError(database.shownName(), "is a finished map, there is nothing to go on with");
}

/// Removes a file when it goes, if it is still there.
class Leftover {
 public:
  explicit Leftover(const std::string& path) : temporary_(path), path_(path) {}
  ~Leftover() { ::unlink(path_.c_str()); }
  Leftover(const Leftover&) = delete;
  Leftover& operator=(const Leftover&) = delete;

 private:
  TemporaryPath temporary_;
  std::string path_;
};

/// Gives the file `path` the name `file`, or returns false with errno. Unlike a rename, a link does
/// not replace what another process has just made; some file systems have no links.
bool giveName(const std::string& path, const std::string& file) {
  if (::link(path.c_str(), file.c_str()) == 0) return true;
  if (errno != EPERM && errno != EOPNOTSUPP && errno != ENOSYS) return false;
  if (::access(file.c_str(), F_OK) == 0) {
    errno = EEXIST;
    return false;
  }
  return ::rename(path.c_str(), file.c_str()) == 0;
}

/// Rolls back unless commit() was called.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) {
    database_.execute("BEGIN IMMEDIATE");
  }
  ~Transaction() {
    if (!done_) sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  void commit() {
    database_.execute("COMMIT");
    done_ = true;
  }

 private:
  Database& database_;
  bool done_ = false;
};

}  // namespace

class MapStore::Content {
 public:
  /// `lock` is of the same file.
  Content(const std::string& file, std::unique_ptr<detail::FileLock> lock)
      : lock_(std::move(lock)), database_(file, file, Database::Mode::ReadWrite) {
    detail::checkFormat(database_);
    // What is deleted leaves no traces: repair must not take them for rows. The log is flushed with
    // every commit. The cache is small: chunks are not read twice.
    database_.execute(
        "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA secure_delete = ON;"
        "PRAGMA cache_size = -4000; PRAGMA journal_size_limit = 0");
    meta_ = detail::readTexts(database_, "meta");
    requireUnfinished(database_, meta_);
    option_texts_ = detail::readTexts(database_, "options");
    options_ = detail::optionsOf(option_texts_, file);
    yaml_ = detail::readLabels(database_);
    labels_ = detail::labelsOf(yaml_, options_.number_of_classes, file);
    state_ = readStateOf(database_);
    readSums();
  }

  /// Throws FileError if a row of the file is not where its index has it: two chunks of one place
  /// would be added up.
  void requireSoundTrees() const {
    detail::Statement check(database_, "PRAGMA integrity_check(1)");
    if (check.step() && check.text(0) != "ok")
      throw FileError(file(), detail::printable(check.text(0)) + detail::kDamaged);
  }

  void commit(const Chunks& chunks, Voxels voxels, const std::vector<ScanRecord>& scans,
              const State& state) {
    Sums sums = sums_;
    Transaction transaction(database_);
    detail::ChunkWriter writer(database_, options_.number_of_classes, sums);
    for (const auto& [index, chunk] : chunks) writer.write(index, *chunk, voxels);
    detail::ScanWriter scan_writer(database_);
    for (; sums.scan_count < scans.size(); ++sums.scan_count)
      sums.scans +=
          scan_writer.write(static_cast<std::int64_t>(sums.scan_count) + 1, scans[sums.scan_count]);
    writeState(database_, state);
    detail::writeTotals(database_, {sums.chunk_count, sums.scan_count,
                                    detail::computeDigest(options_, sums.chunks), checksum(sums)});
    transaction.commit();
    sums_ = sums;
    state_ = state;
  }

  void writeFinished(const std::string& file, const detail::Texts& meta) const {
    OutputFile output(file);
    if (output.isDirect()) throw FileError(file, "is not a regular file; a map needs one");
    ::unlink(output.path().c_str());  // it must not exist
    Statement(database_, "VACUUM INTO ?").bind(1, output.path()).run();
    {
      Database copy(output.path(), file, Database::Mode::ReadWrite);
      copy.execute(
          "PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF; PRAGMA secure_delete = ON;"
          "BEGIN; DELETE FROM resume");
      detail::Texts finished = meta;
      finished.erase(detail::kStateKey);
      const std::string description = detail::writeDescription(copy, options_, labels_, finished);
      detail::writeTotals(
          copy, {sums_.chunk_count, sums_.scan_count, detail::computeDigest(options_, sums_.chunks),
                 detail::computeChecksum(description, sums_.scans, sums_.scan_count)});
      copy.execute("COMMIT");
      copy.close();
    }
    detail::sealPages(output.path(), file);
    output.commit();
  }

  void forEachPart(std::size_t bytes, const std::function<void(const SemanticMap&)>& visit) const {
    detail::ChunkReader reader(database_, detail::kFormatVersion, options_.number_of_classes);
    SemanticMap part(options_);
    std::size_t held = 0;
    while (reader.next()) {
      addRecord(part, reader);
      held += sizeof(Chunk) + reader.record().size();
      if (held < bytes) continue;
      visit(part);
      part.clear();
      held = 0;
    }
    if (!part.empty()) visit(part);
    if (reader.sumOfHashes() != sums_.chunks)
      throw FileError(database_.shownName(),
                      std::string("its chunks do not have its digest") + detail::kDamaged);
  }

  std::vector<ScanRecord> loadScans() const {
    std::vector<ScanRecord> scans;
    detail::ScanReader reader(database_, detail::kFormatVersion);
    for (ScanRecord scan; reader.next(scan);) scans.push_back(scan);
    return scans;
  }

  const Options& options() const { return options_; }
  const detail::Texts& meta() const { return meta_; }
  const State& state() const { return state_; }
  const Sums& sums() const { return sums_; }
  const std::string& file() const { return database_.shownName(); }
  void close() { database_.close(); }

 private:
  void addRecord(SemanticMap& map, const detail::ChunkReader& reader) const {
    try {
      map.addChunkRecord(reader.index(), reader.record().data(), reader.record().size());
    } catch (const std::runtime_error& error) {
      throw FileError(database_.shownName(), "table chunks, row " + std::to_string(reader.row()) +
                                                 ": " + error.what() + detail::kDamaged);
    }
  }

  std::string checksum(const Sums& sums) const {
    return detail::computeChecksum(detail::describe(option_texts_, yaml_, meta_), sums.scans,
                                   sums.scan_count);
  }

  void readSums() {
    for (Statement rows(database_, "SELECT hash FROM chunks"); rows.step(); ++sums_.chunk_count)
      sums_.chunks += static_cast<std::uint64_t>(rows.integer(0));
    for (Statement rows(database_, "SELECT hash FROM scans"); rows.step(); ++sums_.scan_count)
      sums_.scans += static_cast<std::uint64_t>(rows.integer(0));
    if (detail::computeDigest(options_, sums_.chunks) != meta_[detail::kDigestKey] ||
        checksum(sums_) != meta_[detail::kChecksumKey])
      throw FileError(
          database_.shownName(),
          std::string("does not have the digest and checksum that it states") + detail::kDamaged);
  }

  // The connection goes before the lock.
  std::unique_ptr<detail::FileLock> lock_;
  Database database_;
  detail::Texts meta_;
  detail::Texts option_texts_;
  Options options_;
  std::string yaml_;
  LabelSet labels_ = LabelSet::occupancy();
  State state_;
  Sums sums_;
};

MapStore::MapStore(std::unique_ptr<Content> content) : content_(std::move(content)) {}
MapStore::~MapStore() = default;

std::unique_ptr<MapStore> MapStore::create(const std::string& file, const MapDocument& start,
                                           const State& state) {
  // Made under another name, so that there is never a file that is not a map.
  const std::string path = file + ".tmp" + std::to_string(::getpid());
  const Leftover leftover(path);
  ::unlink(path.c_str());
  {
    Database database(path, file, Database::Mode::ReadWrite);
    database.reserveForSeals();
    database.execute("PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF; BEGIN");
    database.execute(detail::createTables());
    detail::Texts meta = start.meta;
    meta[detail::kStateKey] = detail::kUnfinished;
    const Options& options = start.map.options();
    const std::string description = detail::writeDescription(database, options, start.labels, meta);
    writeState(database, state);
    detail::writeTotals(database, {0, 0, detail::computeDigest(options, 0),
                                   detail::computeChecksum(description, 0, 0)});
    database.execute("COMMIT");
    database.close();
  }
  auto lock = std::make_unique<detail::FileLock>(path, file);
  if (!lock->sync())
    throw FileError(file, std::string("cannot be flushed to the disk: ") + std::strerror(errno));
  if (!giveName(path, file))
    throw FileError(file, errno == EEXIST ? "is there already, of a run that has not been finished"
                                          : std::string("cannot be made: ") + std::strerror(errno));
  return std::unique_ptr<MapStore>(new MapStore(std::make_unique<Content>(file, std::move(lock))));
}

std::unique_ptr<MapStore> MapStore::open(const std::string& file) {
  detail::requireRegularFile(file);
  auto lock = std::make_unique<detail::FileLock>(file, file);
  auto content = std::make_unique<Content>(file, std::move(lock));
  content->requireSoundTrees();
  return std::unique_ptr<MapStore>(new MapStore(std::move(content)));
}

void MapStore::commit(const Chunks& chunks, Voxels voxels, const std::vector<ScanRecord>& scans,
                      const State& state) {
  content_->commit(chunks, voxels, scans, state);
}

void MapStore::writeFinished(const std::string& file,
                             const std::map<std::string, std::string>& meta) const {
  content_->writeFinished(file, meta);
}

void MapStore::remove(std::unique_ptr<MapStore> store) {
  const std::string file = store->content_->file();
  store->content_->close();
  // While the lock is still held; the log is there only if somebody else is reading.
  for (const char* ending : {"", "-wal", "-shm"}) ::unlink((file + ending).c_str());
}

const Options& MapStore::options() const {
  return content_->options();
}
const std::map<std::string, std::string>& MapStore::meta() const {
  return content_->meta();
}
const MapStore::State& MapStore::state() const {
  return content_->state();
}
std::size_t MapStore::scanCount() const {
  return content_->sums().scan_count;
}
std::size_t MapStore::chunkCount() const {
  return content_->sums().chunk_count;
}
std::string MapStore::digest() const {
  return detail::computeDigest(content_->options(), content_->sums().chunks);
}
std::vector<ScanRecord> MapStore::loadScans() const {
  return content_->loadScans();
}
SemanticMap MapStore::loadVoxels() const {
  SemanticMap map(options());
  forEachPart(static_cast<std::size_t>(-1), [&](const SemanticMap& all) { map = all; });
  return map;
}
void MapStore::forEachPart(std::size_t bytes,
                           const std::function<void(const SemanticMap&)>& visit) const {
  content_->forEachPart(bytes, visit);
}

MapStore::State readState(const std::string& file) {
  detail::requireRegularFile(file);
  Database database(file, file, Database::Mode::ReadOnly);
  database.execute("BEGIN");
  if (detail::checkFormat(database) < 2)
    throw FileError(file, "is a finished map, there is nothing to go on with");
  requireUnfinished(database, detail::readTexts(database, "meta"));
  return readStateOf(database);
}

}  // namespace csom
