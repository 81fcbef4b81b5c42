// SPDX-License-Identifier: BSD-3-Clause
#include "Scans.h"

#include <csom/core/FindRangeImage.h>
#include <csom/eval/Scenario.h>
#include <csom/io/KittiReader.h>
#include <csom/io/LabelSet.h>
#include <csom/io/TrajectoryFile.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace csom::bench {

namespace {

/// The directions of a Velodyne HDL-64E.
Eigen::Vector3d beamDirection(int column, int columns, int beam) {
  constexpr double kDegree = M_PI / 180;
  constexpr int kBeams = 64;
  const double azimuth = 2 * M_PI * column / columns;
  const double elevation = (2.0 - 26.8 * beam / (kBeams - 1)) * kDegree;
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

SensorScan campusScan(const Scenario& campus, double time, int columns) {
  constexpr double kHeight = 1.8;
  constexpr double kMaxRange = 80;
  const PlanarPose robot = campus.path.at(time);
  SensorScan scan;
  scan.pose = Eigen::Translation3d(robot.x, robot.y, kHeight) *
              Eigen::AngleAxisd(robot.yaw, Eigen::Vector3d::UnitZ());
  for (int column = 0; column < columns; ++column) {
    for (int beam = 0; beam < 64; ++beam) {
      const Eigen::Vector3d direction = beamDirection(column, columns, beam);
      const auto hit =
          campus.world.castRay(scan.pose.translation(), scan.pose.linear() * direction, kMaxRange);
      if (!hit) continue;
      scan.points.push_back((hit->distance * direction).cast<float>());
      scan.labels.push_back(hit->class_id);
    }
  }
  findImage(scan);
  return scan;
}

}  // namespace

void findImage(SensorScan& scan) {
  auto image = findRangeImage(scan.points);
  if (!image) throw std::runtime_error("the rows of a scan cannot be found");
  scan.image = *std::move(image);
}

Drive semanticKitti(const std::string& folder) {
  constexpr std::size_t kScans = 5;
  const std::string sequence = folder + "/semantickitti_08";
  const auto scan = [sequence](std::size_t i) {
    const LabelSet labels = LabelSet::load(LabelSet::find("semantickitti"));
    std::array<char, 16> name{};
    std::snprintf(name.data(), name.size(), "%06zu", i);
    const KittiScan raw = readKittiScan(sequence + "/velodyne/" + name.data() + ".bin");
    const auto ids =
        readKittiLabels(sequence + "/predictions/" + name.data() + ".label", raw.points.size());
    SensorScan out;
    out.pose = readKittiPoses(sequence + "/poses.txt").at(i).value() *
               readKittiOdometryCalibration(sequence + "/calib.txt");
    for (std::size_t p = 0; p < raw.points.size(); ++p) {
      const LabelSet::Raw label = labels.classOfRaw(ids[p]);
      if (label.kind != LabelSet::RawKind::Class) continue;
      out.points.push_back(raw.points[p]);
      out.labels.push_back(label.id);
    }
    findImage(out);
    return out;
  };
  return {"SemanticKITTI 08", kScans, scan};
}

Drive campus(std::size_t scans, int columns) {
  const auto scenario = std::make_shared<const Scenario>(loadScenario(CSOM_CAMPUS));
  return {"simulated campus", scans, [scenario, scans, columns](std::size_t i) {
            const double part = (static_cast<double>(i) + 0.5) / static_cast<double>(scans);
            return campusScan(*scenario, part * scenario->path.duration(), columns);
          }};
}

Drive chooseDrive(bool quick) {
  if (quick) return campus(2, 80);
  const char* const folder = std::getenv("CSOM_DATA");
  return folder != nullptr && *folder != '\0' ? semanticKitti(folder) : campus(5, 2000);
}

Scan inMap(const SensorScan& scan) {
  Scan out;
  out.origin = scan.pose.translation();
  out.labels = scan.labels;
  out.image = scan.image;
  out.points.reserve(scan.points.size());
  for (const Eigen::Vector3f& point : scan.points)
    out.points.push_back((scan.pose.linear() * point.cast<double>()).cast<float>());
  return out;
}

std::vector<Scan> allInMap(const Drive& drive) {
  std::vector<Scan> scans;
  for (std::size_t i = 0; i < drive.scans; ++i) scans.push_back(inMap(drive.scan(i)));
  return scans;
}

Scan widerScene(const Scan& scan, std::size_t points) {
  std::vector<std::size_t> by_azimuth(scan.points.size());
  std::iota(by_azimuth.begin(), by_azimuth.end(), std::size_t{0});
  const auto azimuth = [&scan](std::size_t i) {
    return std::atan2(scan.points[i].y(), scan.points[i].x());
  };
  std::sort(by_azimuth.begin(), by_azimuth.end(),
            [&](std::size_t a, std::size_t b) { return azimuth(a) < azimuth(b); });
  constexpr float kFarEnough = 200;  // [m]; a scan reaches less than half as far
  Scan out;
  out.origin = scan.origin;
  for (std::size_t i = 0; i < points; ++i) {
    const std::size_t source = by_azimuth[i % by_azimuth.size()];
    const auto copy = static_cast<float>(i / by_azimuth.size());
    out.points.push_back(scan.points[source] + Eigen::Vector3f(kFarEnough * copy, 0, 0));
    out.labels.push_back(scan.labels[source]);
  }
  return out;
}

Scan denserScene(const std::vector<Scan>& scans, std::size_t points) {
  Scan all;
  all.origin = scans.front().origin;
  for (const Scan& scan : scans) {
    const Eigen::Vector3f offset = (scan.origin - all.origin).cast<float>();
    for (const Eigen::Vector3f& point : scan.points) all.points.push_back(point + offset);
    all.labels.insert(all.labels.end(), scan.labels.begin(), scan.labels.end());
  }
  Scan out;
  out.origin = all.origin;
  for (std::size_t i = 0; i < points; ++i) {
    const std::size_t source = i * all.points.size() / points;
    out.points.push_back(all.points[source]);
    out.labels.push_back(all.labels[source]);
  }
  return out;
}

}  // namespace csom::bench
