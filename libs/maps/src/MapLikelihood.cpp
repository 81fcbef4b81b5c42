// SPDX-License-Identifier: BSD-3-Clause
// How well an observation fits to the map from a pose: a likelihood field on the occupied voxels.
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/maps/PointExtractor.h>
#include <csom/maps/PoseRounding.h>

#include <algorithm>
#include <optional>

namespace csom {
namespace {

double squaredDistance(const SemanticMap& map, const Eigen::Vector3d& point, double max_distance) {
  const std::optional<Neighbour> nearest = map.nearestOccupied(point, max_distance);
  const double distance = nearest ? nearest->distance : max_distance;
  return distance * distance;
}

}  // namespace

bool CSemanticContinuousMap::internal_canComputeObservationLikelihood(
    const mrpt::obs::CObservation& observation) const {
  return findPointExtractor(observation) != nullptr;
}

double CSemanticContinuousMap::internal_computeObservationLikelihood(
    const mrpt::obs::CObservation& observation, const mrpt::poses::CPose3D& taken_from) const {
  constexpr double kSaysNothing = 0;      // the same for every pose
  const LabelRules rules = labelRules();  // throws: a wrong option is no damaged observation
  const PointExtractor* extractor = findPointExtractor(observation);
  if (extractor == nullptr) return kSaysNothing;
  SensorPoints seen;
  Eigen::Isometry3d sensor;
  try {
    seen = extractor->extract(observation, rules);
    sensor = sensorPoseInMap(roundedPose(taken_from), seen.sensor_pose);
  } catch (const std::exception&) {  // MRPT throws logic_error for a file that is missing
    return kSaysNothing;             // damaged: counted and reported when it is inserted
  }

  const auto step = static_cast<std::size_t>(std::max(1, likelihoodOptions.decimation));
  double sum = 0;
  std::size_t used = 0;
  for (std::size_t i = 0; i < seen.points.size(); i += step) {
    const Eigen::Vector3d point = seen.points[i].cast<double>();
    if (!point.allFinite()) continue;
    sum += squaredDistance(map_, sensor * point, likelihoodOptions.max_distance);
    ++used;
  }
  if (used == 0) return kSaysNothing;
  const double sigma = likelihoodOptions.sigma;
  return -0.5 * sum / (static_cast<double>(used) * sigma * sigma);
}

}  // namespace csom
