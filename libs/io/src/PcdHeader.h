// SPDX-License-Identifier: BSD-3-Clause
// The header of a PCD file, checked.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace csom::detail {

struct PcdField {
  std::string name;
  char type = 'F';        ///< 'F', 'U' or 'I'
  std::size_t size = 4;   ///< bytes of one value
  std::size_t count = 1;  ///< values a point; 0: the field is named, but holds nothing

  std::size_t column = 0;  ///< of the first value, ascii
  std::size_t offset = 0;  ///< of the first value in a point, binary

  /// Padding, which is left out of compressed data.
  bool isPadding() const { return name == "_"; }
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t columns = 0;      ///< values a point
  std::size_t point_bytes = 0;  ///< binary
  std::size_t points = 0;       ///< as the header says; not yet held against the data
  enum class Data { Ascii, Binary, Compressed };
  Data data = Data::Ascii;
  std::size_t lines = 0;       ///< of the header
  std::size_t data_begin = 0;  ///< byte position behind the header
  Eigen::Vector3d viewpoint = Eigen::Vector3d::Zero();
  Eigen::Quaterniond viewpoint_rotation = Eigen::Quaterniond::Identity();

  /// The field of that name, or else in whatever case, with one value a point; null if there is
  /// none.
  const PcdField* find(std::string_view name) const;
};

/// Throws FileError naming `file` and the line.
PcdHeader readPcdHeader(std::string_view bytes, const std::string& file);

}  // namespace csom::detail
