// SPDX-License-Identifier: BSD-3-Clause
// Rows of a map file to what they mean and back.
#pragma once

#include <csom/core/SemanticMap.h>
#include <csom/io/MapFile.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ChunkCodec.h"
#include "MapHashes.h"
#include "MapSchema.h"
#include "Sqlite.h"

namespace csom::detail {

/// Throws FileError if the database is no map file of a version that we read, or lacks a table.
/// Returns its version.
std::int64_t checkFormat(const Database& database);

/// The rows of meta, options (tables of `key` and `value`).
Texts readTexts(const Database& database, const std::string& table);
std::string readLabels(const Database& database);
/// Throws FileError. What an older file lacks has its default.
Options optionsOf(const Texts& texts, const std::string& shown_name);
/// Throws FileError.
LabelSet labelsOf(const std::string& yaml, int number_of_classes, const std::string& shown_name);
Texts textsOf(const Options& options);

/// Calls action(), and gives what it throws a place in a file, unless it is an Error, which has
/// one.
template <class Action>
void explainedAt(const std::string& file, const std::string& place, const Action& action) {
  try {
    action();
  } catch (const Error&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw FileError(file, place + ": " + error.what() + kDamaged);
  }
}

/// Writes options, labels and meta with the copy of them that repair reads; `meta` replaces what
/// there is. Returns the bytes of describe().
std::string writeDescription(const Database& database, const Options& options,
                             const LabelSet& labels, const Texts& meta);
/// To be written with everything that changes it: into meta, and into a table of its own that
/// repair finds by its hash.
void writeTotals(const Database& database, const Totals& totals);

class ScanWriter {
 public:
  explicit ScanWriter(const Database& database);
  /// Returns the hash of the row.
  std::uint64_t write(std::int64_t id, const ScanRecord& scan);

 private:
  Statement insert_;
};

/// The scans of a file in order, each checked against its hash.
class ScanReader {
 public:
  ScanReader(const Database& database, std::int64_t version);
  /// False behind the last. Throws FileError.
  bool next(ScanRecord& scan);
  /// The same in two steps. After step() has thrown there is no next row; after read() there is.
  bool step() { return row_.step(); }
  void read(ScanRecord& scan);
  std::int64_t id() const { return id_; }
  /// Of the rows so far.
  std::uint64_t sumOfHashes() const { return sum_; }

 private:
  const Database& database_;
  Statement row_;
  bool hashed_;
  std::int64_t id_ = 0;
  std::uint64_t sum_ = 0;
};

/// The largest record that a chunk can have.
std::size_t maxRecordSize(int number_of_classes);

/// The chunks of a file one after the other.
class ChunkReader {
 public:
  ChunkReader(const Database& database, std::int64_t version, int number_of_classes);
  /// False behind the last. Throws FileError for a row that is damaged.
  bool next();
  /// The same in two steps. After step() has thrown there is no next row; after read() there is.
  bool step() { return row_.step(); }
  void read();
  const ChunkIndex& index() const { return index_; }
  /// Of the row at hand, checked against its hash. Valid until next().
  std::string_view record() const { return record_; }
  std::int64_t row() const { return row_.row(); }
  std::uint64_t sumOfHashes() const { return sum_; }

 private:
  void parse();

  const Database& database_;
  Statement row_;
  ChunkCodec codec_;
  std::int64_t version_;
  std::size_t max_size_;
  ChunkIndex index_;
  std::string_view record_;
  std::uint64_t sum_ = 0;
};

}  // namespace csom::detail
