// SPDX-License-Identifier: BSD-3-Clause
// Scans of a sensor that is carried along: the robot's motion is taken out of them.
#include <csom/maps/VelodynePackets.h>
#include <csom/rawlog/Deskew.h>
#include <csom/rawlog/MappingRun.h>
#include <csom/rawlog/Simulation.h>

#include <cmath>
#include <cstring>

#include "rawlog/LogFixtures.h"
#include "rawlog/SimulatedDrive.h"

namespace csom::test {
namespace {

using mrpt::obs::CObservationVelodyneScan;
using mrpt::poses::CPose3D;
using testing::HasSubstr;

constexpr double kStart = 1577836800.0;  // of every simulation

class DeskewTest : public testing::Test {
 protected:
  void simulate(const std::string& lidar_keys) {
    scenario.emplace(yardDrive(folder, lidar_keys));
    SimulationOptions options;
    options.format = RawlogFormat::Observations;
    simulateRawlog(*scenario, log, options);
    RawlogReader reader(log);
    while (const auto entry = reader.next()) {
      for (const auto& observation : entry->observations) {
        if (auto scan = std::dynamic_pointer_cast<CObservationVelodyneScan>(observation))
          scans.push_back(scan);
      }
    }
    ASSERT_GE(scans.size(), 20U);
  }

  CPose3D robotAt(double time) const {
    const PlanarPose pose = scenario->path.at(time - kStart);
    return {pose.x, pose.y, 0, pose.yaw, 0, 0};
  }
  RobotMotion truth() const {
    return [this](double time) { return std::optional<CPose3D>(robotAt(time)); };
  }

  /// Share of the points that lie within 5 cm of the surface that is seen in their direction from
  /// where the sensor was at the scan's time stamp.
  double shareOnSurfaces(const CObservationVelodyneScan::TPointCloud& cloud,
                         const CObservationVelodyneScan& scan) const {
    const CPose3D sensor = robotAt(mrpt::Clock::toDouble(scan.timestamp)) + scan.sensorPose;
    const Eigen::Vector3d origin(sensor.x(), sensor.y(), sensor.z());
    std::size_t near = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const auto in_map =
          sensor.composePoint(mrpt::math::TPoint3D(cloud.x[i], cloud.y[i], cloud.z[i]));
      const Eigen::Vector3d ray = Eigen::Vector3d(in_map.x, in_map.y, in_map.z) - origin;
      const auto hit = scenario->world.castRay(origin, ray.normalized(), 80);
      if (!hit) continue;
      const double along = std::abs(hit->distance - ray.norm());
      near += along * std::abs(hit->normal.dot(ray.normalized())) < 0.05 ? 1 : 0;
    }
    return static_cast<double>(near) / static_cast<double>(cloud.size());
  }

  MappingResult mapped(const std::string& file, bool deskew, const std::string& poses = "") const {
    MappingRequest request;
    request.logs = {file};
    request.config_file = writeConfig(folder, "point_labels = none\nunlabelled_class = wall\n");
    if (!poses.empty()) request.poses = PoseChoice::parse(poses);
    request.deskew = deskew;
    request.keep_key_frames = true;
    return mapLogs(request);
  }
  static std::string computeDigest(const MappingResult& result) {
    return mapDigest(result.map->map());
  }

  const TempFolder folder;
  const std::string log = folder / "drive.rawlog";
  std::optional<Scenario> scenario;
  std::vector<CObservationVelodyneScan::Ptr> scans;
};

TEST_F(DeskewTest, PointsLieOnTheSurfacesThatTheyWereSeenOn) {
  simulate(", sweep: moving");
  DeskewStatistics statistics;
  const auto moved = deskewed(*scans[5], truth(), statistics);
  ASSERT_TRUE(moved);
  EXPECT_EQ(statistics.deskewed, 1U);
  CObservationVelodyneScan as_it_is(*scans[5]);
  CObservationVelodyneScan::TGeneratePointCloudParameters parameters;
  parameters.minDistance = 0;
  as_it_is.generatePointCloud(parameters);
  const auto& still = dynamic_cast<const MovedVelodyneScan&>(*moved);
  const auto& returned = moved->point_cloud;
  std::size_t points = 0;
  std::size_t empty = 0;
  for (const VelodyneBeam& beam : decodePackets(*scans[5])) {
    if (!beam.returned) {
      ASSERT_LT(empty, still.empty_beams.size());
      EXPECT_EQ(still.empty_beams[empty].pixel.column, beam.azimuth);
      EXPECT_NEAR(still.empty_beams[empty++].farthest.norm(), moved->maxRange, 0.5);
      continue;
    }
    ASSERT_LT(points, returned.size());
    EXPECT_EQ(returned.laser_id[points], beam.laser);
    EXPECT_FLOAT_EQ(returned.azimuth[points], 0.01F * static_cast<float>(beam.azimuth));
    EXPECT_EQ(returned.intensity[points++], beam.intensity);
  }
  EXPECT_EQ(points, returned.size());
  EXPECT_EQ(empty, still.empty_beams.size());
  EXPECT_GT(empty, 1000U);
  EXPECT_TRUE(moved->scan_packets.empty());
  EXPECT_EQ(moved->timestamp, scans[5]->timestamp);
  // The rest is seen past edges that hid it from where the turn began.
  EXPECT_GT(shareOnSurfaces(returned, *moved), 0.98);
  EXPECT_LT(shareOnSurfaces(as_it_is.point_cloud, *moved), 0.7)
      << "0.4 m are driven during a turn: the test would not notice";
}

TEST_F(DeskewTest, WhatTheSensorSawAtOnceStaysAsItIs) {
  simulate("");
  DeskewStatistics statistics;
  EXPECT_FALSE(deskewed(*scans[5], truth(), statistics));
  EXPECT_EQ(statistics.not_needed, 1U);
  EXPECT_FALSE(sweepEnd(*scans[5]));
  const MappingResult on = mapped(log, true);
  const MappingResult off = mapped(log, false);
  EXPECT_EQ(on.deskew->not_needed, scans.size());
  EXPECT_FALSE(off.deskew);
  EXPECT_EQ(computeDigest(on), computeDigest(off));
}

TEST_F(DeskewTest, NothingIsMovedWithoutPosesForTheWholeTurn) {
  simulate(", sweep: moving");
  const double start = mrpt::Clock::toDouble(scans[5]->timestamp);
  DeskewStatistics statistics;
  for (const double until : {start - 1, start + 0.05}) {
    const RobotMotion ends = [&](double time) {
      return time <= until ? std::optional<CPose3D>(robotAt(time)) : std::nullopt;
    };
    EXPECT_FALSE(deskewed(*scans[5], ends, statistics));
  }
  EXPECT_EQ(statistics.not_possible, 2U);
  EXPECT_EQ(statistics.deskewed, 0U);

  CObservationVelodyneScan without_packets(*scans[5]);
  without_packets.scan_packets.clear();
  EXPECT_FALSE(deskewed(without_packets, truth(), statistics));
  CObservationVelodyneScan unreadable(*scans[5]);
  unreadable.calibration.laser_corrections.resize(7);
  EXPECT_FALSE(deskewed(unreadable, truth(), statistics)) << "no device has seven lasers";
  EXPECT_EQ(statistics.not_possible + statistics.not_needed + statistics.deskewed, 2U);
}

using Packet = CObservationVelodyneScan::TVelodyneRawPacket;

/// Times of packets lie where MRPT gives no access, or none that C++ defines: behind the blocks.
constexpr std::size_t kPlaceOfTime = 1200;
static_assert(sizeof(Packet) == kPlaceOfTime + 6);

std::uint32_t packetTime(const Packet& packet) {
  std::uint32_t time;
  std::memcpy(&time, reinterpret_cast<const unsigned char*>(&packet) + kPlaceOfTime, sizeof time);
  return time;
}

void setPacketTime(Packet& packet, std::uint32_t time) {
  std::memcpy(reinterpret_cast<unsigned char*>(&packet) + kPlaceOfTime, &time, sizeof time);
}

TEST_F(DeskewTest, TheHourMayEndDuringATurn) {
  simulate(", sweep: moving");
  CObservationVelodyneScan late(*scans[5]);
  constexpr std::uint32_t kHour = 3'600'000'000;
  const std::uint32_t first = packetTime(late.scan_packets.front());
  for (auto& packet : late.scan_packets)
    setPacketTime(packet, (packetTime(packet) - first + kHour - 50'000) % kHour);
  ASSERT_LT(packetTime(late.scan_packets.back()), 60'000U);
  EXPECT_EQ(sweepEnd(late), sweepEnd(*scans[5]));
  DeskewStatistics statistics;
  const auto moved = deskewed(late, truth(), statistics);
  ASSERT_TRUE(moved);
  const auto same = deskewed(*scans[5], truth(), statistics);
  EXPECT_EQ(moved->point_cloud.x, same->point_cloud.x);
  EXPECT_EQ(moved->point_cloud.y, same->point_cloud.y);
}

TEST_F(DeskewTest, ARunCountsItsScansAndItsSimplemapGivesTheSameMap) {
  simulate(", sweep: moving");
  const MappingResult result = mapped(log, true);
  EXPECT_EQ(result.deskew->deskewed, scans.size() - 1);
  EXPECT_EQ(result.deskew->not_possible, 1U) << "the last turn: there is no pose after it";
  EXPECT_THAT(result.warnings, testing::Contains(HasSubstr("1 scans are in the map as if")));
  EXPECT_NE(computeDigest(result), computeDigest(mapped(log, false)));

  ASSERT_TRUE(result.key_frames.saveToFile(folder / "a.simplemap"));
  const MappingResult again = mapped(folder / "a.simplemap", true);
  EXPECT_EQ(computeDigest(again), computeDigest(result));
}

TEST_F(DeskewTest, RegistrationTakesTheMotionOutOfWhatItRegisters) {
  simulate(", sweep: moving, range_sigma: 0.02");
  const MappingResult result = mapped(log, true, "icp");
  EXPECT_EQ(result.deskew->deskewed, scans.size() - 1);
  EXPECT_EQ(result.registration->statistics.doubtful, 0U);
  // The first turns are registered as they are: no motion is known yet that could be taken out.
  constexpr std::size_t kSettled = 3;
  ASSERT_GT(result.trajectory.size(), kSettled + 10);
  const TimedPose& settled = result.trajectory[kSettled];
  for (std::size_t i = kSettled; i < result.trajectory.size(); ++i) {
    const TimedPose& pose = result.trajectory[i];
    const CPose3D truth = robotAt(pose.timestamp) - robotAt(settled.timestamp);
    const Eigen::Vector3d moved = (settled.pose.inverse() * pose.pose).translation();
    EXPECT_LT((moved - Eigen::Vector3d(truth.x(), truth.y(), truth.z())).norm(), 0.15)
        << pose.timestamp - kStart;
  }
}

}  // namespace
}  // namespace csom::test
