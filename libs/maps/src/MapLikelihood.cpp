// SPDX-License-Identifier: BSD-3-Clause
// How well an observation fits to the map from a pose.
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/maps/ObservationLikelihood.h>
#include <csom/maps/PointExtractor.h>
#include <csom/maps/PoseRounding.h>

namespace csom {

bool CSemanticContinuousMap::internal_canComputeObservationLikelihood(
    const mrpt::obs::CObservation& observation) const {
  const PointExtractor* const extractor = findPointExtractor(observation);
  return extractor != nullptr && extractor->holdsPoints(observation);
}

double CSemanticContinuousMap::internal_computeObservationLikelihood(
    const mrpt::obs::CObservation& observation, const mrpt::poses::CPose3D& taken_from) const {
  constexpr double kSaysNothing = 0;      // the same for every pose
  const LabelRules rules = labelRules();  // throws: a wrong option is no damaged observation
  likelihoodOptions.validate();
  if (findPointExtractor(observation) == nullptr) return kSaysNothing;
  std::shared_ptr<const ObservedPoints> seen;
  Eigen::Isometry3d sensor;
  try {
    seen = observed_points_.get(observation, rules, likelihoodOptions.decimation,
                                static_cast<ClassId>(map_.options().unlabelled_class_id));
    sensor = sensorPoseInMap(roundedPose(taken_from), seen->sensor_pose);
  } catch (const std::exception&) {  // MRPT throws logic_error for a file that is missing
    return kSaysNothing;             // damaged: counted and reported when it is inserted
  }
  return logLikelihood(map_, nearest_voxels_, likelihoodOptions, seen->points, seen->labels,
                       sensor);
}

}  // namespace csom
