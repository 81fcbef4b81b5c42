// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/io/InputFile.h>
#include <csom/io/PcdReader.h>
#include <csom/io/TextParser.h>
#include <lzf.h>

#include <cmath>
#include <cstring>

#include "PcdHeader.h"

namespace csom {

namespace {

using detail::PcdField;
using detail::PcdHeader;

template <class Number>
double numberAt(const char* bytes) {
  static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "binary PCD files are little-endian");
  Number value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

/// One value of a binary point. 64-bit integers lose what a double cannot hold, which neither
/// coordinates nor labels need.
double binaryValue(const PcdField& field, const char* point) {
  const char* bytes = point + field.offset;
  switch (field.type) {
    case 'F':
      return field.size == 4 ? numberAt<float>(bytes) : numberAt<double>(bytes);
    case 'U':
      switch (field.size) {
        case 1:
          return numberAt<std::uint8_t>(bytes);
        case 2:
          return numberAt<std::uint16_t>(bytes);
        case 4:
          return numberAt<std::uint32_t>(bytes);
        default:
          return numberAt<std::uint64_t>(bytes);
      }
    default:
      switch (field.size) {
        case 1:
          return numberAt<std::int8_t>(bytes);
        case 2:
          return numberAt<std::int16_t>(bytes);
        case 4:
          return numberAt<std::int32_t>(bytes);
        default:
          return numberAt<std::int64_t>(bytes);
      }
  }
}

/// Collects the points of one file.
class CloudBuilder {
 public:
  CloudBuilder(const PcdHeader& header, const std::string& label_field, PcdCloud& cloud)
      : cloud_(cloud),
        xyz_{header.find("x"), header.find("y"), header.find("z")},
        label_(header.find(label_field)) {
    if (label_ != nullptr) cloud_.label_field = label_->name;
  }

  /// `points` is known to be possible for the size of the file.
  void reserve(std::size_t points) {
    cloud_.points.reserve(points);
    if (label_ != nullptr) cloud_.labels.reserve(points);
  }

  /// `value(field)` is the value of a field of the next point.
  template <class Value>
  void add(Value&& value) {
    const Eigen::Vector3d point(value(*xyz_[0]), value(*xyz_[1]), value(*xyz_[2]));
    const double label = label_ != nullptr ? value(*label_) : 0;
    cloud_.points.push_back(point);
    if (label_ != nullptr) addLabel(label);
  }

 private:
  void addLabel(double value) {
    const bool valid = value >= 0 && value < kNoPcdLabel && value == std::floor(value);
    cloud_.labels.push_back(valid ? static_cast<std::uint32_t>(value) : kNoPcdLabel);
    if (!valid) ++cloud_.invalid_labels;
  }

  PcdCloud& cloud_;
  const PcdField* xyz_[3];
  const PcdField* label_;
};

void readBinary(const PcdHeader& header, std::string_view data, const std::string& file,
                CloudBuilder& builder, PcdCloud& cloud) {
  if (data.size() / header.point_bytes < header.points)
    throw FileError(file, "the header announces " + std::to_string(header.points) + " points of " +
                              std::to_string(header.point_bytes) + " bytes, but only " +
                              std::to_string(data.size()) + " bytes follow; the file is truncated");
  builder.reserve(header.points);
  for (std::size_t i = 0; i < header.points; ++i) {
    const char* point = data.data() + i * header.point_bytes;
    builder.add([&](const PcdField& field) { return binaryValue(field, point); });
  }
  cloud.trailing_bytes = data.size() - header.points * header.point_bytes;
}

/// Compressed data: two sizes, then LZF, which holds all values of the first field, then all of the
/// second … PCL leaves padding out of it, others do not.
class CompressedReader {
 public:
  CompressedReader(const PcdHeader& header, const std::string& file)
      : header_(header), file_(file) {}

  void read(std::string_view data, CloudBuilder& builder, PcdCloud& cloud) {
    const std::string values = unpacked(data, cloud);
    const bool padded = values.size() != header_.points * bytesOfPoint(false);
    std::size_t begin = 0;
    for (const PcdField& field : header_.fields) {
      begin_.push_back(begin);
      if (padded || !field.isPadding()) begin += field.size * field.count * header_.points;
    }
    builder.reserve(header_.points);
    for (std::size_t i = 0; i < header_.points; ++i)
      builder.add([&](const PcdField& field) { return valueOf(values, field, i); });
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const { throw FileError(file_, reason); }

  std::size_t bytesOfPoint(bool with_padding) const {
    std::size_t bytes = 0;
    for (const PcdField& field : header_.fields)
      if (with_padding || !field.isPadding()) bytes += field.size * field.count;
    return bytes;
  }

  std::string unpacked(std::string_view data, PcdCloud& cloud) const {
    constexpr std::size_t kSizes = 2 * sizeof(std::uint32_t);
    // Of LZF: three bytes stand for 264 at the most.
    constexpr std::size_t kMaxExpansion = 88;
    if (data.size() < kSizes) fail("compressed data without its two sizes; the file is truncated");
    const auto packed = static_cast<std::size_t>(numberAt<std::uint32_t>(data.data()));
    const auto size =
        static_cast<std::size_t>(numberAt<std::uint32_t>(data.data() + sizeof(std::uint32_t)));
    if (packed > data.size() - kSizes)
      fail("announces " + std::to_string(packed) + " bytes of compressed data, but only " +
           std::to_string(data.size() - kSizes) + " follow; the file is truncated");
    const bool fits = isOf(size, bytesOfPoint(false)) || isOf(size, bytesOfPoint(true));
    if (!fits || size / kMaxExpansion > packed)
      fail(std::to_string(packed) + " bytes of compressed data that are to become " +
           std::to_string(size) + " cannot be " + std::to_string(header_.points) + " points of " +
           std::to_string(bytesOfPoint(false)) + " bytes");
    cloud.trailing_bytes = data.size() - kSizes - packed;
    std::string values(size, '\0');
    if (size == 0) return values;
    const unsigned int written =
        lzf_decompress(data.data() + kSizes, static_cast<unsigned int>(packed), values.data(),
                       static_cast<unsigned int>(size));
    if (written != size) fail("its compressed data is damaged");
    return values;
  }

  /// Whether `size` is that of all points.
  bool isOf(std::size_t size, std::size_t point_bytes) const {
    if (header_.points == 0) return size == 0;
    return size % header_.points == 0 && size / header_.points == point_bytes;
  }

  double valueOf(const std::string& values, const PcdField& field, std::size_t point) const {
    PcdField at_begin = field;
    at_begin.offset = 0;
    const auto number = static_cast<std::size_t>(&field - header_.fields.data());
    return binaryValue(at_begin, values.data() + begin_[number] + point * field.size);
  }

  const PcdHeader& header_;
  const std::string& file_;
  std::vector<std::size_t> begin_;  ///< of the values of each field
};

class AsciiReader {
 public:
  AsciiReader(const PcdHeader& header, const std::string& file, PcdRowPolicy policy,
              CloudBuilder& builder, PcdCloud& cloud)
      : header_(header), file_(file), policy_(policy), builder_(builder), cloud_(cloud) {}

  void read(std::string_view data) {
    // A value and its separator are two bytes at least; the last separator may be missing.
    if ((data.size() + 1) / 2 / header_.columns < header_.points)
      throw FileError(file_, "the header announces " + std::to_string(header_.points) +
                                 " points, more than the " + std::to_string(data.size()) +
                                 " bytes after it can hold; the file is truncated");
    builder_.reserve(header_.points);
    detail::LineReader lines(data);
    std::size_t rows = 0;
    for (std::string_view line; lines.next(line);) {
      line_number_ = header_.lines + lines.lineNumber();
      detail::splitColumns(line, columns_);
      if (columns_.empty()) continue;
      if (++rows > header_.points)
        fail("more rows than the " + std::to_string(header_.points) + " POINTS of the header");
      readRow();
    }
    if (rows < header_.points)
      throw FileError(file_, "ends after " + std::to_string(rows) + " of the " +
                                 std::to_string(header_.points) +
                                 " points that the header announces; the file is truncated");
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw FileError(file_, "line " + std::to_string(line_number_) + ": " + reason);
  }

  void readRow() {
    if (columns_.size() != header_.columns && !acceptIrregular()) return;
    builder_.add([&](const PcdField& field) { return value(field); });
  }

  /// Counts a row with a wrong number of columns; false if it is to be left out.
  bool acceptIrregular() {
    if (policy_ == PcdRowPolicy::Refuse)
      fail(std::to_string(columns_.size()) + " columns, the header announces " +
           std::to_string(header_.columns) + "; such rows can be skipped or their surplus ignored");
    if (cloud_.irregular_rows++ == 0) cloud_.first_irregular_line = line_number_;
    const bool use = policy_ == PcdRowPolicy::IgnoreExtra && columns_.size() > header_.columns;
    if (!use) ++cloud_.skipped_rows;
    return use;
  }

  double value(const PcdField& field) const {
    double number = 0;
    if (!detail::parseNumber(columns_[field.column], number))
      fail("field " + detail::quoted(field.name) + " is " + detail::quoted(columns_[field.column]) +
           ", expected a number");
    return number;
  }

  const PcdHeader& header_;
  const std::string& file_;
  PcdRowPolicy policy_;
  CloudBuilder& builder_;
  PcdCloud& cloud_;
  std::vector<std::string_view> columns_;
  std::size_t line_number_ = 0;
};

}  // namespace

PcdCloud readPcd(const std::string& file, PcdRowPolicy policy, const std::string& label_field) {
  const std::string bytes = detail::readFile(file);
  const PcdHeader header = detail::readPcdHeader(bytes, file);
  const std::string_view data = std::string_view(bytes).substr(header.data_begin);
  PcdCloud cloud;
  cloud.viewpoint = header.viewpoint;
  cloud.viewpoint_rotation = header.viewpoint_rotation;
  for (const PcdField& field : header.fields)
    if (!field.isPadding()) cloud.fields.push_back(field.name);
  CloudBuilder builder(header, label_field, cloud);
  switch (header.data) {
    case PcdHeader::Data::Ascii:
      AsciiReader(header, file, policy, builder, cloud).read(data);
      break;
    case PcdHeader::Data::Binary:
      readBinary(header, data, file, builder, cloud);
      break;
    case PcdHeader::Data::Compressed:
      CompressedReader(header, file).read(data, builder, cloud);
      break;
  }
  return cloud;
}

}  // namespace csom
