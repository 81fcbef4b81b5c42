// SPDX-License-Identifier: BSD-3-Clause
// The tables of a map file, as docs/file-format.md describes them.
#pragma once

#include <csom/core/Error.h>
#include <csom/io/MapFile.h>

#include <cstdint>
#include <map>
#include <string>

namespace csom::detail {

/// "CSOM": what the program `file` and ourselves know a map by.
constexpr std::int64_t kApplicationId = 0x43534f4d;
/// To be raised with every change that an older reader would misunderstand.
constexpr std::int64_t kFormatVersion = 2;
/// The key of `meta` that holds mapDigest() of the map; it is the file's, not the document's.
constexpr const char* kDigestKey = "digest";
/// The key of `meta` that holds the checksum of everything else.
constexpr const char* kChecksumKey = "checksum";
/// The key of `meta` that says that a file is still being written. A finished one has no such key.
constexpr const char* kStateKey = "state";
constexpr const char* kUnfinished = "unfinished";

/// At the end of what an error says about a file that is not as it was written.
constexpr const char* kDamaged = "; the file is damaged, csom repair saves what is intact";

/// A map of a format that this program does not know yet.
class LaterVersionError : public FileError {
 public:
  using FileError::FileError;
};

/// "timestamp, sensor_label, …": the columns of `scans` between its key and its hash, in order.
/// Those of the report are named and ordered as visitReport() does it.
std::string scanColumns();
/// The statements that make an empty map file.
std::string createTables();
/// The tables of a file of this version, each with the statement that made it: all that its schema
/// may hold, but for the index of the primary key of `chunks`. A file is read if its schema is this
/// one to the letter, so a statement that has been released stays as it is.
std::map<std::string, std::string> makeTables(std::int64_t version);

}  // namespace csom::detail
