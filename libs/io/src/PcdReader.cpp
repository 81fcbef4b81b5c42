// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/io/InputFile.h>
#include <csom/io/PcdReader.h>
#include <csom/io/TextParser.h>

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
  CloudBuilder(const PcdHeader& header, PcdCloud& cloud)
      : cloud_(cloud),
        xyz_{header.find("x"), header.find("y"), header.find("z")},
        label_(header.find("label")),
        intensity_(header.find("intensity")) {
    cloud_.has_labels = label_ != nullptr;
    cloud_.has_intensities = intensity_ != nullptr;
  }

  /// `points` is known to be possible for the size of the file.
  void reserve(std::size_t points) {
    cloud_.points.reserve(points);
    if (label_ != nullptr) cloud_.labels.reserve(points);
    if (intensity_ != nullptr) cloud_.intensities.reserve(points);
  }

  /// `value(field)` is the value of a field of the next point.
  template <class Value>
  void add(Value&& value) {
    const Eigen::Vector3d point(value(*xyz_[0]), value(*xyz_[1]), value(*xyz_[2]));
    const double label = label_ != nullptr ? value(*label_) : 0;
    const double intensity = intensity_ != nullptr ? value(*intensity_) : 0;
    cloud_.points.push_back(point);
    if (label_ != nullptr) addLabel(label);
    if (intensity_ != nullptr) cloud_.intensities.push_back(static_cast<float>(intensity));
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
  const PcdField* intensity_;
};

void readBinary(const PcdHeader& header, std::string_view data, const std::string& file,
                PcdCloud& cloud) {
  if (data.size() / header.point_bytes < header.points)
    throw FileError(file, "the header announces " + std::to_string(header.points) + " points of " +
                              std::to_string(header.point_bytes) + " bytes, but only " +
                              std::to_string(data.size()) + " bytes follow; the file is truncated");
  CloudBuilder builder(header, cloud);
  builder.reserve(header.points);
  for (std::size_t i = 0; i < header.points; ++i) {
    const char* point = data.data() + i * header.point_bytes;
    builder.add([&](const PcdField& field) { return binaryValue(field, point); });
  }
  cloud.trailing_bytes = data.size() - header.points * header.point_bytes;
}

class AsciiReader {
 public:
  AsciiReader(const PcdHeader& header, const std::string& file, PcdRowPolicy policy,
              PcdCloud& cloud)
      : header_(header), file_(file), policy_(policy), cloud_(cloud), builder_(header, cloud) {}

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
      fail("field '" + field.name + "' is " + detail::quoted(columns_[field.column]) +
           ", expected a number");
    return number;
  }

  const PcdHeader& header_;
  const std::string& file_;
  PcdRowPolicy policy_;
  PcdCloud& cloud_;
  CloudBuilder builder_;
  std::vector<std::string_view> columns_;
  std::size_t line_number_ = 0;
};

}  // namespace

PcdCloud readPcd(const std::string& file, PcdRowPolicy policy) {
  const std::string bytes = detail::readFile(file);
  const PcdHeader header = detail::readPcdHeader(bytes, file);
  const std::string_view data = std::string_view(bytes).substr(header.data_begin);
  PcdCloud cloud;
  cloud.viewpoint = header.viewpoint;
  cloud.viewpoint_rotation = header.viewpoint_rotation;
  if (header.binary)
    readBinary(header, data, file, cloud);
  else
    AsciiReader(header, file, policy, cloud).read(data);
  return cloud;
}

}  // namespace csom
