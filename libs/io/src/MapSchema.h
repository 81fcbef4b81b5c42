// SPDX-License-Identifier: BSD-3-Clause
// The tables of a map file, as docs/file-format.md describes them.
#pragma once

#include <csom/io/MapFile.h>

#include <cstdint>
#include <string>

namespace csom::detail {

/// "CSOM": what the program `file` and ourselves know a map by.
constexpr std::int64_t kApplicationId = 0x43534f4d;
/// To be raised with every change that an older reader would misunderstand.
constexpr std::int64_t kFormatVersion = 1;
/// The key of `meta` that holds mapDigest() of the map; it is the file's, not the document's.
constexpr const char* kDigestKey = "digest";
/// The key of `meta` that holds descriptionChecksum().
constexpr const char* kChecksumKey = "checksum";

/// Hash over all that a file holds beside its chunks: options, label set, scans and the other keys
/// of `meta`. 16 hexadecimal digits.
std::string descriptionChecksum(const MapDocument& document);

/// "timestamp, sensor_label, …": the columns of `scans` besides its key, in order. Those of the
/// report are named and ordered as visitReport() does it.
std::string scanColumns();
/// The statements that make an empty map file.
std::string createTables();

}  // namespace csom::detail
