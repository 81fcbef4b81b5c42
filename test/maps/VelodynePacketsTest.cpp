// SPDX-License-Identifier: BSD-3-Clause
// Packets of Velodynes are read as their manuals say.
#include <csom/maps/VelodynePackets.h>
#include <gmock/gmock.h>
#include <mrpt/obs/CRawlog.h>

#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace csom {
namespace {

using mrpt::obs::CObservationVelodyneScan;
using mrpt::obs::VelodyneCalibration;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kDegree = M_PI / 180;
constexpr int kBlocks = 12;
constexpr int kReturns = 32;
constexpr unsigned kUpper = 0xeeff;
constexpr unsigned kLower = 0xddff;

/// One UDP payload, byte by byte.
class Packet {
 public:
  Packet& block(int block, unsigned header, unsigned azimuth) {
    put16(at(block), header);
    put16(at(block) + 2, azimuth);
    return *this;
  }
  Packet& give(int block, int k, unsigned distance, unsigned intensity = 0) {
    const std::size_t place = at(block) + 4 + 3 * static_cast<std::size_t>(k);
    put16(place, distance);
    bytes_[place + 2] = static_cast<unsigned char>(intensity);
    return *this;
  }
  Packet& status(std::uint32_t microseconds,
                 unsigned mode = CObservationVelodyneScan::RETMODE_LAST) {
    put16(1200, microseconds & 0xffff);
    put16(1202, microseconds >> 16);
    bytes_[1204] = static_cast<unsigned char>(mode);
    return *this;
  }
  CObservationVelodyneScan::TVelodyneRawPacket raw() const {
    CObservationVelodyneScan::TVelodyneRawPacket packet;
    static_assert(sizeof packet == 1206);
    std::memcpy(static_cast<void*>(&packet), bytes_.data(), bytes_.size());
    return packet;
  }

 private:
  static std::size_t at(int block) { return 100 * static_cast<std::size_t>(block); }
  void put16(std::size_t place, unsigned value) {
    bytes_[place] = static_cast<unsigned char>(value & 0xff);
    bytes_[place + 1] = static_cast<unsigned char>(value >> 8);
  }
  std::array<unsigned char, 1206> bytes_{};
};

/// Blocks of a sensor that turns by `turn` hundredths of a degree from one to the next.
Packet turning(unsigned first_azimuth, unsigned turn) {
  Packet packet;
  for (int block = 0; block < kBlocks; ++block)
    packet.block(block, kUpper, (first_azimuth + turn * static_cast<unsigned>(block)) % 36000);
  return packet.status(0);
}

CObservationVelodyneScan scanOf(const std::string& model, const std::vector<Packet>& packets) {
  CObservationVelodyneScan scan;
  scan.minRange = 0.5;
  scan.maxRange = 100;
  scan.calibration = VelodyneCalibration::LoadDefaultCalibration(model);
  for (const Packet& packet : packets) scan.scan_packets.push_back(packet.raw());
  return scan;
}

/// Beam k of a block, of one packet and one return mode.
const VelodyneBeam& beamOf(const std::vector<VelodyneBeam>& beams, int block, int k) {
  return beams.at(static_cast<std::size_t>(block * kReturns + k));
}

void expectAt(const Eigen::Vector3f& point, double range, double azimuth, double elevation) {
  const Eigen::Vector3d expected(
      range * std::cos(elevation * kDegree) * std::cos(azimuth * kDegree),
      -range * std::cos(elevation * kDegree) * std::sin(azimuth * kDegree),
      range * std::sin(elevation * kDegree));
  EXPECT_LT((point.cast<double>() - expected).norm(), 2e-4 * range)
      << point.transpose() << " against " << expected.transpose();
}

TEST(VelodynePackets, BothFiringsOfABlockOfAVlp16) {
  Packet packet = turning(35980, 40);
  packet.give(0, 5, 5000, 77).give(0, 16 + 5, 6000).give(1, 15, 1000);
  const auto beams = decodePackets(scanOf("VLP16", {packet}));
  ASSERT_EQ(beams.size(), 384U);
  const VelodyneBeam& first = beamOf(beams, 0, 5);
  ASSERT_TRUE(first.returned);
  EXPECT_EQ(first.intensity, 77);
  EXPECT_EQ(first.laser, 5);
  EXPECT_EQ(first.azimuth, 35980 + 4) << "40 · 5 · 2.304 / 110.592 hundredths later";
  expectAt(first.point, 10, 359.84, 5);
  const VelodyneBeam& second = beamOf(beams, 0, 21);
  ASSERT_TRUE(second.returned);
  EXPECT_EQ(second.laser, 5);
  EXPECT_EQ(second.azimuth, (35980 + 20 + 4) % 36000) << "half a block later, over the seam";
  expectAt(second.point, 12, 0.04, 5);
  expectAt(beamOf(beams, 1, 15).point, 2, 0.33, 15);
  EXPECT_NEAR(second.seconds - first.seconds, 55.296e-6, 1e-8);
  EXPECT_NEAR(beamOf(beams, 1, 15).seconds, 110.592e-6 + 15 * 2.304e-6, 1e-8);
  // The others are directions.
  EXPECT_FALSE(beamOf(beams, 2, 0).returned);
  expectAt(beamOf(beams, 2, 0).point, 1, 0.6, -15);
}

TEST(VelodynePackets, AllLasersOfAnHdl32) {
  Packet packet = turning(9000, 16);
  packet.give(0, 0, 5000).give(5, 31, 5000);
  const CObservationVelodyneScan scan = scanOf("HDL32", {packet});
  const auto beams = decodePackets(scan);
  ASSERT_EQ(beams.size(), 384U);
  const auto& lasers = scan.calibration.laser_corrections;
  expectAt(beamOf(beams, 0, 0).point, 10, 90, lasers[0].verticalCorrection);
  EXPECT_EQ(beamOf(beams, 5, 31).laser, 31);
  expectAt(beamOf(beams, 5, 31).point, 10, 90 + 0.01 * (5 * 16 + 12),
           lasers[31].verticalCorrection);
  EXPECT_NEAR(beamOf(beams, 5, 31).seconds, 5 * 46.08e-6 + 31 * 1.152e-6, 1e-8);
}

TEST(VelodynePackets, BothBanksOfAnHdl64WithItsCorrections) {
  Packet packet;
  for (int block = 0; block < kBlocks; ++block)
    packet.block(block, block % 2 == 0 ? kUpper : kLower,
                 18000 + 17 * static_cast<unsigned>(block / 2));
  packet.give(2, 5, 5000).give(3, 5, 5000).status(0);
  CObservationVelodyneScan scan = scanOf("VLP16", {packet, Packet(packet).status(288)});
  auto& lasers = scan.calibration.laser_corrections;
  lasers.assign(64, {});
  VelodyneCalibration::PerLaserCalib& upper = lasers[5];
  upper = {};
  upper.verticalCorrection = -10;
  upper.sinVertCorrection = std::sin(-10 * kDegree);
  upper.cosVertCorrection = std::cos(-10 * kDegree);
  upper.azimuthCorrection = 4;
  upper.distanceCorrection = 1.5;
  upper.verticalOffsetCorrection = 0.2;
  upper.horizontalOffsetCorrection = 0.03;
  const auto beams = decodePackets(scan);
  ASSERT_EQ(beams.size(), 768U);
  EXPECT_EQ(beamOf(beams, 2, 5).laser, 5);
  EXPECT_EQ(beamOf(beams, 3, 5).laser, 37);
  EXPECT_NEAR(beamOf(beams, 2, 5).seconds, 288e-6 / 6, 1e-8);
  expectAt(beamOf(beams, 3, 5).point, 10, 180.17, 0);
  // 11.5 m ahead, the laser 20 cm above that line and 3 cm beside it, turned back by 4°.
  EXPECT_EQ(beamOf(beams, 2, 5).azimuth, 18017 - 400);
  const double azimuth = 176.17 * kDegree;
  const double ahead = 11.5 * std::cos(-10 * kDegree) - 0.2 * std::sin(-10 * kDegree);
  const Eigen::Vector3d expected(ahead * std::cos(azimuth) + 0.03 * std::sin(azimuth),
                                 -ahead * std::sin(azimuth) + 0.03 * std::cos(azimuth),
                                 11.5 * std::sin(-10 * kDegree) + 0.2 * std::cos(-10 * kDegree));
  EXPECT_LT((beamOf(beams, 2, 5).point.cast<double>() - expected).norm(), 1e-4);

  // The same calibration from a YAML file has radians.
  for (auto& laser : lasers) {
    laser.verticalCorrection *= kDegree;
    laser.azimuthCorrection *= kDegree;
  }
  EXPECT_EQ(beamOf(decodePackets(scan), 2, 5).azimuth, 18017 - 400);
}

TEST(VelodynePackets, TheSecondOfTwoReturnsIsABeamIfItDiffers) {
  Packet packet;
  for (int block = 0; block < kBlocks; ++block)
    packet.block(block, kUpper, 1000 + 40 * static_cast<unsigned>(block / 2));
  packet.status(0, CObservationVelodyneScan::RETMODE_DUAL);
  packet.give(0, 0, 5000).give(1, 0, 2500);  // last and strongest
  packet.give(2, 0, 5000).give(3, 0, 5000);
  const auto beams = decodePackets(scanOf("VLP16", {packet}));
  std::vector<std::pair<unsigned, float>> of_first_laser;
  for (const VelodyneBeam& beam : beams)
    if (beam.returned) of_first_laser.emplace_back(beam.azimuth, beam.point.norm());
  EXPECT_THAT(of_first_laser, ElementsAre(testing::Pair(1000, testing::FloatNear(10, 1e-4F)),
                                          testing::Pair(1000, testing::FloatNear(5, 1e-4F)),
                                          testing::Pair(1040, testing::FloatNear(10, 1e-4F))));
}

TEST(VelodynePackets, WhatTheSensorCannotMeasureIsNoReturn) {
  Packet packet = turning(0, 40);
  packet.give(0, 0, 249).give(0, 2, 251).give(0, 4, 49999).give(0, 6, 50001);  // 0.5 m, 100 m
  const auto beams = decodePackets(scanOf("VLP16", {packet}));
  EXPECT_FALSE(beamOf(beams, 0, 0).returned);
  EXPECT_TRUE(beamOf(beams, 0, 0).point.isZero()) << "something is there: not a free direction";
  EXPECT_TRUE(beamOf(beams, 0, 2).returned);
  EXPECT_TRUE(beamOf(beams, 0, 4).returned);
  EXPECT_FALSE(beamOf(beams, 0, 6).returned);
  EXPECT_NEAR(beamOf(beams, 0, 6).point.norm(), 1, 1e-6);
}

TEST(VelodynePackets, DamageIsToldByPacketAndBlock) {
  const auto decoding = [](const CObservationVelodyneScan& scan) {
    return [&scan] { decodePackets(scan); };
  };
  const Packet good = turning(0, 40);
  const auto header = scanOf("VLP16", {good, Packet(good).block(7, 0x1234, 280)});
  EXPECT_THAT(decoding(header), ThrowsMessage<std::runtime_error>(
                                    HasSubstr("packet 1, block 7: it begins with 0x1234")));
  const auto lower = scanOf("HDL32", {Packet(good).block(0, kLower, 0)});
  EXPECT_THAT(decoding(lower), ThrowsMessage<std::runtime_error>(HasSubstr("packet 0, block 0")));
  const auto azimuth = scanOf("VLP16", {Packet(good).block(3, kUpper, 36000)});
  EXPECT_THAT(decoding(azimuth),
              ThrowsMessage<std::runtime_error>(HasSubstr("block 3: the azimuth is 36000")));
  auto lasers = scanOf("VLP16", {good});
  lasers.calibration.laser_corrections.resize(7);
  EXPECT_THAT(decoding(lasers), ThrowsMessage<std::runtime_error>(HasSubstr("has 7 lasers")));
  auto turned = scanOf("VLP16", {good});
  turned.calibration.laser_corrections[4].azimuthCorrection = NAN;
  EXPECT_THAT(decoding(turned), ThrowsMessage<std::runtime_error>(HasSubstr("turns a laser")));
  EXPECT_TRUE(decodePackets(scanOf("VLP16", {})).empty());
}

TEST(VelodynePackets, TheHourMayEndDuringATurn) {
  const Packet last = turning(0, 40).status(3'599'999'500);
  const Packet next = turning(480, 40).status(827);
  const auto beams = decodePackets(scanOf("VLP16", {last, next}));
  EXPECT_NEAR(beams[384].seconds, 1327e-6, 1e-7);
}

TEST(VelodynePackets, RowsAreInTheOrderOfElevations) {
  const auto rows = rowsOfLasers(VelodyneCalibration::LoadDefaultCalibration("VLP16"));
  EXPECT_THAT(rows, ElementsAre(0, 8, 1, 9, 2, 10, 3, 11, 4, 12, 5, 13, 6, 14, 7, 15));
}

/// A scan that somebody has recorded: what MRPT makes of its first firings, at the same places.
TEST(VelodynePackets, ARecordedScanIsWhereMrptHasIt) {
  mrpt::obs::CRawlog log;
  ASSERT_TRUE(log.loadFromRawLogFile("/usr/share/mrpt/datasets/test_velodyne_VLP16.rawlog"));
  const auto scan = std::dynamic_pointer_cast<CObservationVelodyneScan>(log.getAsObservation(0));
  const auto beams = decodePackets(*scan);
  EXPECT_EQ(beams.size(), 384 * scan->scan_packets.size());

  CObservationVelodyneScan::TGeneratePointCloudParameters parameters;
  parameters.minDistance = 0;
  scan->generatePointCloud(parameters);
  const auto& cloud = scan->point_cloud;
  std::size_t first_firings = 0;
  std::size_t second_firings = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (!beams[i].returned) continue;
    if (i % 32 >= 16) {
      ++second_firings;
      continue;
    }
    ASSERT_LT(first_firings, cloud.size());
    const Eigen::Vector3f theirs(cloud.x[first_firings], cloud.y[first_firings],
                                 cloud.z[first_firings]);
    // MRPT's table of sines has 36000 steps on 359.99°, and halves are rounded another way.
    EXPECT_LT((beams[i].point - theirs).norm(), 4e-4F * theirs.norm());
    EXPECT_EQ(beams[i].intensity, cloud.intensity[first_firings]);
    ++first_firings;
  }
  EXPECT_EQ(first_firings, cloud.size());
  EXPECT_NEAR(static_cast<double>(second_firings), static_cast<double>(first_firings),
              0.02 * static_cast<double>(first_firings));
}

}  // namespace
}  // namespace csom
