// SPDX-License-Identifier: BSD-3-Clause
// The points of an observation by which it is compared with a map.
#pragma once

#include <csom/core/types.h>
#include <csom/maps/LabelRules.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace csom {

/// Points in the frame of the sensor, all finite.
struct ObservedPoints {
  mrpt::poses::CPose3D sensor_pose;  ///< on the robot
  std::vector<Eigen::Vector3d> points;
  std::vector<ClassId> labels;  ///< as many as points; kFreeClass = none that says a class
};

/// Every `decimation`-th point of an observation. Labels are those that points or pixels carry;
/// `unlabelled`: the class that says nothing, 0 = none. Throws std::exception if the observation is
/// damaged or of a kind that has no points.
ObservedPoints observedPoints(const mrpt::obs::CObservation& observation, const LabelRules& rules,
                              int decimation, ClassId unlabelled);

/// Remembers the points of the last few observations: a particle filter asks for the same ones
/// again for every particle. Observations are recognised by a checksum of all that they hold, as an
/// address may be used again. Thread-safe; copies start empty.
class ObservedPointsCache {
 public:
  ObservedPointsCache() = default;
  ObservedPointsCache(const ObservedPointsCache&) {}
  ObservedPointsCache& operator=(const ObservedPointsCache&);

  /// As observedPoints(), which is called if they are not known yet.
  std::shared_ptr<const ObservedPoints> get(const mrpt::obs::CObservation& observation,
                                            const LabelRules& rules, int decimation,
                                            ClassId unlabelled) const;
  /// To be called when labels come to mean other classes.
  void invalidate();

 private:
  struct Key {
    std::uint64_t checksum = 0;
    int decimation = 0;
    PointLabels source = PointLabels::None;
    ClassId scan_2d = kFreeClass;
    bool operator==(const Key& other) const;
  };
  mutable std::mutex mutex_;
  mutable std::vector<std::pair<Key, std::shared_ptr<const ObservedPoints>>>
      known_;  ///< last first
};

}  // namespace csom
