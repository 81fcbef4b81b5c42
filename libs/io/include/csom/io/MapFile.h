// SPDX-License-Identifier: BSD-3-Clause
// The `.csom` map file: a SQLite database, documented in docs/file-format.md.
#pragma once

#include <csom/core/SemanticMap.h>
#include <csom/io/LabelSet.h>

#include <array>
#include <map>
#include <string>
#include <vector>

namespace csom {

/// One observation that was inserted, as the table `scans` keeps it.
struct ScanRecord {
  double timestamp = 0;  ///< seconds since 1970 (UTC); 0 if unknown
  std::string sensor_label;
  std::string observation_class;          ///< "CObservationVelodyneScan", …
  std::array<double, 3> origin{0, 0, 0};  ///< sensor position in the map frame [m]
  ScanReport report;
};

/// All that a map file holds. The map has as many classes as `labels`.
struct MapDocument {
  SemanticMap map{Options{}};
  LabelSet labels = LabelSet::occupancy();
  std::vector<ScanRecord> scans;
  /// Free-form provenance: "created_by", "command", "rawlog", … ("digest" is the file's own.)
  std::map<std::string, std::string> meta;
};

/// Writes `document` to `file`, in the present version of the format: to a temporary file beside it
/// first, which then replaces it, so that `file` is never half written. Throws FileError;
/// std::invalid_argument if the map and the label set have different numbers of classes.
void saveMap(const MapDocument& document, const std::string& file);

/// Reads this and all earlier versions. Checks everything: every chunk and scan against its hash,
/// the whole against the map's digest. Throws FileError naming the table and row if `file` is no
/// map, a damaged one, or of a later version. A map that is still being written is read as it was
/// committed last, and has the key `state` in its meta.
MapDocument loadMap(const std::string& file);

/// Hash over resolution, classes, prior and all chunk records, in whatever order: equal for equal
/// maps, however they were made. 16 hexadecimal digits (XXH3, 64 bits).
std::string mapDigest(const SemanticMap& map);
/// The same as files of version 1 have it, and what was written beside them.
std::string mapDigestOfVersion1(const SemanticMap& map);

}  // namespace csom
