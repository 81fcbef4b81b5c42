// SPDX-License-Identifier: BSD-3-Clause
// What is different in map files of format version 1.
#include "MapVersion1.h"

#include "MapSchema.h"

namespace csom::detail::version1 {

std::string digestOf(const SemanticMap& map) {
  Hasher hasher;
  hasher.add(map.options().resolution);
  hasher.add(static_cast<std::int32_t>(map.options().number_of_classes));
  hasher.add(map.options().prior);
  for (const auto& [index, chunk] : map.chunks().sorted()) {
    hasher.add(index.x);
    hasher.add(index.y);
    hasher.add(index.z);
    hasher.add(chunk->record(), chunk->recordSize());
  }
  return hexadecimal(hasher.value());
}

std::string checksumOf(const MapDocument& document, const Texts& options) {
  Hasher hasher;
  visitOptions(document.map.options(),
               [&](const char* name, const auto& field, const char*, const char*) {
                 if (options.count(name) == 0) return;
                 hasher.add(std::string(name));
                 hasher.add(toString(field));
               });
  hasher.add(document.labels.toYaml());
  for (const auto& [key, value] : document.meta) {
    if (key == kDigestKey || key == kChecksumKey) continue;
    hasher.add(key);
    hasher.add(value);
  }
  for (const ScanRecord& scan : document.scans) {
    hasher.add(scan.timestamp);
    hasher.add(scan.sensor_label);
    hasher.add(scan.observation_class);
    for (const double coordinate : scan.origin) hasher.add(coordinate);
    visitReport(scan.report, [&](const std::string&, const auto& field) { hasher.add(field); });
  }
  return hexadecimal(hasher.value());
}

}  // namespace csom::detail::version1

namespace csom {

std::string mapDigestOfVersion1(const SemanticMap& map) {
  return detail::version1::digestOf(map);
}

}  // namespace csom
