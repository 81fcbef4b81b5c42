// SPDX-License-Identifier: BSD-3-Clause
// Points of CObservationVelodyneScan.
#include <csom/core/FindRangeImage.h>
#include <csom/maps/VelodynePackets.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "Extractors.h"

namespace csom {
namespace {

using mrpt::obs::CObservationVelodyneScan;

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
    if (scan.scan_packets.empty())
      addCloud(scan, rules, out);
    else
      addPackets(scan, rules, out);
    if (const auto* moved = dynamic_cast<const MovedVelodyneScan*>(&scan)) {
      out.no_returns += moved->too_near;
      for (const EmptyBeam& beam : moved->empty_beams) out.addEmpty(beam);
    }
    return out;
  }

 private:
  static PointLabel labelOf(std::uint8_t intensity, const LabelRules& rules) {
    const bool labelled = rules.source() == PointLabels::ByIntensity;
    return labelled ? rules.fromRaw(intensity) : PointLabel{};
  }

  static void addPackets(const CObservationVelodyneScan& scan, const LabelRules& rules,
                         SensorPoints& out) {
    const std::vector<VelodyneBeam> beams = decodePackets(scan);
    const std::vector<std::uint16_t> rows = rowsOfLasers(scan.calibration);
    out.reserve(beams.size());
    for (const VelodyneBeam& beam : beams) {
      const RangeImage::Pixel pixel{rows[beam.laser], beam.azimuth};
      if (beam.returned || beam.point.isZero())
        out.add(beam.point, labelOf(beam.intensity, rules), pixel);
      else
        out.addEmpty({static_cast<float>(scan.maxRange) * beam.point, pixel});
    }
    finishImage(out);
  }

  static void finishImage(SensorPoints& out) {
    out.image_origin = ImageOrigin::Sensor;
    out.image.columns_of_turn = CObservationVelodyneScan::ROTATION_MAX_UNITS;
    out.image.column_step = measureColumnStep(out.image);
  }

  /// As deskewed() or generatePointCloud() have left it: the lasers of the points may be known.
  static void addCloud(const CObservationVelodyneScan& scan, const LabelRules& rules,
                       SensorPoints& out) {
    const auto& cloud = scan.point_cloud;
    const std::size_t count = cloud.x.size();
    if (cloud.y.size() != count || cloud.z.size() != count || cloud.intensity.size() != count)
      throw std::runtime_error("point_cloud has coordinates and intensities of unequal number");
    const std::vector<std::uint16_t> rows = rowsOfPoints(scan);
    const bool has_columns = !rows.empty() && cloud.azimuth.size() == count;
    if (rows.empty()) out.image_origin = ImageOrigin::Unknown;
    out.reserve(count);
    std::vector<std::uint16_t> kept_rows;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3f point(cloud.x[i], cloud.y[i], cloud.z[i]);
      if (point.norm() > scan.maxRange) {
        ++out.no_returns;
        continue;
      }
      const std::size_t before = out.points.size();
      const PointLabel label = labelOf(cloud.intensity[i], rules);
      if (has_columns)
        out.add(point, label, {rows[i], columnOf(cloud.azimuth[i])});
      else
        out.add(point, label);
      if (!rows.empty() && out.points.size() > before) kept_rows.push_back(rows[i]);
    }
    if (has_columns) {
      finishImage(out);
    } else if (!rows.empty()) {
      out.image_origin = ImageOrigin::Sensor;
      out.image = makeRangeImage(out.points, kept_rows);
    }
  }

  /// Degrees, which may be those of another turn.
  static std::int32_t columnOf(float azimuth) {
    constexpr std::int32_t kTurn = CObservationVelodyneScan::ROTATION_MAX_UNITS;
    if (!(std::abs(azimuth) < 1e6F))
      throw std::runtime_error("a point of point_cloud has the azimuth " + std::to_string(azimuth));
    const auto column = static_cast<std::int32_t>(std::lround(azimuth * 100)) % kTurn;
    return column < 0 ? column + kTurn : column;
  }

  /// Empty if the cloud does not tell the lasers of its points, or the calibration not where they
  /// look to.
  static std::vector<std::uint16_t> rowsOfPoints(const CObservationVelodyneScan& scan) {
    const std::vector<std::int16_t>& lasers = scan.point_cloud.laser_id;
    const std::vector<std::uint16_t> row_of_laser = rowsOfLasers(scan.calibration);
    if (lasers.size() != scan.point_cloud.size()) return {};
    std::vector<std::uint16_t> rows;
    rows.reserve(lasers.size());
    for (const std::int16_t laser : lasers) {
      if (laser < 0 || static_cast<std::size_t>(laser) >= row_of_laser.size()) return {};
      rows.push_back(row_of_laser[static_cast<std::size_t>(laser)]);
    }
    return rows;
  }
};

}  // namespace

std::unique_ptr<PointExtractor> makeVelodyneExtractor() {
  return std::make_unique<VelodyneExtractor>();
}

}  // namespace csom
