// SPDX-License-Identifier: BSD-3-Clause
// A scan before and after it has its labels.
#pragma once

#include <csom/maps/ObservationAdapter.h>
#include <csom/vision/PointLabelling.h>

#include <cstddef>
#include <string>

namespace csom {

/// A scan that waits for its images.
struct WaitingScan {
  double time = 0;    ///< [s since 1970]
  bool late = false;  ///< came when images of its time may have been forgotten
  std::string sensor_label;
  std::string observation_class;
  SensorPoints points;  ///< their labels are not used
  Eigen::Isometry3d sensor_in_map = Eigen::Isometry3d::Identity();
};

/// The scan with the labels that its points have received. Points that no camera sees, or not
/// properly, become `unlabelled` unless that is kFreeClass, and are counted in `kept_unlabelled`;
/// all other points without a label are left out. `free_range`: as in BeamRequest.
AdaptedScan scanOf(const WaitingScan& waiting, const LabelledPoints& labelled,
                   int number_of_classes, ClassId unlabelled, double free_range,
                   std::size_t& kept_unlabelled);

}  // namespace csom
