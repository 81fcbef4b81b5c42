// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/io/InputFile.h>
#include <csom/io/KittiReader.h>
#include <csom/io/TextParser.h>

#include <cmath>
#include <cstring>
#include <map>
#include <stdexcept>

#include "RigidTransform.h"

namespace csom {

namespace {

/// A calibration file: lines `KEY: number number …`, found by key.
class CalibrationFile {
 public:
  explicit CalibrationFile(const std::string& file) : file_(file), text_(detail::readFile(file)) {
    detail::LineReader lines(text_);
    for (std::string_view line; lines.next(line);) {
      const std::size_t colon = line.find(':');
      if (colon == std::string_view::npos) continue;
      values_.emplace(line.substr(0, colon), Entry{line.substr(colon + 1), lines.lineNumber()});
    }
  }

  /// The `rows` × `cols` numbers of a key, row by row.
  template <int rows, int cols>
  Eigen::Matrix<double, rows, cols> matrix(const std::string& key) const {
    const auto it = values_.find(key);
    if (it == values_.end()) throw FileError(file_, "has no line '" + key + ":'");
    std::vector<std::string_view> columns;
    detail::splitColumns(it->second.text, columns);
    if (columns.size() != static_cast<std::size_t>(rows * cols))
      fail(key,
           std::to_string(columns.size()) + " numbers, expected " + std::to_string(rows * cols));
    Eigen::Matrix<double, rows, cols> result;
    for (int i = 0; i < rows * cols; ++i) {
      double& value = result(i / cols, i % cols);
      const std::string_view text = columns[static_cast<std::size_t>(i)];
      if (!detail::parseNumber(text, value) || !std::isfinite(value))
        fail(key, detail::quoted(text) + " is not a finite number");
    }
    return result;
  }

  Eigen::Isometry3d pose(const std::string& key, const Eigen::Matrix<double, 3, 4>& values) const {
    const auto pose = detail::poseFromMatrix(values);
    if (!pose) fail(key, "not a rotation");
    return *pose;
  }

  [[noreturn]] void fail(const std::string& key, const std::string& reason) const {
    throw FileError(
        file_, "line " + std::to_string(values_.at(key).line) + " ('" + key + ":'): " + reason);
  }

 private:
  struct Entry {
    std::string_view text;
    std::size_t line;
  };

  std::string file_;
  std::string text_;
  std::map<std::string, Entry, std::less<>> values_;
};

template <class Number>
Number numberAt(const std::string& bytes, std::size_t position) {
  static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the files are little-endian");
  Number value;
  std::memcpy(&value, bytes.data() + position, sizeof value);
  return value;
}

}  // namespace

KittiScan readKittiScan(const std::string& file) {
  constexpr std::size_t point_bytes = 4 * sizeof(float);
  const std::string bytes = detail::readFile(file);
  if (bytes.size() % point_bytes != 0)
    throw FileError(file, std::to_string(bytes.size()) +
                              " bytes are not a whole number of points of 16 bytes (x y z "
                              "intensity); the file is truncated or of another kind");
  KittiScan scan;
  scan.points.reserve(bytes.size() / point_bytes);
  scan.intensities.reserve(bytes.size() / point_bytes);
  for (std::size_t at = 0; at < bytes.size(); at += point_bytes) {
    scan.points.emplace_back(numberAt<float>(bytes, at), numberAt<float>(bytes, at + 4),
                             numberAt<float>(bytes, at + 8));
    scan.intensities.push_back(numberAt<float>(bytes, at + 12));
  }
  return scan;
}

std::vector<std::uint32_t> readKittiLabels(const std::string& file, std::size_t points) {
  const std::string bytes = detail::readFile(file);
  if (bytes.size() != points * sizeof(std::uint32_t))
    throw FileError(file, std::to_string(bytes.size()) + " bytes, but the scan's " +
                              std::to_string(points) + " points need " +
                              std::to_string(points * sizeof(std::uint32_t)) +
                              "; scan and labels do not belong together");
  std::vector<std::uint32_t> labels(points);
  for (std::size_t i = 0; i < points; ++i)
    labels[i] = numberAt<std::uint32_t>(bytes, i * sizeof(std::uint32_t)) & 0xffffU;
  return labels;
}

Eigen::Isometry3d readKittiOdometryCalibration(const std::string& file) {
  const CalibrationFile calibration(file);
  return calibration.pose("Tr", calibration.matrix<3, 4>("Tr"));
}

KittiCamera readKittiRawCamera(const std::string& folder, int camera) {
  if (camera < 0 || camera > 3)
    throw std::invalid_argument("KITTI cameras are 0 to 3, not " + std::to_string(camera));
  const std::string number = "_0" + std::to_string(camera);

  const CalibrationFile velodyne(folder + "/calib_velo_to_cam.txt");
  Eigen::Matrix<double, 3, 4> velo_to_cam;
  velo_to_cam << velodyne.matrix<3, 3>("R"), velodyne.matrix<3, 1>("T");

  const CalibrationFile cameras(folder + "/calib_cam_to_cam.txt");
  Eigen::Matrix<double, 3, 4> rectify = Eigen::Matrix<double, 3, 4>::Zero();
  rectify.leftCols<3>() = cameras.matrix<3, 3>("R_rect_00");
  const Eigen::Matrix<double, 3, 4> projection = cameras.matrix<3, 4>("P_rect" + number);
  const Eigen::Vector2d size = cameras.matrix<2, 1>("S_rect" + number);
  const Eigen::Matrix3d intrinsics = projection.leftCols<3>();
  const bool pinhole = intrinsics(0, 0) > 0 && intrinsics(1, 1) > 0 && intrinsics(0, 1) == 0 &&
                       intrinsics(1, 0) == 0 && intrinsics.row(2) == Eigen::RowVector3d(0, 0, 1);
  if (!pinhole) cameras.fail("P_rect" + number, "not the projection of a rectified camera");
  const auto isImageSide = [](double side) {
    return side >= 1 && side <= 100000 && side == std::floor(side);
  };
  if (!isImageSide(size.x()) || !isImageSide(size.y()))
    cameras.fail("S_rect" + number, "not the width and height of an image");

  KittiCamera result;
  result.width = static_cast<int>(size.x());
  result.height = static_cast<int>(size.y());
  result.fx = intrinsics(0, 0);
  result.fy = intrinsics(1, 1);
  result.cx = intrinsics(0, 2);
  result.cy = intrinsics(1, 2);
  // P_rect = K·[I | t]: t places this camera in the rectified frame of camera 0.
  const Eigen::Vector3d t((projection(0, 3) - result.cx * projection(2, 3)) / result.fx,
                          (projection(1, 3) - result.cy * projection(2, 3)) / result.fy,
                          projection(2, 3));
  result.camera_from_velodyne = Eigen::Translation3d(t) * cameras.pose("R_rect_00", rectify) *
                                velodyne.pose("R", velo_to_cam);
  return result;
}

}  // namespace csom
