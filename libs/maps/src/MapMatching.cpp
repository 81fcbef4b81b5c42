// SPDX-License-Identifier: BSD-3-Clause
// Matching against other maps: between the centres of occupied voxels and the other map's points.
#include <csom/maps/CSemanticContinuousMap.h>
#include <mrpt/maps/CPointsMap.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/poses/CPose3D.h>

#include <limits>
#include <stdexcept>
#include <string>

namespace csom {
namespace {

const mrpt::maps::CMetricMap& pointsOf(const mrpt::maps::CMetricMap* other) {
  if (other == nullptr) throw std::invalid_argument("the map to be matched is null");
  if (dynamic_cast<const mrpt::maps::CPointsMap*>(other) != nullptr) return *other;
  const mrpt::maps::CSimplePointsMap* points = other->getAsSimplePointsMap();
  if (points == nullptr) {
    throw std::invalid_argument(std::string("a map of class ") +
                                other->GetRuntimeClass()->className +
                                " holds no points that could be matched");
  }
  return *points;
}

}  // namespace

void CSemanticContinuousMap::determineMatching2D(const mrpt::maps::CMetricMap* other,
                                                 const mrpt::poses::CPose2D& other_pose,
                                                 mrpt::tfest::TMatchingPairList& correspondences,
                                                 const mrpt::maps::TMatchingParams& params,
                                                 mrpt::maps::TMatchingExtraResults& results) const {
  points_for_2d_.get(map_).determineMatching2D(&pointsOf(other), other_pose, correspondences,
                                               params, results);
}

void CSemanticContinuousMap::determineMatching3D(const mrpt::maps::CMetricMap* other,
                                                 const mrpt::poses::CPose3D& other_pose,
                                                 mrpt::tfest::TMatchingPairList& correspondences,
                                                 const mrpt::maps::TMatchingParams& params,
                                                 mrpt::maps::TMatchingExtraResults& results) const {
  points_for_3d_.get(map_).determineMatching3D(&pointsOf(other), other_pose, correspondences,
                                               params, results);
}

float CSemanticContinuousMap::compute3DMatchingRatio(
    const mrpt::maps::CMetricMap* other, const mrpt::poses::CPose3D& other_pose,
    const mrpt::maps::TMatchingRatioParams& params) const {
  return points_for_3d_.get(map_).compute3DMatchingRatio(&pointsOf(other), other_pose, params);
}

float CSemanticContinuousMap::squareDistanceToClosestCorrespondence(float x0, float y0) const {
  const mrpt::maps::CSimplePointsMap& points = points_for_2d_.get(map_);
  if (points.empty()) return std::numeric_limits<float>::max();
  return points.squareDistanceToClosestCorrespondence(x0, y0);
}

const mrpt::maps::CSimplePointsMap* CSemanticContinuousMap::getAsSimplePointsMap() const {
  return &occupied_points_.get(map_);
}

}  // namespace csom
