// SPDX-License-Identifier: BSD-3-Clause
// The hashes of a map file, as docs/file-format.md describes them.
#include "MapHashes.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <new>
#include <stdexcept>

#include "MapSchema.h"

namespace csom {
namespace detail {

Hasher::Hasher() : state_(XXH3_createState()) {
  if (!state_) throw std::bad_alloc();
  XXH3_64bits_reset(state_.get());
}

void Hasher::Deleter::operator()(XXH3_state_t* state) const {
  XXH3_freeState(state);
}

void Hasher::add(const void* bytes, std::size_t size) {
  XXH3_64bits_update(state_.get(), bytes, size);
}

void Hasher::add(const std::string& text) {
  add(static_cast<std::uint64_t>(text.size()));
  add(text.data(), text.size());
}

std::uint64_t Hasher::value() const {
  return XXH3_64bits_digest(state_.get());
}

std::uint64_t computeHash(const void* bytes, std::size_t size) {
  return XXH3_64bits(bytes, size);
}

std::string hexadecimal(std::uint64_t hash) {
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(hash));
  return digits.data();
}

std::uint64_t chunkHash(const ChunkIndex& index, const void* record, std::size_t size) {
  std::array<std::int32_t, 3> place{index.x, index.y, index.z};
  // The place is hashed into the seed: one call for all of the content.
  return XXH3_64bits_withSeed(record, size, XXH3_64bits(place.data(), sizeof place));
}

namespace {

/// SQLite keeps that a number is NaN, not which.
double canonical(double number) {
  return std::isnan(number) ? std::numeric_limits<double>::quiet_NaN() : number;
}
std::size_t canonical(std::size_t number) {
  return number;
}

}  // namespace

std::uint64_t scanHash(std::int64_t id, const ScanRecord& scan) {
  Hasher hasher;
  hasher.add(id);
  hasher.add(canonical(scan.timestamp));
  hasher.add(scan.sensor_label);
  hasher.add(scan.observation_class);
  for (const double coordinate : scan.origin) hasher.add(canonical(coordinate));
  visitReport(scan.report,
              [&](const std::string&, const auto& field) { hasher.add(canonical(field)); });
  return hasher.value();
}

std::uint64_t resumeHash(const std::string& key, std::string_view value) {
  return XXH3_64bits_withSeed(value.data(), value.size(), computeHash(key.data(), key.size()));
}

std::string computeDigest(const Options& options, std::uint64_t sum_of_chunk_hashes) {
  Hasher hasher;
  hasher.add(options.resolution);
  hasher.add(static_cast<std::int32_t>(options.number_of_classes));
  hasher.add(options.prior);
  hasher.add(sum_of_chunk_hashes);
  return hexadecimal(hasher.value());
}

namespace {

void append(std::string& bytes, std::uint64_t number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

void append(std::string& bytes, const std::string& text) {
  append(bytes, static_cast<std::uint64_t>(text.size()));
  bytes += text;
}

void append(std::string& bytes, const Texts& texts) {
  append(bytes, static_cast<std::uint64_t>(texts.size()));
  for (const auto& [key, value] : texts) {
    append(bytes, key);
    append(bytes, value);
  }
}

/// Takes from the front of what is left; a length is believed only if so much is there.
class DescriptionParser {
 public:
  explicit DescriptionParser(std::string_view bytes) : left_(bytes) {}

  std::uint64_t number() {
    std::uint64_t value = 0;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::string text() { return std::string(take(number())); }
  Texts texts() {
    Texts result;
    for (std::uint64_t left = number(); left > 0; --left) {
      const std::string key = text();
      result[key] = text();
    }
    return result;
  }

 private:
  std::string_view take(std::uint64_t size) {
    if (size > left_.size()) throw std::runtime_error("the description ends too early");
    const std::string_view taken = left_.substr(0, static_cast<std::size_t>(size));
    left_.remove_prefix(taken.size());
    return taken;
  }
  std::string_view left_;
};

}  // namespace

std::string describe(const Texts& options, const std::string& labels, const Texts& meta) {
  Texts covered = meta;
  covered.erase(kDigestKey);
  covered.erase(kChecksumKey);
  std::string bytes;
  append(bytes, options);
  append(bytes, labels);
  append(bytes, covered);
  return bytes;
}

Description parseDescription(std::string_view bytes) {
  DescriptionParser parser(bytes);
  Description description;
  description.options = parser.texts();
  description.labels = parser.text();
  description.meta = parser.texts();
  return description;
}

std::string computeChecksum(const std::string& description, std::uint64_t sum_of_scan_hashes,
                            std::size_t scans) {
  Hasher hasher;
  hasher.add(description);
  hasher.add(sum_of_scan_hashes);
  hasher.add(static_cast<std::uint64_t>(scans));
  return hexadecimal(hasher.value());
}

std::uint64_t totalsHash(const Totals& totals) {
  Hasher hasher;
  hasher.add(totals.chunks);
  hasher.add(totals.scans);
  hasher.add(totals.digest);
  hasher.add(totals.checksum);
  return hasher.value();
}

}  // namespace detail

std::string mapDigest(const SemanticMap& map) {
  std::uint64_t sum = 0;
  map.chunks().forEach([&](const ChunkIndex& index, const Chunk& chunk) {
    sum += detail::chunkHash(index, chunk.record(), chunk.recordSize());
  });
  return detail::computeDigest(map.options(), sum);
}

}  // namespace csom
