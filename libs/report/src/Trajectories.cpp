// SPDX-License-Identifier: BSD-3-Clause
// Places of sensors as lines.
#include "Trajectories.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace csom {

namespace {

using Line = std::vector<Eigen::Vector3d>;

constexpr std::size_t kMaxPoints = 4000;
constexpr double kSmallestStep = 1e-3;  // [m]
constexpr double kSmallestJump = 5.0;   // [m]

/// Every n-th point, and the last.
Line thinned(const Line& line, std::size_t n) {
  Line points;
  for (std::size_t i = 0; i < line.size(); i += n) points.push_back(line[i]);
  if ((line.size() - 1) % n != 0) points.push_back(line.back());
  return points;
}

/// Cut where a step is far longer than the usual one.
std::vector<Line> pieces(const Line& line) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < line.size(); ++i) steps.push_back((line[i] - line[i - 1]).norm());
  std::vector<double> sorted = steps;
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted.empty() ? 0 : sorted[sorted.size() / 2];
  std::vector<Line> result{{line.front()}};
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (steps[i - 1] > std::max(kSmallestJump, 10 * usual)) result.emplace_back();
    result.back().push_back(line[i]);
  }
  return result;
}

}  // namespace

std::vector<Line> trajectories3d(const RunRecord& record) {
  std::map<std::string, Line> by_sensor;
  std::size_t points = 0;
  for (const RunScan& scan : record.scans) {
    const Eigen::Vector3d origin(scan.record.origin.data());
    if (!origin.allFinite()) continue;
    Line& line = by_sensor[scan.record.sensor_label];
    if (!line.empty() && (line.back() - origin).norm() < kSmallestStep) continue;
    line.push_back(origin);
    ++points;
  }
  std::vector<Line> lines;
  for (const auto& [sensor, line] : by_sensor)
    for (const Line& piece : pieces(line)) lines.push_back(thinned(piece, points / kMaxPoints + 1));
  return lines;
}

}  // namespace csom
