// SPDX-License-Identifier: BSD-3-Clause
// The rows that lie in the pages of a SQLite file, found without its trees. The format is described
// in https://www.sqlite.org/fileformat2.html; every length is checked before it is believed.
#include "TableRows.h"

#include <csom/core/Error.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>

#include "PageSeals.h"

namespace csom::detail {

namespace {

constexpr std::size_t kUsable = kPageSize - kSealSize;
constexpr std::size_t kDatabaseHeader = 100;
constexpr std::size_t kLeafHeader = 8;
using Page = std::array<unsigned char, kPageSize>;

class PageFile {
 public:
  explicit PageFile(const std::string& file) : stream_(file, std::ios::binary) {
    if (!stream_) throw FileError(file, std::string("cannot be read: ") + std::strerror(errno));
    stream_.seekg(0, std::ios::end);
    pages_ = static_cast<std::uint64_t>(stream_.tellg()) / kPageSize;
    chained_left_ = kMaxChained * pages_;
  }
  /// `number` from 1. False if there is no such page.
  bool read(std::uint64_t number, Page& page) {
    if (number < 1 || number > pages_) return false;
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>((number - 1) * kPageSize));
    return static_cast<bool>(stream_.read(reinterpret_cast<char*>(page.data()), kPageSize));
  }
  /// The same for a page that another one names as its continuation. Each belongs to one row, so in
  /// all no more than some times their number are read: chains that were made to meet or to go in
  /// circles must not cost a day.
  bool readChained(std::uint64_t number, Page& page) {
    if (chained_left_ == 0) return false;
    --chained_left_;
    return read(number, page);
  }

 private:
  /// What is no row may look like the beginning of one, and then has a continuation as well.
  static constexpr std::uint64_t kMaxChained = 64;

  std::ifstream stream_;
  std::uint64_t pages_ = 0;
  std::uint64_t chained_left_ = 0;
};

std::uint64_t bigEndian(const unsigned char* bytes, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8U | bytes[i];
  return value;
}

/// Takes numbers of variable length from the front of bytes.
class Varints {
 public:
  Varints(const unsigned char* begin, const unsigned char* end) : at_(begin), end_(end) {}
  std::optional<std::uint64_t> next() {
    std::uint64_t value = 0;
    for (int i = 0; i < 9 && at_ < end_; ++i) {
      const unsigned char byte = *at_++;
      if (i == 8) return value << 8U | byte;
      value = value << 7U | (byte & 0x7fU);
      if ((byte & 0x80U) == 0) return value;
    }
    return std::nullopt;
  }
  const unsigned char* at() const { return at_; }

 private:
  const unsigned char* at_;
  const unsigned char* end_;
};

/// How many bytes of a row of `size` lie in its own page; the others lie in a chain of pages.
std::size_t localBytes(std::size_t size) {
  constexpr std::size_t kMax = kUsable - 35;
  constexpr std::size_t kMin = (kUsable - 12) * 32 / 255 - 23;
  if (size <= kMax) return size;
  const std::size_t rest = kMin + (size - kMin) % (kUsable - 4);
  return rest <= kMax ? rest : kMin;
}

/// The bytes of the row that a cell begins.
std::optional<std::string> payloadOf(PageFile& file, const unsigned char* begin,
                                     const unsigned char* end, std::size_t size) {
  std::size_t local = localBytes(size);
  if (static_cast<std::size_t>(end - begin) < local + (local < size ? 4 : 0)) return std::nullopt;
  std::string bytes(reinterpret_cast<const char*>(begin), local);
  std::uint64_t next = local < size ? bigEndian(begin + local, 4) : 0;
  for (Page page; bytes.size() < size;) {
    if (!file.readChained(next, page)) return std::nullopt;
    next = bigEndian(page.data(), 4);
    bytes.append(reinterpret_cast<const char*>(page.data()) + 4,
                 std::min(size - bytes.size(), kUsable - 4));
  }
  return bytes;
}

/// Bytes of a value of this type; nothing if there is no such type.
std::optional<std::size_t> sizeOf(std::uint64_t type, std::size_t most) {
  constexpr std::array<std::size_t, 10> kSizes{0, 1, 2, 3, 4, 6, 8, 8, 0, 0};
  if (type < kSizes.size()) return kSizes[type];
  if (type < 12 || (type - 12) / 2 > most) return std::nullopt;
  return static_cast<std::size_t>((type - 12) / 2);
}

RowValue valueOf(std::uint64_t type, const unsigned char* bytes, std::size_t size) {
  RowValue value;
  if (type == 0) return value;
  if (type >= 12) {
    value.kind = RowValue::Kind::Bytes;
    value.bytes.assign(reinterpret_cast<const char*>(bytes), size);
    return value;
  }
  std::uint64_t bits = bigEndian(bytes, size);
  if (type == 7) {
    value.kind = RowValue::Kind::Real;
    std::memcpy(&value.real, &bits, sizeof bits);
    return value;
  }
  value.kind = RowValue::Kind::Integer;
  const bool negative = size > 0 && size < 8 && (bytes[0] & 0x80U) != 0;
  if (negative) bits |= ~std::uint64_t{0} << (8 * size);
  value.integer = type >= 8 ? static_cast<std::int64_t>(type - 8) : static_cast<std::int64_t>(bits);
  return value;
}

std::optional<TableRow> parseRow(const std::string& payload) {
  constexpr std::size_t kMaxColumns = 64;
  const auto* const begin = reinterpret_cast<const unsigned char*>(payload.data());
  const unsigned char* const end = begin + payload.size();
  Varints header(begin, end);
  const auto header_size = header.next();
  if (!header_size || *header_size > payload.size()) return std::nullopt;
  const unsigned char* const body = begin + *header_size;
  Varints types(header.at(), body);
  TableRow row;
  const unsigned char* at = body;
  while (types.at() < body) {
    const auto type = types.next();
    const auto left = static_cast<std::size_t>(end - at);
    const auto size = type ? sizeOf(*type, left) : std::nullopt;
    if (!size || *size > left || row.size() == kMaxColumns) return std::nullopt;
    row.push_back(valueOf(*type, at, *size));
    at += *size;
  }
  if (at != end) return std::nullopt;
  return row;
}

}  // namespace

void forEachTableRow(const std::string& file, std::size_t max_bytes,
                     const std::function<void(std::int64_t, const TableRow&)>& visit) {
  PageFile pages(file);
  Page page;
  for (std::uint64_t number = 1; pages.read(number, page); ++number) {
    // Neither the kind of the page nor its number of rows is believed: that byte may be the damage.
    const std::size_t pointers = (number == 1 ? kDatabaseHeader : 0) + kLeafHeader;
    const unsigned char* const end = page.data() + kUsable;
    for (std::size_t at = pointers; at + 2 <= kUsable; at += 2) {
      const std::size_t cell = bigEndian(page.data() + at, 2);
      if (cell < at || cell >= kUsable) continue;
      Varints varints(page.data() + cell, end);
      const auto size = varints.next();
      const auto id = varints.next();
      if (!size || !id || *size < 2 || *size > max_bytes) continue;
      const auto payload = payloadOf(pages, varints.at(), end, static_cast<std::size_t>(*size));
      if (!payload) continue;
      if (const auto row = parseRow(*payload)) visit(static_cast<std::int64_t>(*id), *row);
    }
  }
}

}  // namespace csom::detail
