// SPDX-License-Identifier: BSD-3-Clause
// Points of CObservation2DRangeScan.
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <cmath>

#include "Extractors.h"

namespace csom {
namespace {

using mrpt::obs::CObservation2DRangeScan;

class LaserScanExtractor : public PointExtractor {
 public:
  bool accepts(const mrpt::obs::CObservation& observation) const override {
    return dynamic_cast<const CObservation2DRangeScan*>(&observation) != nullptr;
  }

  bool seesAllAround() const override { return false; }

  bool holdsPoints(const mrpt::obs::CObservation& observation) const override {
    return dynamic_cast<const CObservation2DRangeScan&>(observation).getScanSize() > 0;
  }

  SensorPoints extract(const mrpt::obs::CObservation& observation,
                       const LabelRules& rules) const override {
    const auto& scan = dynamic_cast<const CObservation2DRangeScan&>(observation);
    const std::size_t rays = scan.getScanSize();
    const double step = rays > 1 ? scan.aperture / static_cast<double>(rays - 1) : 0.0;
    const double sign = scan.rightToLeft ? 1 : -1;

    SensorPoints out;
    out.sensor_pose = scan.sensorPose;
    out.reserve(rays);
    for (std::size_t i = 0; i < rays; ++i) {
      const float range = scan.getScanRange(i);
      // A ray of maximum range hit nothing, and neither did one of no range, valid or not.
      if (!scan.getScanRangeValidity(i) || range <= 0 || range >= scan.maxRange) {
        ++out.no_returns;
        continue;
      }
      const double angle = sign * (static_cast<double>(i) * step - 0.5 * scan.aperture);
      out.add({static_cast<float>(range * std::cos(angle)),
               static_cast<float>(range * std::sin(angle)), 0.0f},
              rules.ofScan2D());
    }
    return out;
  }
};

}  // namespace

std::unique_ptr<PointExtractor> makeLaserScanExtractor() {
  return std::make_unique<LaserScanExtractor>();
}

}  // namespace csom
