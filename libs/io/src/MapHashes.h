// SPDX-License-Identifier: BSD-3-Clause
// The hashes of a map file, as docs/file-format.md describes them.
#pragma once

#include <csom/core/Options.h>
#include <csom/core/SemanticMap.h>
#include <csom/io/MapFile.h>
#include <xxhash.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace csom::detail {

/// XXH3 (64 bits) over a sequence of pieces.
class Hasher {
 public:
  Hasher();
  void add(const void* bytes, std::size_t size);
  template <class Number>
  void add(Number number) {
    add(&number, sizeof number);
  }
  void add(const std::string& text);
  std::uint64_t value() const;

 private:
  struct Deleter {
    void operator()(XXH3_state_t* state) const;
  };
  std::unique_ptr<XXH3_state_t, Deleter> state_;
};

/// XXH3 (64 bits) of the bytes.
std::uint64_t computeHash(const void* bytes, std::size_t size);
/// 16 hexadecimal digits.
std::string hexadecimal(std::uint64_t hash);

/// Of a row of `chunks`: its place and its content.
std::uint64_t chunkHash(const ChunkIndex& index, const void* record, std::size_t size);
/// Of a row of `scans`.
std::uint64_t scanHash(std::int64_t id, const ScanRecord& scan);

/// Of a row of `resume`.
std::uint64_t resumeHash(const std::string& key, std::string_view value);

/// The digest of a map whose chunks have hashes of this sum. A sum of hashes depends on no order
/// and is kept up to date by the difference of what changes.
std::string computeDigest(const Options& options, std::uint64_t sum_of_chunk_hashes);

/// The rows of a table of two columns.
using Texts = std::map<std::string, std::string>;

/// All that a file says beside chunks and scans, in a row of bytes: what the checksum covers, and
/// what repair finds where the tables themselves are damaged. Digest and checksum are left out.
std::string describe(const Texts& options, const std::string& labels, const Texts& meta);
/// What describe() has put together.
struct Description {
  Texts options;
  std::string labels;
  Texts meta;
};
/// The inverse of describe(). Throws std::runtime_error if the bytes are no such description.
Description parseDescription(std::string_view bytes);

std::string computeChecksum(const std::string& description, std::uint64_t sum_of_scan_hashes,
                            std::size_t scans);

/// What a file says of itself as a whole.
struct Totals {
  std::uint64_t chunks = 0;
  std::uint64_t scans = 0;
  std::string digest;
  std::string checksum;
};
/// Of the row of `totals`.
std::uint64_t totalsHash(const Totals& totals);

}  // namespace csom::detail
