// SPDX-License-Identifier: BSD-3-Clause
// Hashes over a map and over what a file says of it.
#include <csom/io/MapFile.h>
#include <xxhash.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <new>

#include "MapSchema.h"

namespace csom {

namespace {

/// XXH3 over a sequence of pieces.
class Hasher {
 public:
  Hasher() : state_(XXH3_createState(), &XXH3_freeState) {
    if (!state_) throw std::bad_alloc();
    XXH3_64bits_reset(state_.get());
  }
  void add(const void* bytes, std::size_t size) { XXH3_64bits_update(state_.get(), bytes, size); }
  template <class Number>
  void add(Number number) {
    add(&number, sizeof number);
  }
  void add(const std::string& text) {
    add(static_cast<std::uint64_t>(text.size()));
    add(text.data(), text.size());
  }
  /// 16 hexadecimal digits.
  std::string text() const {
    std::array<char, 17> digits{};
    std::snprintf(digits.data(), digits.size(), "%016llx",
                  static_cast<unsigned long long>(XXH3_64bits_digest(state_.get())));
    return digits.data();
  }

 private:
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

}  // namespace

std::string mapDigest(const SemanticMap& map) {
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
  return hasher.text();
}

std::string detail::descriptionChecksum(const MapDocument& document) {
  Hasher hasher;
  visitOptions(document.map.options(),
               [&](const char* name, const auto& field, const char*, const char*) {
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
  return hasher.text();
}

}  // namespace csom
