// SPDX-License-Identifier: BSD-3-Clause
#include "StreetScan.h"

#include <csom/io/KittiReader.h>
#include <csom/io/LabelSet.h>
#include <csom/io/TrajectoryFile.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace csom::bench {

namespace {

struct Surface {
  double range;
  ClassId label;
};

/// Where a ray from 1.8 m above the ground ends.
Surface nearestSurface(const Eigen::Vector3d& direction) {
  constexpr double kHeight = 1.8;
  constexpr double kHouses = 12;
  constexpr double kKerb = 4;
  Surface nearest{std::numeric_limits<double>::infinity(), 0};
  const auto offer = [&](double range, ClassId label) {
    if (range > 0 && range < nearest.range) nearest = {range, label};
  };
  if (direction.z() < 0) {
    const double range = -kHeight / direction.z();
    offer(range, std::abs(range * direction.y()) < kKerb ? 1 : 2);
  }
  const double wall = kHouses / std::abs(direction.y());
  if (wall * direction.z() < 8) offer(wall, 3);
  const double car = (kKerb - 1) / std::abs(direction.y());
  const double along = car * direction.x();
  const double height = kHeight + car * direction.z();
  if (std::fmod(std::abs(along), 10.0) < 4 && height > 0 && height < 1.5) offer(car, 4);
  return nearest;
}

}  // namespace

Scan streetScan(int columns) {
  constexpr int kBeams = 64;
  constexpr double kMaxRange = 60;
  Scan scan;
  scan.origin = {0, 0, 1.8};
  for (int column = 0; column < columns; ++column)
    for (int beam = 0; beam < kBeams; ++beam) {
      const double azimuth = 2 * M_PI * column / columns;
      const double elevation = (2.0 - 26.8 * beam / (kBeams - 1)) * M_PI / 180;
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                      std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Surface hit = nearestSurface(direction);
      if (hit.range > kMaxRange) continue;
      scan.points.push_back((hit.range * direction).cast<float>());
      scan.labels.push_back(hit.label);
    }
  return scan;
}

std::vector<Scan> semanticKittiScans(const std::string& folder, int count) {
  const LabelSet labels = LabelSet::load(LabelSet::find("semantickitti"));
  const auto poses = readKittiPoses(folder + "/poses.txt");
  const Eigen::Isometry3d calibration = readKittiOdometryCalibration(folder + "/calib.txt");
  std::vector<Scan> scans;
  for (int i = 0; i < count; ++i) {
    std::array<char, 16> name{};
    std::snprintf(name.data(), name.size(), "%06d", i);
    const KittiScan raw = readKittiScan(folder + "/velodyne/" + name.data() + ".bin");
    const auto ids =
        readKittiLabels(folder + "/predictions/" + name.data() + ".label", raw.points.size());
    const Eigen::Isometry3d pose = poses.at(static_cast<std::size_t>(i)) * calibration;
    Scan scan;
    scan.origin = pose.translation();
    for (std::size_t p = 0; p < raw.points.size(); ++p) {
      const LabelSet::Raw label = labels.classOfRaw(ids[p]);
      if (label.kind != LabelSet::RawKind::Class) continue;
      scan.points.push_back((pose.linear() * raw.points[p].cast<double>()).cast<float>());
      scan.labels.push_back(label.id);
    }
    scans.push_back(std::move(scan));
  }
  return scans;
}

}  // namespace csom::bench
