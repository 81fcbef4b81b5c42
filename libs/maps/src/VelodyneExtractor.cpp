// SPDX-License-Identifier: BSD-3-Clause
// Points of CObservationVelodyneScan.
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <stdexcept>

#include "Extractors.h"

namespace csom {
namespace {

using mrpt::obs::CObservationVelodyneScan;

/// Receives the points that the packets of a scan hold.
class PacketPoints : public CObservationVelodyneScan::PointCloudStorageWrapper {
 public:
  PacketPoints(SensorPoints& out, const LabelRules& rules) : out_(&out), rules_(&rules) {}

  void reserve(std::size_t count) override { out_->reserve(out_->points.size() + count); }
  void add_point(float x, float y, float z, std::uint8_t intensity,
                 const mrpt::system::TTimeStamp& /*time*/, float /*azimuth*/,
                 std::uint16_t /*laser*/) override {
    const bool labelled = rules_->source() == PointLabels::ByIntensity;
    out_->add({x, y, z}, labelled ? rules_->fromRaw(intensity) : PointLabel{});
  }

  void addNoReturn() { ++out_->no_returns; }

 private:
  SensorPoints* out_;
  const LabelRules* rules_;
};

class VelodyneExtractor : public PointExtractor {
 public:
  bool accepts(const mrpt::obs::CObservation& observation) const override {
    return dynamic_cast<const CObservationVelodyneScan*>(&observation) != nullptr;
  }

  bool seesAllAround() const override { return true; }

  bool holdsPoints(const mrpt::obs::CObservation& observation) const override {
    const auto& scan = dynamic_cast<const CObservationVelodyneScan&>(observation);
    return !scan.scan_packets.empty() || scan.point_cloud.size() > 0;
  }

  SensorPoints extract(const mrpt::obs::CObservation& observation,
                       const LabelRules& rules) const override {
    const auto& scan = dynamic_cast<const CObservationVelodyneScan&>(observation);
    SensorPoints out;
    out.sensor_pose = scan.sensorPose;
    PacketPoints points(out, rules);
    if (scan.scan_packets.empty()) {
      addCloud(scan, points);
    } else {
      addPackets(scan, points);
    }
    return out;
  }

 private:
  static void addPackets(const CObservationVelodyneScan& scan, PacketPoints& points) {
    CObservationVelodyneScan::TGeneratePointCloudParameters parameters;
    // The limits of the sensor (minRange) and of the map (min_range) decide.
    parameters.minDistance = 0;
    CObservationVelodyneScan copy = scan;  // generatePointCloud() is not const
    copy.generatePointCloud(points, parameters);
  }

  static void addCloud(const CObservationVelodyneScan& scan, PacketPoints& points) {
    const auto& cloud = scan.point_cloud;
    const std::size_t count = cloud.x.size();
    if (cloud.y.size() != count || cloud.z.size() != count || cloud.intensity.size() != count)
      throw std::runtime_error("point_cloud has coordinates and intensities of unequal number");
    points.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      if (Eigen::Vector3f(cloud.x[i], cloud.y[i], cloud.z[i]).norm() > scan.maxRange)
        points.addNoReturn();
      else
        points.add_point(cloud.x[i], cloud.y[i], cloud.z[i], cloud.intensity[i], {}, 0, 0);
    }
  }
};

}  // namespace

std::unique_ptr<PointExtractor> makeVelodyneExtractor() {
  return std::make_unique<VelodyneExtractor>();
}

}  // namespace csom
