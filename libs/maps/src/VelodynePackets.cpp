// SPDX-License-Identifier: BSD-3-Clause
// VLP-16 User Manual, chapters 6 and 9; HDL-32E and HDL-64E S3 User Manuals, "data packet format".
#include <csom/maps/VelodynePackets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <string>

namespace csom {
namespace {

using mrpt::obs::CObservationVelodyneScan;
using mrpt::obs::VelodyneCalibration;
using Packet = CObservationVelodyneScan::TVelodyneRawPacket;

constexpr int kBlocks = CObservationVelodyneScan::BLOCKS_PER_PACKET;
constexpr int kReturnsOfBlock = CObservationVelodyneScan::SCANS_PER_BLOCK;
constexpr int kTurn = CObservationVelodyneScan::ROTATION_MAX_UNITS;
constexpr double kDegree = 3.14159265358979323846 / 180;

/// Microseconds since the hour began. Not packet.gps_timestamp(): that one binds a reference to a
/// number that lies at no multiple of four bytes.
std::uint32_t timeOf(const Packet& packet) {
  static_assert(sizeof packet == sizeof packet.blocks + sizeof(std::uint32_t) + 2);
  std::uint32_t time;
  std::memcpy(&time, reinterpret_cast<const std::uint8_t*>(&packet) + sizeof packet.blocks,
              sizeof time);
  return time;
}

/// In units of DISTANCE_RESOLUTION. Not given.distance(), for the same reason: every other one lies
/// at an odd address.
std::uint16_t distanceOf(const CObservationVelodyneScan::laser_return_t& given) {
  std::uint16_t distance;
  std::memcpy(&distance, reinterpret_cast<const std::uint8_t*>(&given), sizeof distance);
  return distance;
}

/// When and where to the lasers of a block are fired.
struct FiringPattern {
  int lasers;            ///< of one firing; a block has room for kReturnsOfBlock
  double block_seconds;  ///< from one azimuth to the next; 0: not known, and those below neither
  double firing_seconds;
  double laser_seconds;
};

FiringPattern patternOf(std::size_t lasers) {
  switch (lasers) {
    case 16:
      return {16, 110.592e-6, 55.296e-6, 2.304e-6};
    case 32:
      return {32, 46.08e-6, 46.08e-6, 1.152e-6};
    case 64:
      return {32, 0, 0, 0};
    default:
      throw std::runtime_error("its calibration has " + std::to_string(lasers) +
                               " lasers; those of Velodynes with 16, 32 and 64 are known");
  }
}

struct SineCosine {
  float sine;
  float cosine;
};

/// Of every azimuth that a packet can name.
const std::vector<SineCosine>& azimuthTable() {
  static const std::vector<SineCosine> table = [] {
    std::vector<SineCosine> t(kTurn);
    for (int i = 0; i < kTurn; ++i) {
      const double angle = 0.01 * kDegree * i;
      t[static_cast<std::size_t>(i)] = {static_cast<float>(std::sin(angle)),
                                        static_cast<float>(std::cos(angle))};
    }
    return t;
  }();
  return table;
}

/// What a calibration says of one laser.
struct Laser {
  float sine, cosine;         ///< of its elevation
  float distance_correction;  ///< [m]
  float up, left;             ///< where it is mounted, across its direction [m]
  int azimuth_correction;     ///< [0.01°]
};

/// MRPT reads corrections of azimuths in degrees from XML files, in radians from YAML files.
bool anglesAreRadians(const VelodyneCalibration& calibration) {
  const auto& lasers = calibration.laser_corrections;
  return std::all_of(lasers.begin(), lasers.end(), [](const auto& laser) {
    return std::abs(std::sin(laser.verticalCorrection) - laser.sinVertCorrection) < 1e-6;
  });
}

std::vector<Laser> lasersOf(const VelodyneCalibration& calibration) {
  const double unit = anglesAreRadians(calibration) ? 100 / kDegree : 100;
  std::vector<Laser> lasers;
  for (const auto& laser : calibration.laser_corrections) {
    const double azimuth = unit * laser.azimuthCorrection;
    if (!(std::abs(azimuth) < kTurn))
      throw std::runtime_error("its calibration turns a laser by " +
                               std::to_string(0.01 * azimuth) + " degrees");
    lasers.push_back({static_cast<float>(laser.sinVertCorrection),
                      static_cast<float>(laser.cosVertCorrection),
                      static_cast<float>(laser.distanceCorrection),
                      static_cast<float>(laser.verticalOffsetCorrection),
                      static_cast<float>(laser.horizontalOffsetCorrection),
                      static_cast<int>(std::lround(azimuth))});
  }
  return lasers;
}

class Decoder {
 public:
  explicit Decoder(const CObservationVelodyneScan& scan)
      : scan_(scan),
        pattern_(patternOf(scan.calibration.laser_corrections.size())),
        lasers_(lasersOf(scan.calibration)),
        azimuths_(azimuthTable()),
        nearest_(std::max(0.0F, static_cast<float>(scan.minRange))),
        farthest_(static_cast<float>(scan.maxRange)) {
    if (scan.scan_packets.size() > 1)
      packet_seconds_ = secondsSinceFirst(scan, scan.scan_packets.size() - 1) /
                        static_cast<double>(scan.scan_packets.size() - 1);
  }

  std::vector<VelodyneBeam> run() {
    beams_.reserve(scan_.scan_packets.size() * kBlocks * kReturnsOfBlock);
    for (std::size_t i = 0; i < scan_.scan_packets.size(); ++i) readPacket(i);
    return std::move(beams_);
  }

 private:
  bool isDual(const Packet& packet) const {
    return packet.laser_return_mode == CObservationVelodyneScan::RETMODE_DUAL;
  }
  bool isLowerBank(const Packet& packet, int block) const {
    return packet.blocks[block].header() == CObservationVelodyneScan::LOWER_BANK;
  }
  /// Of how many blocks one after the other the azimuth is the same.
  int blocksOfAzimuth(const Packet& packet) const {
    return (isDual(packet) ? 2 : 1) * (lasers_.size() == 64 ? 2 : 1);
  }

  void readPacket(std::size_t number) {
    const Packet& packet = scan_.scan_packets[number];
    check(packet, number);
    const double start = secondsSinceFirst(scan_, number);
    const int together = blocksOfAzimuth(packet);
    const int turned = medianTurn(packet, together);
    const double block_seconds =
        pattern_.block_seconds > 0 ? pattern_.block_seconds : together * packet_seconds_ / kBlocks;
    for (int block = 0; block < kBlocks; ++block) {
      const double since_packet = block / together * block_seconds;
      const int first_laser = isLowerBank(packet, block) ? pattern_.lasers : 0;
      for (int k = 0; k < kReturnsOfBlock; ++k) {
        const double since_block = k / pattern_.lasers * pattern_.firing_seconds +
                                   k % pattern_.lasers * pattern_.laser_seconds;
        const int meanwhile =
            block_seconds > 0 ? static_cast<int>(std::lround(turned * since_block / block_seconds))
                              : 0;
        readReturn(packet, block, k, first_laser + k % pattern_.lasers, meanwhile,
                   static_cast<float>(start + since_packet + since_block));
      }
    }
  }

  void check(const Packet& packet, std::size_t number) const {
    for (int block = 0; block < kBlocks; ++block) {
      const unsigned header = packet.blocks[block].header();
      const unsigned rotation = packet.blocks[block].rotation();
      const bool known = header == CObservationVelodyneScan::UPPER_BANK ||
                         (header == CObservationVelodyneScan::LOWER_BANK && lasers_.size() == 64);
      if (known && rotation < kTurn) continue;
      const std::string place =
          "packet " + std::to_string(number) + ", block " + std::to_string(block) + ": ";
      if (known)
        throw std::runtime_error(place + "the azimuth is " + std::to_string(rotation) +
                                 "; a turn has 36000 units");
      char begin[8];
      std::snprintf(begin, sizeof begin, "0x%04x", header);
      throw std::runtime_error(place + "it begins with " + begin +
                               ", which is no block of a Velodyne with " +
                               std::to_string(lasers_.size()) + " lasers");
    }
  }

  /// How far the sensor turns from one azimuth to the next.
  static int medianTurn(const Packet& packet, int together) {
    std::array<int, kBlocks> turns{};
    int count = 0;
    for (int block = 0; block + together < kBlocks; ++block)
      turns[static_cast<std::size_t>(count++)] =
          (kTurn + packet.blocks[block + together].rotation() - packet.blocks[block].rotation()) %
          kTurn;
    std::nth_element(turns.begin(), turns.begin() + count / 2, turns.begin() + count);
    return turns[static_cast<std::size_t>(count / 2)];
  }

  void readReturn(const Packet& packet, int block, int k, int laser, int meanwhile, float seconds) {
    const auto& given = packet.blocks[block].laser_returns[k];
    // The last return comes first, the strongest one in the block behind it.
    const bool second = isDual(packet) && block % 2 == 1;
    if (second && distanceOf(given) == distanceOf(packet.blocks[block - 1].laser_returns[k]))
      return;
    const Laser& from = lasers_[static_cast<std::size_t>(laser)];
    const int azimuth =
        (packet.blocks[block].rotation() + meanwhile - from.azimuth_correction + 2 * kTurn) % kTurn;
    const float distance =
        static_cast<float>(distanceOf(given)) * CObservationVelodyneScan::DISTANCE_RESOLUTION +
        from.distance_correction;
    const bool empty = distanceOf(given) == 0 || distance > farthest_;
    const bool too_near = !empty && distance < nearest_;
    Eigen::Vector3f point(0, 0, 0);
    if (empty)
      point = directionOf(from, azimuth);
    else if (!too_near)
      point = pointOf(distance, from, azimuth);
    beams_.push_back({point, !empty && !too_near, given.intensity(),
                      static_cast<std::uint8_t>(laser), static_cast<std::uint16_t>(azimuth),
                      seconds});
  }

  Eigen::Vector3f directionOf(const Laser& laser, int azimuth) const {
    const SineCosine& turned = azimuths_[static_cast<std::size_t>(azimuth)];
    return {laser.cosine * turned.cosine, -laser.cosine * turned.sine, laser.sine};
  }

  Eigen::Vector3f pointOf(float distance, const Laser& laser, int azimuth) const {
    const float ahead = distance * laser.cosine - laser.up * laser.sine;
    const SineCosine& turned = azimuths_[static_cast<std::size_t>(azimuth)];
    return {ahead * turned.cosine + laser.left * turned.sine,
            laser.left * turned.cosine - ahead * turned.sine,
            distance * laser.sine + laser.up * laser.cosine};
  }

  const CObservationVelodyneScan& scan_;
  const FiringPattern pattern_;
  const std::vector<Laser> lasers_;
  const std::vector<SineCosine>& azimuths_;
  const float nearest_;        ///< [m]
  const float farthest_;       ///< [m]
  double packet_seconds_ = 0;  ///< from one packet to the next
  std::vector<VelodyneBeam> beams_;
};

}  // namespace

std::vector<VelodyneBeam> decodePackets(const CObservationVelodyneScan& scan) {
  return Decoder(scan).run();
}

double secondsSinceFirst(const CObservationVelodyneScan& scan, std::size_t packet) {
  constexpr std::uint32_t kHour = 3'600'000'000;  // [µs]
  const std::uint32_t first = timeOf(scan.scan_packets.front());
  const std::uint32_t time = timeOf(scan.scan_packets.at(packet));
  return 1e-6 * (time >= first ? time - first : kHour - first + time);
}

std::vector<std::uint16_t> rowsOfLasers(const VelodyneCalibration& calibration) {
  const auto& lasers = calibration.laser_corrections;
  std::vector<std::uint16_t> by_elevation(lasers.size());
  std::iota(by_elevation.begin(), by_elevation.end(), std::uint16_t{0});
  std::stable_sort(by_elevation.begin(), by_elevation.end(), [&](auto a, auto b) {
    return lasers[a].sinVertCorrection < lasers[b].sinVertCorrection;
  });
  std::vector<std::uint16_t> rows(lasers.size());
  for (std::size_t row = 0; row < by_elevation.size(); ++row)
    rows[by_elevation[row]] = static_cast<std::uint16_t>(row);
  return rows;
}

}  // namespace csom
