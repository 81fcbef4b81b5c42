// SPDX-License-Identifier: BSD-3-Clause
// Rows of a map file to what they mean and back.
#include "MapTables.h"

#include <csom/core/Error.h>
#include <csom/io/TextParser.h>

#include <map>
#include <set>
#include <stdexcept>

namespace csom::detail {

namespace {

std::int64_t readPragma(const Database& database, const std::string& name) {
  Statement pragma(database, "PRAGMA " + name);
  return pragma.step() ? pragma.integer(0) : 0;
}

/// A schema can do more than hold rows: views and generated columns are queries that may never end,
/// triggers change what they are not asked to. It must be the one that we write.
void checkTables(const Database& database, std::int64_t version) {
  const std::string& file = database.shownName();
  std::map<std::string, std::string> missing = makeTables(version);
  Statement objects(database,
                    "SELECT type, name, tbl_name, rootpage, coalesce(sql, '') FROM "
                    "sqlite_master");
  while (objects.step()) {
    const std::string type = objects.text(0);
    const std::string name = objects.text(1);
    const bool is_key_of_chunks =
        type == "index" && name == "sqlite_autoindex_chunks_1" && objects.text(2) == "chunks";
    if (is_key_of_chunks && objects.text(4).empty()) continue;
    const auto table = missing.find(name);
    if (table == missing.end())
      throw FileError(file, "has a " + printable(type) + " " + quoted(name) +
                                ", which is no part of a map; its tables are not those that csom "
                                "writes" +
                                kDamaged);
    if (type != "table" || objects.integer(3) <= 0 || objects.text(4) != table->second)
      throw FileError(file, "its table " + name + " is not made as csom makes it" + kDamaged);
    missing.erase(table);
  }
  if (!missing.empty()) throw FileError(file, "has no table " + missing.begin()->first + kDamaged);
}

void bindValue(Statement& statement, int parameter, double value) {
  statement.bind(parameter, value);
}
void bindValue(Statement& statement, int parameter, std::size_t value) {
  statement.bind(parameter, static_cast<std::int64_t>(value));
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

std::int32_t chunkCoordinate(std::int64_t value) {
  const auto coordinate = static_cast<std::int32_t>(value);
  if (coordinate != value)
    throw std::runtime_error("chunk index " + std::to_string(value) + " is out of range");
  return coordinate;
}

/// Without these nobody can tell what the counts of a map mean.
const std::set<std::string>& essentialOptions() {
  static const std::set<std::string> names{"resolution", "number_of_classes", "prior", "method"};
  return names;
}

}  // namespace

std::int64_t checkFormat(const Database& database) {
  const std::string& file = database.shownName();
  if (readPragma(database, "application_id") != kApplicationId)
    throw FileError(file, "is no csom map (a SQLite database of another kind)");
  const std::int64_t version = readPragma(database, "user_version");
  if (version > kFormatVersion)
    throw LaterVersionError(file, "is a map of format version " + std::to_string(version) +
                                      ", this program reads up to " +
                                      std::to_string(kFormatVersion) +
                                      "; use a newer mrpt_csom to read it");
  if (version < 1)
    throw FileError(file,
                    "has the impossible format version " + std::to_string(version) + kDamaged);
  checkTables(database, version);
  return version;
}

Texts readTexts(const Database& database, const std::string& table) {
  Texts result;
  Statement select(database, "SELECT key, value FROM " + table);
  while (select.step()) result[select.text(0)] = select.text(1);
  return result;
}

std::string readLabels(const Database& database) {
  Statement select(database, "SELECT yaml FROM labels");
  if (!select.step())
    throw FileError(database.shownName(), std::string("table labels is empty") + kDamaged);
  std::string yaml = select.text(0);
  if (select.step())
    throw FileError(database.shownName(), std::string("table labels has two rows") + kDamaged);
  return yaml;
}

Options optionsOf(const Texts& texts, const std::string& shown_name) {
  Texts unread = texts;
  Options options;
  try {
    visitOptions(options, [&](const OptionInfo& option, auto& field) {
      const auto it = unread.find(option.key);
      if (it == unread.end()) {
        // Options that came later have defaults under which older maps mean what they meant.
        if (essentialOptions().count(option.key) > 0)
          throw OptionError(std::string(option.key) + " is missing");
        return;
      }
      parse(option.key, it->second, field);
      unread.erase(it);
    });
    if (!unread.empty()) throw OptionError("unknown option " + unread.begin()->first);
    options.validate();
  } catch (const OptionError& error) {
    throw FileError(shown_name, std::string("table options: ") + error.what() + kDamaged);
  }
  return options;
}

LabelSet labelsOf(const std::string& yaml, int number_of_classes, const std::string& shown_name) {
  LabelSet labels = LabelSet::fromYaml(yaml, shown_name + ": table labels");
  if (labels.numberOfClasses() != number_of_classes)
    throw FileError(shown_name, "table labels has " + std::to_string(labels.numberOfClasses()) +
                                    " classes, the options say " +
                                    std::to_string(number_of_classes) + kDamaged);
  return labels;
}

Texts textsOf(const Options& options) {
  Texts texts;
  visitOptions(options, [&](const OptionInfo& option, const auto& field) {
    texts[option.key] = toString(field);
  });
  return texts;
}

namespace {

void writeTexts(const Database& database, const std::string& table, const Texts& texts) {
  Statement insert(database, "INSERT INTO " + table + " VALUES (?, ?)");
  for (const auto& [key, value] : texts) insert.bind(1, key).bind(2, value).run();
}

}  // namespace

std::string writeDescription(const Database& database, const Options& options,
                             const LabelSet& labels, const Texts& meta) {
  for (const char* table : {"meta", "options", "labels", "description"})
    Statement(database, std::string("DELETE FROM ") + table).run();
  Texts of_document = meta;
  of_document.erase(kDigestKey);
  of_document.erase(kChecksumKey);
  writeTexts(database, "meta", of_document);
  writeTexts(database, "options", textsOf(options));
  const std::string yaml = labels.toYaml();
  Statement(database, "INSERT INTO labels VALUES (?)").bind(1, yaml).run();
  std::string bytes = describe(textsOf(options), yaml, of_document);
  Statement insert(database, "INSERT INTO description VALUES (?, ?)");
  insert.bind(1, static_cast<std::int64_t>(computeHash(bytes.data(), bytes.size())));
  insert.bindBlob(2, bytes.data(), bytes.size()).run();
  return bytes;
}

void writeTotals(const Database& database, const Totals& totals) {
  Statement meta(database, "INSERT OR REPLACE INTO meta VALUES (?, ?)");
  meta.bind(1, kDigestKey).bind(2, totals.digest).run();
  meta.bind(1, kChecksumKey).bind(2, totals.checksum).run();
  Statement(database, "DELETE FROM totals").run();
  Statement insert(database, "INSERT INTO totals VALUES (?, ?, ?, ?, ?)");
  insert.bind(1, static_cast<std::int64_t>(totals.chunks));
  insert.bind(2, static_cast<std::int64_t>(totals.scans));
  insert.bind(3, totals.digest).bind(4, totals.checksum);
  insert.bind(5, static_cast<std::int64_t>(totalsHash(totals))).run();
}

namespace {

std::string insertionOfScans() {
  const std::string columns = scanColumns();
  std::string parameters = "?, ?, ?";  // id, hash, and one more than there are commas
  for (const char c : columns)
    if (c == ',') parameters += ", ?";
  return "INSERT INTO scans (id, " + columns + ", hash) VALUES (" + parameters + ")";
}

}  // namespace

ScanWriter::ScanWriter(const Database& database) : insert_(database, insertionOfScans()) {}

std::uint64_t ScanWriter::write(std::int64_t id, const ScanRecord& scan) {
  const std::uint64_t hash = scanHash(id, scan);
  int parameter = 0;
  insert_.bind(++parameter, id);
  insert_.bind(++parameter, scan.timestamp);
  insert_.bind(++parameter, scan.sensor_label);
  insert_.bind(++parameter, scan.observation_class);
  for (const double coordinate : scan.origin) insert_.bind(++parameter, coordinate);
  visitReport(scan.report, [&](const std::string&, const auto& field) {
    bindValue(insert_, ++parameter, field);
  });
  insert_.bind(++parameter, static_cast<std::int64_t>(hash)).run();
  return hash;
}

ScanReader::ScanReader(const Database& database, std::int64_t version)
    : database_(database),
      row_(database, "SELECT id, " + scanColumns() + (version >= 2 ? ", hash" : "") +
                         " FROM scans ORDER BY id"),
      hashed_(version >= 2) {}

bool ScanReader::next(ScanRecord& scan) {
  if (!step()) return false;
  read(scan);
  return true;
}

void ScanReader::read(ScanRecord& scan) {
  int column = 0;
  id_ = row_.integer(column++);
  scan.timestamp = row_.real(column++);
  scan.sensor_label = row_.text(column++);
  scan.observation_class = row_.text(column++);
  for (double& coordinate : scan.origin) coordinate = row_.real(column++);
  visitReport(scan.report, [&](const std::string& name, auto& field) {
    readValue(database_, row_, column++, name, field);
  });
  if (!hashed_) return;
  const std::uint64_t hash = scanHash(id_, scan);
  if (static_cast<std::int64_t>(hash) != row_.integer(column))
    throw FileError(database_.shownName(), "table scans, row " + std::to_string(row_.row()) +
                                               ": its hash does not match" + kDamaged);
  sum_ += hash;
}

std::size_t maxRecordSize(int number_of_classes) {
  constexpr std::size_t voxels = kVoxelsPerChunk;
  const std::size_t entries = voxels * static_cast<std::size_t>(number_of_classes);
  return sizeof(Chunk::Header) + 5 * entries + 2 * voxels + 8;
}

ChunkReader::ChunkReader(const Database& database, std::int64_t version, int number_of_classes)
    : database_(database),
      row_(database, "SELECT x, y, z, hash, record FROM chunks"),
      version_(version),
      max_size_(maxRecordSize(number_of_classes)) {}

bool ChunkReader::next() {
  if (!step()) return false;
  read();
  return true;
}

void ChunkReader::read() {
  explainedAt(database_.shownName(), "table chunks, row " + std::to_string(row_.row()),
              [this] { parse(); });
}

void ChunkReader::parse() {
  index_ = {chunkCoordinate(row_.integer(0)), chunkCoordinate(row_.integer(1)),
            chunkCoordinate(row_.integer(2))};
  record_ = codec_.decompress(row_.blob(4), max_size_);
  const std::uint64_t hash = version_ >= 2 ? chunkHash(index_, record_.data(), record_.size())
                                           : computeHash(record_.data(), record_.size());
  if (static_cast<std::int64_t>(hash) != row_.integer(3))
    throw std::runtime_error("its hash does not match");
  sum_ += hash;
}

}  // namespace csom::detail
