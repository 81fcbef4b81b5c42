// SPDX-License-Identifier: BSD-3-Clause
// Whether the write-ahead log beside a map file is whole. The format is described in
// https://www.sqlite.org/fileformat2.html#walformat; numbers are big-endian.
#include "WriteAheadLog.h"

#include <csom/io/InputFile.h>

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace csom::detail {

namespace {

constexpr std::size_t kHeader = 32;
constexpr std::size_t kFrameHeader = 24;
constexpr std::uint32_t kMagic = 0x377f0682;  // and one more if checksums are of big-endian words

std::uint32_t bigEndianAt(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i)
    number = number << 8U | static_cast<unsigned char>(bytes[at + i]);
  return number;
}

/// The sum that each frame carries of all before it.
class Checksum {
 public:
  explicit Checksum(bool big_endian) : big_endian_(big_endian) {}

  void add(std::string_view bytes) {
    for (std::size_t at = 0; at + 8 <= bytes.size(); at += 8) {
      first_ += word(bytes, at) + second_;
      second_ += word(bytes, at + 4) + first_;
    }
  }
  bool isAt(std::string_view bytes, std::size_t at) const {
    return bigEndianAt(bytes, at) == first_ && bigEndianAt(bytes, at + 4) == second_;
  }

 private:
  std::uint32_t word(std::string_view bytes, std::size_t at) const {
    const std::uint32_t number = bigEndianAt(bytes, at);
    return big_endian_ ? number : __builtin_bswap32(number);
  }

  bool big_endian_;
  std::uint32_t first_ = 0;
  std::uint32_t second_ = 0;
};

}  // namespace

std::string damageOfLog(const std::string& log) {
  const std::string text = readFile(log);
  const std::string_view bytes = text;
  if (bytes.empty()) return "";
  if (bytes.size() < kHeader) return "its header is cut off";
  const std::uint32_t magic = bigEndianAt(bytes, 0);
  Checksum checksum(magic == kMagic + 1);
  checksum.add(bytes.substr(0, 24));
  if ((magic != kMagic && magic != kMagic + 1) || !checksum.isAt(bytes, 24))
    return "its header is damaged";
  const std::size_t page = bigEndianAt(bytes, 8);
  const std::string_view salt = bytes.substr(16, 8);
  std::size_t number = 0;
  std::size_t last_whole = 0;
  bool committed = true;
  for (std::size_t at = kHeader; at + kFrameHeader + page <= bytes.size();
       at += kFrameHeader + page) {
    ++number;
    // Frames of another salt are left from an earlier use of the file, and lie behind all others.
    if (bytes.substr(at + 8, 8) != salt) continue;
    checksum.add(bytes.substr(at, 8));
    checksum.add(bytes.substr(at + kFrameHeader, page));
    if (number != last_whole + 1 || !checksum.isAt(bytes, at + 16))
      return "its frame " + std::to_string(last_whole + 1) + " is damaged";
    last_whole = number;
    committed = bigEndianAt(bytes, at + 4) != 0;
  }
  return committed ? "" : "it ends in the middle of a commit";
}

}  // namespace csom::detail
