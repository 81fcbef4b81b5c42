// SPDX-License-Identifier: BSD-3-Clause
// What is different in map files of format version 1.
#include "MapVersion1.h"

#include "MapSchema.h"
#include "MapTables.h"

namespace csom::detail::version1 {

namespace {

/// The options as they followed each other in that version's checksum.
constexpr const char* kOptionsInOrder[] = {"resolution",
                                           "number_of_classes",
                                           "unlabelled_class_id",
                                           "block_depth",
                                           "method",
                                           "rvfm",
                                           "aklm",
                                           "kernel",
                                           "neighbourhood",
                                           "ds_resolution",
                                           "min_range",
                                           "max_range",
                                           "free_space",
                                           "free_resolution",
                                           "free_weight",
                                           "context_weight_self",
                                           "context_weight_neighbour",
                                           "context_threshold",
                                           "context_neighbours",
                                           "kernel_length_min",
                                           "kernel_length_max",
                                           "kernel_length",
                                           "kernel_scale",
                                           "surface_planes",
                                           "surface_neighbours",
                                           "surface_reach",
                                           "surface_gap",
                                           "surface_thickness",
                                           "surface_support",
                                           "surface_hit_weight",
                                           "surface_free_limit",
                                           "counter_evidence",
                                           "prior",
                                           "threads"};

}  // namespace

std::string computeDigest(const SemanticMap& map) {
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

std::string computeChecksum(const MapDocument& document, const Texts& options) {
  Hasher hasher;
  const Texts texts = textsOf(document.map.options());
  for (const char* key : kOptionsInOrder) {
    if (options.count(key) == 0) continue;
    hasher.add(std::string(key));
    hasher.add(texts.at(key));
  }
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
  return detail::version1::computeDigest(map);
}

}  // namespace csom
