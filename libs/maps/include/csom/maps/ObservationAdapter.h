// SPDX-License-Identifier: BSD-3-Clause
// From observations to semantic points.
#pragma once

#include <csom/core/types.h>
#include <csom/maps/LabelRules.h>
#include <csom/maps/PointExtractor.h>
#include <mrpt/obs/CObservation.h>

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace csom {

/// A scan that is ready to be inserted, and the observation that its points come from.
struct AdaptedScan {
  Scan scan;
  LabelCounts labels;
  double timestamp = 0;  ///< seconds since 1970 (UTC); 0 if unknown
  std::string sensor_label;
  std::string observation_class;  ///< "CObservationVelodyneScan", …
};

/// Turns observations into scans of labelled points. Labels may arrive with another observation
/// than the points: an adapter may keep an observation and return its scan when the missing part is
/// there, which is why adapt() is not const and returns any number of scans.
/// Not thread-safe.
class ObservationAdapter {
 public:
  virtual ~ObservationAdapter() = default;
  /// Nothing: an observation of a kind that this adapter cannot use. Otherwise the scans that are
  /// complete now, in the order of their observations; none if the observation is kept for later.
  /// `robot_pose`: robot in the map frame. Throws std::exception if the observation is damaged.
  virtual std::optional<std::vector<AdaptedScan>> adapt(const mrpt::obs::CObservation& observation,
                                                        const Eigen::Isometry3d& robot_pose,
                                                        const LabelRules& rules) = 0;
};

/// The adapter for observations that carry their labels themselves, point by point or pixel by
/// pixel: one observation in, one scan out.
class SelfLabelledAdapter : public ObservationAdapter {
 public:
  std::optional<std::vector<AdaptedScan>> adapt(const mrpt::obs::CObservation& observation,
                                                const Eigen::Isometry3d& robot_pose,
                                                const LabelRules& rules) override;
};

/// The scan of one observation's points: in the frame of the map, axes parallel to it, relative to
/// the sensor, points without a usable label left out and counted.
AdaptedScan makeScan(const SensorPoints& points, const Eigen::Isometry3d& robot_pose,
                     const LabelRules& rules);

}  // namespace csom
