// SPDX-License-Identifier: BSD-3-Clause
// A VLP-16's turn as the 75 UDP payloads that the device would send (VLP-16 User Manual, ch. 9).
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>

#include "simulate/SimulatedSensors.h"

namespace csom::detail {
namespace {

using Eigen::Vector3d;
using mrpt::obs::CObservationVelodyneScan;
using Packet = CObservationVelodyneScan::TVelodyneRawPacket;

constexpr int kPackets = 75;
constexpr int kBlocks = 12;          // of a packet
constexpr int kFiringsPerBlock = 2;  // two sequences of 16 lasers share a block and its azimuth
constexpr int kLasers = 16;
constexpr int kReturnBytes = 3;  // distance u16, intensity u8
constexpr int kBlockBytes = 4 + kFiringsPerBlock * kLasers * kReturnBytes;
constexpr int kPacketBytes = kBlocks * kBlockBytes + 6;
static_assert(sizeof(Packet) == kPacketBytes, "the payload of a VLP-16 has 1206 bytes");

constexpr double kFiringPeriod = 55.296e-6;  // [s] from one sequence of 16 lasers to the next
constexpr double kLaserPeriod = 2.304e-6;    // [s] from one laser to the next
constexpr double kDistanceUnit = 0.002;      // [m]
/// 900 blocks a turn: 0.4° from block to block, in the azimuth's unit of 0.01°.
constexpr int kAzimuthPerBlock = 36000 / (kPackets * kBlocks);
constexpr double kDegree = 3.14159265358979323846 / 180;

/// Lasers fire alternately from the lower and the upper half: −15°, 1°, −13°, 3°, … −1°, 15°.
double elevationOf(int laser) {
  return (laser % 2 == 0 ? laser - 15 : laser) * kDegree;
}

/// Where a laser points at its firing, in the sensor's frame (x forward, y left). The device turns
/// clockwise and goes on turning between the lasers of a block.
Vector3d directionOf(int block_of_turn, int firing, int laser) {
  const double since_block = firing * kFiringPeriod + laser * kLaserPeriod;
  const double azimuth = 0.01 * kDegree * kAzimuthPerBlock *
                         (block_of_turn + since_block / (kFiringsPerBlock * kFiringPeriod));
  const double elevation = elevationOf(laser);
  return {std::cos(elevation) * std::cos(azimuth), -std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

void putU16(unsigned char* to, unsigned value) {
  to[0] = static_cast<unsigned char>(value & 0xff);
  to[1] = static_cast<unsigned char>(value >> 8);
}

void putU32(unsigned char* to, std::uint32_t value) {
  putU16(to, value & 0xffff);
  putU16(to + 2, value >> 16);
}

/// Brightness of the surface times the cosine of the angle of incidence.
unsigned reflectivity(const SurfaceHit& hit, const Vector3d& direction) {
  const double luminance = 0.299 * hit.color[0] + 0.587 * hit.color[1] + 0.114 * hit.color[2];
  return static_cast<unsigned>(std::lround(luminance * std::abs(hit.normal.dot(direction))));
}

/// Fires lasers and writes what comes back.
class Turn {
 public:
  Turn(const VelodyneModel& model, const World& world, const Moment& moment, Random& random)
      : model_(model), world_(world), moment_(moment), random_(random) {}

  Packet packet(int index);
  std::size_t returns() const { return returns_; }

 private:
  void writeFiring(int block_of_turn, int firing, unsigned char* bytes);
  void writeReturn(const Vector3d& origin, const Vector3d& direction, double time,
                   unsigned char* bytes);

  const VelodyneModel& model_;
  const World& world_;
  const Moment& moment_;
  Random& random_;
  std::size_t returns_ = 0;
};

Packet Turn::packet(int index) {
  constexpr unsigned kBlockHeader = 0xeeff;
  constexpr unsigned char kModelVlp16 = 0x22;
  constexpr std::uint64_t kMicrosecondsPerHour = 3'600'000'000;
  std::array<unsigned char, kPacketBytes> bytes{};
  for (int block = 0; block < kBlocks; ++block) {
    const int block_of_turn = index * kBlocks + block;
    unsigned char* at = bytes.data() + block * kBlockBytes;
    putU16(at, kBlockHeader);
    putU16(at + 2, static_cast<unsigned>(block_of_turn * kAzimuthPerBlock));
    for (int firing = 0; firing < kFiringsPerBlock; ++firing)
      writeFiring(block_of_turn, firing, at + 4 + firing * kLasers * kReturnBytes);
  }
  const bool moving = model_.sweep == VelodyneModel::Sweep::Moving;
  const double delay = moving ? index * kBlocks * kFiringsPerBlock * kFiringPeriod : 0;
  const double start = moment_.time + delay;
  const auto microseconds = static_cast<std::uint64_t>(std::llround(start * 1e6));
  unsigned char* status = bytes.data() + kBlocks * kBlockBytes;
  putU32(status, static_cast<std::uint32_t>(microseconds % kMicrosecondsPerHour));
  status[4] = CObservationVelodyneScan::RETMODE_STRONGEST;
  status[5] = kModelVlp16;

  Packet packet;
  std::memcpy(static_cast<void*>(&packet), bytes.data(), bytes.size());
  return packet;
}

void Turn::writeFiring(int block_of_turn, int firing, unsigned char* bytes) {
  const bool moving = model_.sweep == VelodyneModel::Sweep::Moving;
  const double since_start = (block_of_turn * kFiringsPerBlock + firing) * kFiringPeriod;
  const double delay = moving ? since_start : 0;
  const Eigen::Isometry3d sensor = moment_.robot(delay) * model_.mount.pose();
  for (int laser = 0; laser < kLasers; ++laser)
    writeReturn(sensor.translation(), sensor.linear() * directionOf(block_of_turn, firing, laser),
                moment_.time + delay, bytes + laser * kReturnBytes);
}

void Turn::writeReturn(const Vector3d& origin, const Vector3d& direction, double time,
                       unsigned char* bytes) {
  const auto hit = world_.castRay(origin, direction, model_.range.max, time);
  if (!hit) return;  // zeros: nothing came back
  const double distance = hit->distance + model_.range.sigma * random_.gaussian();
  if (distance < model_.range.min || distance > model_.range.max) return;
  putU16(bytes, static_cast<unsigned>(std::lround(distance / kDistanceUnit)));
  const bool labelled = model_.intensity == VelodyneModel::Intensity::Class;
  bytes[2] = static_cast<unsigned char>(labelled ? hit->class_id : reflectivity(*hit, direction));
  ++returns_;
}

}  // namespace

Sensed sense(const VelodyneModel& model, const World& world, const Moment& moment, Random& random) {
  auto scan = CObservationVelodyneScan::Create();
  scan->sensorLabel = model.mount.label;
  scan->timestamp = moment.timestamp;
  scan->originalReceivedTimestamp = moment.timestamp;
  scan->has_satellite_timestamp = true;
  scan->sensorPose = toMrpt(model.mount);
  scan->minRange = model.range.min;
  scan->maxRange = model.range.max;
  scan->calibration = mrpt::obs::VelodyneCalibration::LoadDefaultCalibration("VLP16");
  Turn turn(model, world, moment, random);
  for (int i = 0; i < kPackets; ++i) scan->scan_packets.push_back(turn.packet(i));
  return {{scan}, turn.returns()};
}

}  // namespace csom::detail
