// SPDX-License-Identifier: BSD-3-Clause
// Point clouds in PCD files up to version 0.7: ascii, binary, binary_compressed.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace csom {

/// What to do with an ascii row that has not the number of columns that the header announces.
enum class PcdRowPolicy {
  Refuse,       ///< the file is refused
  SkipRow,      ///< the row is left out and counted
  IgnoreExtra,  ///< surplus columns are ignored and the row counted; too short a row is left out
};

/// Label of a point whose label is no integer in 0 … 2³²−2. No label set knows it.
constexpr std::uint32_t kNoPcdLabel = 0xffffffffu;

struct PcdCloud {
  /// As they stand in the file [m]; NaN where the file has NaN.
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> labels;  ///< one a point, or empty if there is no field of labels
  /// Name of the field of labels as the file spells it; empty if there is none.
  std::string label_field;
  std::vector<std::string> fields;  ///< names of all fields, in order, without padding (`_`)

  /// VIEWPOINT: pose of the sensor in the frame of the points.
  Eigen::Vector3d viewpoint = Eigen::Vector3d::Zero();
  Eigen::Quaterniond viewpoint_rotation = Eigen::Quaterniond::Identity();

  std::size_t irregular_rows = 0;        ///< rows with a wrong number of columns
  std::size_t skipped_rows = 0;          ///< those of them that were left out
  std::size_t first_irregular_line = 0;  ///< line of the first one, from 1; 0 = none
  std::size_t invalid_labels = 0;        ///< points that have kNoPcdLabel
  std::size_t trailing_bytes = 0;        ///< binary: bytes after the last point, not read
};

/// Reads the fields x, y, z and, if there, the one of labels, in any order, of any type and size,
/// among any others. Names are compared exactly, or else without regard to case. Nothing in the
/// header is believed before it is checked against the size of the file. Throws FileError naming
/// file and line.
PcdCloud readPcd(const std::string& file, PcdRowPolicy policy,
                 const std::string& label_field = "label");

}  // namespace csom
