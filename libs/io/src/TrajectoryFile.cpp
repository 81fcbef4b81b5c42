// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/io/InputFile.h>
#include <csom/io/OutputFile.h>
#include <csom/io/TextParser.h>
#include <csom/io/TrajectoryFile.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "RigidTransform.h"

namespace csom {

namespace {

/// The lines of a file that hold exactly N finite numbers each, one after the other.
template <std::size_t N>
class NumberLines {
 public:
  NumberLines(const std::string& file, const char* layout)
      : file_(file), layout_(layout), text_(detail::readFile(file)), lines_(text_) {}

  /// The next line, blank or not; false at the end.
  bool nextLine() {
    std::string_view line;
    if (!lines_.next(line)) return false;
    detail::splitColumns(line, columns_);
    return true;
  }
  bool isBlank() const { return columns_.empty(); }
  bool isComment() const { return !isBlank() && columns_.front().front() == '#'; }

  /// Of the line at hand.
  std::array<double, N> numbers() const {
    std::array<double, N> numbers{};
    if (columns_.size() != N)
      fail(std::to_string(columns_.size()) + " columns, expected the " + std::to_string(N) +
           " numbers " + layout_);
    for (std::size_t i = 0; i < N; ++i) {
      if (!detail::parseNumber(columns_[i], numbers[i]) || !std::isfinite(numbers[i]))
        fail("column " + std::to_string(i + 1) + " is " + detail::quoted(columns_[i]) +
             ", expected a finite number");
    }
    return numbers;
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw FileError(file_, "line " + std::to_string(lines_.lineNumber()) + ": " + reason);
  }

 private:
  std::string file_;
  const char* layout_;
  std::string text_;
  detail::LineReader lines_;
  std::vector<std::string_view> columns_;
};

}  // namespace

std::vector<TimedPose> readTumTrajectory(const std::string& file) {
  NumberLines<8> lines(file, "'timestamp x y z qx qy qz qw'");
  std::vector<TimedPose> trajectory;
  while (lines.nextLine()) {
    if (lines.isBlank() || lines.isComment()) continue;
    const std::array<double, 8> n = lines.numbers();
    const Eigen::Quaterniond rotation(n[7], n[4], n[5], n[6]);
    if (!(std::abs(rotation.norm() - 1) <= 0.01))
      lines.fail("the quaternion has length " + std::to_string(rotation.norm()) +
                 ", expected 1; the order is qx qy qz qw");
    if (!trajectory.empty() && n[0] <= trajectory.back().timestamp)
      lines.fail("time " + std::to_string(n[0]) + " is not after " +
                 std::to_string(trajectory.back().timestamp) +
                 " of the pose before; sort the file by time");
    TimedPose entry;
    entry.timestamp = n[0];
    entry.pose.linear() = rotation.normalized().toRotationMatrix();
    entry.pose.translation() = Eigen::Vector3d(n[1], n[2], n[3]);
    trajectory.push_back(entry);
  }
  if (trajectory.empty()) throw FileError(file, "holds no pose");
  return trajectory;
}

void writeTumTrajectory(const std::vector<TimedPose>& trajectory, const std::string& file) {
  OutputFile output(file);
  output.write("# timestamp x y z qx qy qz qw\n");
  for (const TimedPose& entry : trajectory) {
    const Eigen::Vector3d position = entry.pose.translation();
    const Eigen::Quaterniond rotation(entry.pose.linear());
    char line[512];
    std::snprintf(line, sizeof line, "%.9f %.9f %.9f %.9f %.12f %.12f %.12f %.12f\n",
                  entry.timestamp, position.x(), position.y(), position.z(), rotation.x(),
                  rotation.y(), rotation.z(), rotation.w());
    output.write(line);
  }
  output.commit();
}

std::vector<std::optional<Eigen::Isometry3d>> readKittiPoses(const std::string& file) {
  NumberLines<12> lines(file, "of a 3x4 matrix");
  std::vector<std::optional<Eigen::Isometry3d>> poses;
  std::size_t until_last = 0;
  while (lines.nextLine()) {
    if (lines.isComment()) lines.fail("a comment, but the line of a pose is its frame: remove it");
    poses.emplace_back();
    if (lines.isBlank()) continue;
    const std::array<double, 12> n = lines.numbers();
    const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> matrix(n.data());
    const auto pose = detail::poseFromMatrix(matrix);
    if (!pose) lines.fail("columns 1-3, 5-7 and 9-11 are not a rotation");
    poses.back() = *pose;
    until_last = poses.size();
  }
  poses.resize(until_last);
  if (poses.empty()) throw FileError(file, "holds no pose");
  return poses;
}

}  // namespace csom
