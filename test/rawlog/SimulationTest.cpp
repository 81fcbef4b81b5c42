// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/eval/Scenario.h>
#include <csom/io/TrajectoryFile.h>
#include <csom/rawlog/Simulation.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

namespace csom {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using testing::HasSubstr;
using namespace mrpt::obs;

constexpr double kDegree = 3.14159265358979323846 / 180;

class SimulationTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) /
              ("csom_simulation_" + std::string(test->name()) + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// A yard with a wall around it, and things in it.
  Scenario yard(const std::string& robot, const std::string& sensors,
                const std::string& more_solids = "") const {
    std::ofstream(path("world.yaml"))
        << "label_set: " CSOM_SOURCE_DIR "/config/labels/simulator.yaml\n"
        << "seed: 3\ntruth: {resolution: 1, min: [0, 0, 0], max: [1, 1, 1]}\n"
        << "robot:\n"
        << robot << "sensors:\n"
        << sensors << "solids:\n"
        << "  - {shape: ground, class: terrain, center: [0, 0, 0], size: [40, 40]}\n"
        << "  - {shape: box, class: wall, center: [20, 0, 2], size: [1, 41, 5]}\n"
        << "  - {shape: box, class: building, center: [-20, 0, 2], size: [1, 41, 5]}\n"
        << "  - {shape: box, class: fence, center: [0, 20, 2], size: [41, 1, 5]}\n"
        << "  - {shape: box, class: wall, center: [0, -20, 2], size: [41, 1, 5]}\n"
        << "  - {shape: cylinder, class: pole, center: [5, 3, 2], radius: 0.3, height: 4}\n"
        << "  - {shape: box, class: car, center: [6, -5, 0.8], size: [4, 2, 1.4], yaw_deg: 30}\n"
        << "  - {shape: sphere, class: vegetation, center: [-6, 4, 2], radius: 1.5}\n"
        << more_solids;
    return loadScenario(path("world.yaml"));
  }

  fs::path folder_;
};

const std::string kStanding = "  stations: [[1, -2, 25]]\n  dwell: 0.9\n";
const std::string kDriving = "  waypoints: [[-8, 0], [10, 0]]\n  turn_radius: 1\n  speed: 4\n";

std::string lidar(const std::string& more = "") {
  return "  - {type: velodyne_vlp16, label: lidar, pose: [0.2, 0.1, 1.5, 40, 5, -3], rate: 2, "
         "range: [1, 60]" +
         more + "}\n";
}

std::string lidarPoints() {
  return "  - {type: point_sampler, label: points, pose: [0, 0, 1, 0, 0, 0], rate: 2, points: "
         "9000, "
         "elevation_deg: [-20, 20], range: [0.5, 60]}\n";
}

std::string bytesOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

CRawlog load(const std::string& file) {
  CRawlog rawlog;
  EXPECT_TRUE(rawlog.loadFromRawLogFile(file));
  return rawlog;
}

/// All observations of a class, frame by frame.
template <class Observation>
std::vector<typename Observation::Ptr> all(const CRawlog& rawlog) {
  std::vector<typename Observation::Ptr> found;
  for (const auto& entry : rawlog) {
    if (const auto frame = std::dynamic_pointer_cast<CSensoryFrame>(entry)) {
      for (const auto& observation : *frame)
        if (auto match = std::dynamic_pointer_cast<Observation>(observation))
          found.push_back(match);
    } else if (auto match = std::dynamic_pointer_cast<Observation>(entry)) {
      found.push_back(match);
    }
  }
  return found;
}

Eigen::Isometry3d toEigen(const mrpt::poses::CPose3D& pose) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  const auto matrix = pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) out(row, column) = matrix(row, column);
  return out;
}

// --- Velodyne ------------------------------------------------------------------------------------

/// A return as the VLP-16's manual says to read it.
struct Return {
  Vector3d direction;  // x forward, y left
  unsigned distance;   // 2 mm
  unsigned intensity;
};

std::vector<Return> readPackets(const CObservationVelodyneScan& scan) {
  std::vector<Return> returns;
  for (const auto& packet : scan.scan_packets) {
    unsigned char bytes[1206];
    std::memcpy(bytes, &packet, sizeof bytes);
    EXPECT_EQ(bytes[1204], 0x37) << "strongest return";
    EXPECT_EQ(bytes[1205], 0x22) << "VLP-16";
    for (int block = 0; block < 12; ++block) {
      const unsigned char* at = bytes + 100 * block;
      EXPECT_EQ(at[0], 0xff);
      EXPECT_EQ(at[1], 0xee);
      const double block_azimuth = 0.01 * (at[2] + 256 * at[3]);
      for (int i = 0; i < 32; ++i) {
        const int laser = i % 16;
        const double azimuth = block_azimuth + 0.2 * (i / 16) + 0.2 * laser * 2.304 / 55.296;
        const double elevation = laser % 2 == 0 ? -15 + laser : laser;
        returns.push_back({{std::cos(elevation * kDegree) * std::cos(azimuth * kDegree),
                            -std::cos(elevation * kDegree) * std::sin(azimuth * kDegree),
                            std::sin(elevation * kDegree)},
                           at[4 + 3 * i] + 256U * at[5 + 3 * i],
                           at[6 + 3 * i]});
      }
    }
  }
  return returns;
}

TEST_F(SimulationTest, PacketsHoldWhatRaysMeet) {
  const Scenario scenario = yard(kStanding, lidar());
  simulateRawlog(scenario, path("x.rawlog"));
  const CRawlog rawlog = load(path("x.rawlog"));
  const auto scans = all<CObservationVelodyneScan>(rawlog);
  const auto poses = all<CObservationRobotPose>(rawlog);
  ASSERT_EQ(scans.size(), 2U);
  const Eigen::Isometry3d sensor = toEigen(poses[0]->pose.mean) * toEigen(scans[0]->sensorPose);
  const std::vector<Return> returns = readPackets(*scans[0]);
  ASSERT_EQ(returns.size(), 75U * 12 * 32);
  int hits = 0;
  for (const Return& r : returns) {
    const auto hit =
        scenario.world.castRay(sensor.translation(), sensor.linear() * r.direction, 60);
    if (!hit || hit->distance < 1) {
      EXPECT_EQ(r.distance, 0U);
      continue;
    }
    ++hits;
    EXPECT_NEAR(0.002 * r.distance, hit->distance, 0.001 + 1e-6);
    EXPECT_EQ(r.intensity, hit->class_id);
  }
  EXPECT_GT(hits, 20000);
}

TEST_F(SimulationTest, SensorsSeeMovingSolidsWhereTheyAre) {
  const std::string walker =
      "  - {shape: cylinder, class: person, center: [6, -2, 1], radius: 0.4, height: 2, moves: "
      "[[0, 0, 0], [0.9, 0, 3]]}\n";
  const Scenario scenario = yard(kStanding, lidar(", sweep: moving") + lidarPoints(), walker);
  simulateRawlog(scenario, path("x.rawlog"));
  const CRawlog rawlog = load(path("x.rawlog"));
  const ClassId person = *scenario.world.labels().classByName("person");
  const auto poses = all<CObservationRobotPose>(rawlog);
  const auto scans = all<CObservationVelodyneScan>(rawlog);
  ASSERT_EQ(scans.size(), 2U);
  for (std::size_t scan = 0; scan < scans.size(); ++scan) {
    const Eigen::Isometry3d sensor =
        toEigen(poses[0]->pose.mean) * toEigen(scans[scan]->sensorPose);
    const std::vector<Return> returns = readPackets(*scans[scan]);
    std::size_t on_person = 0;
    for (std::size_t i = 0; i < returns.size(); ++i) {
      if (returns[i].intensity != person) continue;
      ++on_person;
      // 16 lasers fire at once, 55.296 µs after those before.
      const double time = 0.5 * static_cast<double>(scan) + static_cast<double>(i / 16) * 55.296e-6;
      const Vector3d hit = sensor * (0.002 * returns[i].distance * returns[i].direction);
      const Vector3d beside = hit - Vector3d(6, -2 + time / 0.9 * 3, hit.z());
      EXPECT_NEAR(beside.norm(), 0.4, 0.01) << time;
    }
    EXPECT_GT(on_person, 50U);
  }
  const auto clouds = all<mrpt::obs::CObservationPointCloud>(rawlog);
  ASSERT_EQ(clouds.size(), 2U);
  const auto& cloud = dynamic_cast<const mrpt::maps::CPointsMapXYZI&>(*clouds[1]->pointcloud);
  const Eigen::Isometry3d sensor = toEigen(poses[0]->pose.mean) * toEigen(clouds[1]->sensorPose);
  std::size_t on_person = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.getPointIntensity(i) != static_cast<float>(person)) continue;
    ++on_person;
    mrpt::math::TPoint3Df p;
    cloud.getPoint(i, p.x, p.y, p.z);
    const Vector3d hit = sensor * Vector3d(p.x, p.y, p.z);
    EXPECT_NEAR((hit - Vector3d(6, -2 + 0.5 / 0.9 * 3, hit.z())).norm(), 0.4, 0.01);
  }
  EXPECT_GT(on_person, 20U);
}

TEST_F(SimulationTest, StockDecoderGivesThePointsBack) {
  const Scenario scenario = yard(kStanding, lidar());
  simulateRawlog(scenario, path("x.rawlog"));
  const CRawlog rawlog = load(path("x.rawlog"));
  const auto scan = all<CObservationVelodyneScan>(rawlog).at(0);
  const auto pose = all<CObservationRobotPose>(rawlog).at(0);
  const Eigen::Isometry3d sensor = toEigen(pose->pose.mean) * toEigen(scan->sensorPose);
  scan->generatePointCloud();
  const auto& cloud = scan->point_cloud;
  ASSERT_GT(cloud.size(), 10000U);
  std::size_t good = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vector3d point(cloud.x[i], cloud.y[i], cloud.z[i]);
    const auto hit =
        scenario.world.castRay(sensor.translation(), sensor.linear() * point.normalized(), 60);
    if (!hit) continue;
    // The decoder rounds azimuths to 0.01°; on a slanted surface that changes the distance.
    const double slant = std::abs(hit->normal.dot(sensor.linear() * point.normalized()));
    const double tolerance = 0.002 + 0.015 * kDegree * hit->distance / std::max(slant, 0.01);
    good +=
        std::abs(hit->distance - point.norm()) < tolerance && hit->class_id == cloud.intensity[i];
  }
  EXPECT_GT(static_cast<double>(good), 0.998 * static_cast<double>(cloud.size()))
      << "all but rays that pass the very edge of a solid";
}

/// Copied out, since the field is not aligned.
std::uint32_t gpsTime(const CObservationVelodyneScan::TVelodyneRawPacket& packet) {
  std::uint32_t time = 0;
  std::memcpy(&time, reinterpret_cast<const char*>(&packet) + 1200, sizeof time);
  return time;
}

TEST_F(SimulationTest, PacketsOfAnInstantaneousTurnHaveOneTime) {
  simulateRawlog(yard(kStanding, lidar()), path("x.rawlog"));
  for (const auto& scan : all<CObservationVelodyneScan>(load(path("x.rawlog")))) {
    for (const auto& packet : scan->scan_packets)
      EXPECT_EQ(gpsTime(packet), gpsTime(scan->scan_packets.front()));
  }
}

TEST_F(SimulationTest, PacketTimesFollowTheRotation) {
  simulateRawlog(yard(kStanding, lidar(", sweep: moving")), path("x.rawlog"));
  const auto scans = all<CObservationVelodyneScan>(load(path("x.rawlog")));
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const auto& packets = scans[i]->scan_packets;
    ASSERT_EQ(packets.size(), 75U);
    EXPECT_EQ(gpsTime(packets[0]), 500000U * i);
    for (std::size_t k = 0; k < packets.size(); ++k) {
      const auto since_start = gpsTime(packets[k]) - gpsTime(packets[0]);
      EXPECT_NEAR(since_start, 1327.104 * static_cast<double>(k), 0.51);
    }
  }
  EXPECT_NEAR(
      mrpt::Clock::toDouble(scans[1]->timestamp) - mrpt::Clock::toDouble(scans[0]->timestamp), 0.5,
      1e-6);
}

TEST_F(SimulationTest, RangeNoiseHasItsStandardDeviation) {
  const Scenario exact = yard(kStanding, lidar());
  simulateRawlog(exact, path("exact.rawlog"));
  simulateRawlog(yard(kStanding, lidar(", range_sigma: 0.05")), path("noisy.rawlog"));
  const auto a = readPackets(*all<CObservationVelodyneScan>(load(path("exact.rawlog"))).at(0));
  const auto b = readPackets(*all<CObservationVelodyneScan>(load(path("noisy.rawlog"))).at(0));
  double sum = 0;
  double squares = 0;
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].distance < 1000 || b[i].distance == 0) continue;
    const double error = 0.002 * (static_cast<double>(b[i].distance) - a[i].distance);
    EXPECT_EQ(a[i].intensity, b[i].intensity);
    sum += error;
    squares += error * error;
    ++count;
  }
  ASSERT_GT(count, 15000);
  EXPECT_NEAR(sum / count, 0, 0.002);
  EXPECT_NEAR(std::sqrt(squares / count), 0.05, 0.002);
}

TEST_F(SimulationTest, MovingSweepIsSeenFromWhereTheRobotIs) {
  const Scenario scenario = yard(kDriving, lidar(", sweep: moving"));
  simulateRawlog(scenario, path("x.rawlog"));
  const auto scan = all<CObservationVelodyneScan>(load(path("x.rawlog"))).at(1);
  const std::vector<Return> returns = readPackets(*scan);
  const Eigen::Isometry3d mount = toEigen(scan->sensorPose);
  int hits = 0;
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const double time = 0.5 + static_cast<double>(i / 16) * 55.296e-6;
    Eigen::Isometry3d robot = Eigen::Isometry3d::Identity();
    robot.translation().x() = -8 + 4 * time;
    const Eigen::Isometry3d sensor = robot * mount;
    const auto hit =
        scenario.world.castRay(sensor.translation(), sensor.linear() * returns[i].direction, 60);
    if (!hit || hit->distance < 1.01 || returns[i].distance == 0) continue;
    const double slant = std::abs(hit->normal.dot(sensor.linear() * returns[i].direction));
    hits += std::abs(hit->distance - 0.002 * returns[i].distance) < 0.001 + 1e-5 / slant;
  }
  EXPECT_GT(hits, 20000);
}

TEST_F(SimulationTest, ReflectivityDependsOnColourAndAngle) {
  const std::string white =
      "  - {shape: box, class: wall, center: [0, 0, 30], size: [60, 60, 1], color: [255, 255, "
      "255]}\n";
  const Scenario scenario = yard(kStanding, lidar(", intensity: reflectivity"), white);
  simulateRawlog(scenario, path("x.rawlog"));
  const auto scan = all<CObservationVelodyneScan>(load(path("x.rawlog"))).at(0);
  unsigned low = 255;
  unsigned high = 0;
  for (const Return& r : readPackets(*scan)) {
    if (r.distance == 0) continue;
    low = std::min(low, r.intensity);
    high = std::max(high, r.intensity);
  }
  EXPECT_LT(low, 40U);
  EXPECT_GT(high, 150U);
}

// --- camera --------------------------------------------------------------------------------------

TEST_F(SimulationTest, PixelsHoldTheColourAndClassOfWhatTheySee) {
  const Scenario scenario =
      yard(kStanding,
           "  - {type: camera, label: eye, pose: [0.3, 0, 1.4, 10, 5, 0], rate: 1, width: 96, "
           "height: 64, horizontal_fov_deg: 80}\n");
  simulateRawlog(scenario, path("x.rawlog"));
  const CRawlog rawlog = load(path("x.rawlog"));
  const auto images = all<CObservationImage>(rawlog);
  ASSERT_EQ(images.size(), 2U);
  const CObservationImage& picture = *images[0];
  const CObservationImage& classes = *images[1];
  EXPECT_EQ(picture.sensorLabel, "eye");
  EXPECT_EQ(classes.sensorLabel, "eye_labels");
  EXPECT_TRUE(picture.image.isColor());
  EXPECT_FALSE(classes.image.isColor());
  EXPECT_EQ(picture.cameraParams.ncols, 96U);
  EXPECT_EQ(picture.cameraParams.nrows, 64U);

  const Eigen::Isometry3d camera =
      toEigen(all<CObservationRobotPose>(rawlog).at(0)->pose.mean) * toEigen(classes.cameraPose);
  const auto& k = classes.cameraParams;
  std::size_t sky = 0;
  std::set<unsigned> seen;
  for (unsigned v = 0; v < 64; ++v)
    for (unsigned u = 0; u < 96; ++u) {
      const Vector3d ray((u - k.cx()) / k.fx(), (v - k.cy()) / k.fy(), 1);
      const auto hit =
          scenario.world.castRay(camera.translation(), (camera.linear() * ray).normalized(), 100);
      const unsigned id = classes.image.at<std::uint8_t>(u, v);
      EXPECT_EQ(id, hit ? hit->class_id : kFreeClass) << u << " " << v;
      const unsigned blue = picture.image.at<std::uint8_t>(u, v, 0);
      const unsigned red = picture.image.at<std::uint8_t>(u, v, 2);
      if (!hit) {
        ++sky;
        EXPECT_GT(blue, red);
        continue;
      }
      seen.insert(id);
      const double light = red / static_cast<double>(hit->color[0]);
      EXPECT_GT(light, 0.5);
      EXPECT_LT(light, 1.01);
      EXPECT_NEAR(blue, light * hit->color[2], 4);
    }
  EXPECT_GT(sky, 500U);
  EXPECT_GE(seen.size(), 3U);
}

// --- points --------------------------------------------------------------------------------------

TEST_F(SimulationTest, SampledPointsLieOnSurfacesOfTheirClass) {
  const Scenario scenario = yard(
      kStanding,
      "  - {type: point_sampler, pose: [0, 0, 1, 30, 0, 0], rate: 2, points: 800, range: [0.5, 25],"
      " elevation_deg: [-30, 10]}\n");
  const SimulationSummary summary = simulateRawlog(scenario, path("x.rawlog"));
  EXPECT_EQ(summary.frames, 2U);
  EXPECT_EQ(summary.returns, 1600U);
  const CRawlog rawlog = load(path("x.rawlog"));
  const auto clouds = all<CObservationPointCloud>(rawlog);
  ASSERT_EQ(clouds.size(), 2U);
  const auto poses = all<CObservationRobotPose>(rawlog);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto points =
        std::dynamic_pointer_cast<mrpt::maps::CPointsMapXYZI>(clouds[i]->pointcloud);
    ASSERT_TRUE(points);
    ASSERT_EQ(points->size(), 800U);
    EXPECT_EQ(points->getPointsBufferRef_intensity().size(), 800U);
    const Eigen::Isometry3d sensor = toEigen(poses[i]->pose.mean) * toEigen(clouds[i]->sensorPose);
    for (std::size_t n = 0; n < points->size(); ++n) {
      float x, y, z;
      points->getPoint(n, x, y, z);
      const Vector3d point(x, y, z);
      const double elevation = std::asin(z / point.norm()) / kDegree;
      EXPECT_GE(elevation, -30.001);
      EXPECT_LE(elevation, 10.001);
      EXPECT_GE(point.norm(), 0.5);
      EXPECT_LE(point.norm(), 25.0001);
      const Vector3d before = sensor * (point - 1e-4 * point.normalized());
      const Vector3d after = sensor * (point + 1e-4 * point.normalized());
      EXPECT_EQ(scenario.world.classAt(before), kFreeClass);
      EXPECT_EQ(scenario.world.classAt(after), points->getPointIntensity(n));
    }
  }
}

TEST_F(SimulationTest, ASamplerThatSeesNothingIsAnError) {
  const Scenario scenario = yard(kStanding,
                                 "  - {type: point_sampler, pose: [0, 0, 1, 0, 0, 0], rate: 2, "
                                 "points: 5, range: [0.1, 0.2]}\n");
  EXPECT_THROW(simulateRawlog(scenario, path("x.rawlog")), ConfigError);
  EXPECT_FALSE(fs::exists(path("x.rawlog")));
}

// --- poses ---------------------------------------------------------------------------------------

const std::string kCheapSensor =
    "  - {type: point_sampler, pose: [0, 0, 1, 0, 0, 0], rate: 100, points: 1, range: [0, 90]}\n";

TEST_F(SimulationTest, OdometryErrorsAreThoseOfTheNoiseModel) {
  const Scenario scenario = yard(
      "  waypoints: [[-15, -15], [15, -15], [15, 15], [-15, 15], [-15, -10]]\n"
      "  turn_radius: 5\n  speed: 5\n"
      "  odometry: {translation_per_metre: 0.1, rotation_per_metre: 2, rotation_per_degree: 0.2}\n",
      kCheapSensor);
  simulateRawlog(scenario, path("x.rawlog"));
  const CRawlog rawlog = load(path("x.rawlog"));
  const auto poses = all<CObservationRobotPose>(rawlog);
  ASSERT_EQ(rawlog.size(), 2 * poses.size());
  double xy = 0;
  double phi = 0;
  double mean = 0;
  const std::size_t count = poses.size() - 1;
  ASSERT_GT(count, 1500U);
  for (std::size_t i = 1; i <= count; ++i) {
    const auto action = rawlog.getAsAction(2 * i)->getBestMovementEstimation();
    ASSERT_TRUE(action);
    const mrpt::poses::CPose2D before(poses[i - 1]->pose.mean);
    const mrpt::poses::CPose2D now(poses[i]->pose.mean);
    const mrpt::poses::CPose2D truth = now - before;
    const mrpt::poses::CPose2D& read = action->rawOdometryIncrementReading;
    const double sigma_xy = 0.1 * truth.norm();
    const double sigma_phi = 2 * kDegree * truth.norm() + 0.2 * std::abs(truth.phi());
    xy += (std::pow(read.x() - truth.x(), 2) + std::pow(read.y() - truth.y(), 2)) /
          (2 * sigma_xy * sigma_xy);
    phi += std::pow((read.phi() - truth.phi()) / sigma_phi, 2);
    mean += (read.phi() - truth.phi()) / sigma_phi;
  }
  const double n = static_cast<double>(count);
  EXPECT_NEAR(xy / n, 1, 0.1);
  EXPECT_NEAR(phi / n, 1, 0.12);
  EXPECT_NEAR(mean / n, 0, 0.1);
}

TEST_F(SimulationTest, ParticleFiltersLearnTheUncertaintyOfAnIncrement) {
  const Scenario scenario = yard(
      "  waypoints: [[-15, 0], [15, 0]]\n  turn_radius: 5\n  speed: 50\n"
      "  odometry: {translation_per_metre: 0.1, rotation_per_metre: 2}\n",
      kCheapSensor);
  simulateRawlog(scenario, path("x.rawlog"));
  const auto action = load(path("x.rawlog")).getAsAction(4)->getBestMovementEstimation();
  ASSERT_TRUE(action);
  mrpt::poses::CPosePDFGaussian pdf;
  pdf.copyFrom(*action->poseChange);
  EXPECT_NEAR(std::sqrt(pdf.cov(0, 0)), 0.1 * 0.5, 0.012);
  EXPECT_NEAR(std::sqrt(pdf.cov(2, 2)), 2 * kDegree * 0.5, 0.004);
}

TEST_F(SimulationTest, WithoutNoiseOdometryIsTheTruth) {
  SimulationOptions options;
  options.format = RawlogFormat::Observations;
  simulateRawlog(yard(kDriving, kCheapSensor), path("x.rawlog"), options);
  const CRawlog rawlog = load(path("x.rawlog"));
  const auto odometry = all<CObservationOdometry>(rawlog);
  const auto truth = all<CObservationRobotPose>(rawlog);
  ASSERT_EQ(odometry.size(), truth.size());
  ASSERT_EQ(odometry.size(), 450U);
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    EXPECT_EQ(truth[i]->sensorLabel, kTruthPoseLabel);
    EXPECT_EQ(truth[i]->timestamp, odometry[i]->timestamp);
    EXPECT_NEAR(odometry[i]->odometry.x(), truth[i]->pose.mean.x() + 8, 1e-5);
    EXPECT_NEAR(odometry[i]->odometry.y(), 0, 1e-5);
  }
}

TEST_F(SimulationTest, TrajectoryHoldsTheTruePoses) {
  SimulationOptions options;
  options.trajectory_file = path("x.tum");
  simulateRawlog(yard("  waypoints: [[-8, 0], [10, 0], [10, 9]]\n  turn_radius: 3\n  speed: 4\n",
                      kCheapSensor),
                 path("x.rawlog"), options);
  const auto poses = all<CObservationRobotPose>(load(path("x.rawlog")));
  const std::vector<TimedPose> trajectory = readTumTrajectory(path("x.tum"));
  ASSERT_EQ(trajectory.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_NEAR(trajectory[i].timestamp, mrpt::Clock::toDouble(poses[i]->timestamp), 2e-6);
    EXPECT_LT((trajectory[i].pose.matrix() - toEigen(poses[i]->pose.mean).matrix()).norm(), 1e-5);
  }
}

// --- files ---------------------------------------------------------------------------------------

TEST_F(SimulationTest, BothFormatsHoldTheSameObservations) {
  const std::string sensors = lidar(", range_sigma: 0.02") + kCheapSensor;
  const Scenario scenario = yard(kDriving, sensors);
  SimulationOptions options;
  simulateRawlog(scenario, path("frames.rawlog"), options);
  options.format = RawlogFormat::Observations;
  simulateRawlog(scenario, path("observations.rawlog"), options);
  const CRawlog frames = load(path("frames.rawlog"));
  const CRawlog observations = load(path("observations.rawlog"));
  EXPECT_EQ(frames.getType(0), CRawlog::etActionCollection);
  EXPECT_EQ(frames.getType(1), CRawlog::etSensoryFrame);
  EXPECT_EQ(observations.getType(0), CRawlog::etObservation);
  const auto a = all<CObservationVelodyneScan>(frames);
  const auto b = all<CObservationVelodyneScan>(observations);
  ASSERT_EQ(a.size(), 9U);
  ASSERT_EQ(b.size(), 9U);
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_EQ(std::memcmp(a[i]->scan_packets.data(), b[i]->scan_packets.data(), 75 * 1206), 0);
}

TEST_F(SimulationTest, SameSeedSameBytesOtherSeedOtherBytes) {
  Scenario scenario = yard(kDriving, lidar(", range_sigma: 0.02") + kCheapSensor);
  simulateRawlog(scenario, path("a.rawlog"));
  simulateRawlog(scenario, path("b.rawlog"));
  ++scenario.seed;
  simulateRawlog(scenario, path("c.rawlog"));
  EXPECT_TRUE(bytesOf(path("a.rawlog")) == bytesOf(path("b.rawlog")));
  EXPECT_FALSE(bytesOf(path("a.rawlog")) == bytesOf(path("c.rawlog")));
}

TEST_F(SimulationTest, ShippedRawlogsAreWhatTheirWorldsGive) {
  for (const std::string name : {"room", "campus"}) {
    const std::string source = CSOM_SOURCE_DIR;
    simulateRawlog(loadScenario(source + "/config/worlds/" + name + ".yaml"), path(name));
    EXPECT_TRUE(bytesOf(path(name)) == bytesOf(source + "/rawlogs/" + name + ".rawlog"))
        << name << ": simulate it again, see rawlogs/README.md";
  }
}

TEST_F(SimulationTest, ASensorInsideASolidIsAnError) {
  const Scenario scenario =
      yard(kDriving, kCheapSensor,
           "  - {shape: box, class: clutter, center: [4, 0, 1], size: [1, 1, 1]}\n");
  try {
    simulateRawlog(scenario, path("x.rawlog"));
    FAIL() << "drove through a box";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("world.yaml: sensor 'points' is inside solid 9 (clutter)"));
  }
  EXPECT_FALSE(fs::exists(path("x.rawlog"))) << "nothing half written";
}

TEST_F(SimulationTest, AFileThatCannotBeWrittenIsAnError) {
  EXPECT_THROW(simulateRawlog(yard(kStanding, kCheapSensor), path("no/such/folder/x.rawlog")),
               FileError);
}

}  // namespace
}  // namespace csom
