// SPDX-License-Identifier: BSD-3-Clause
// Matching against other maps: between the surfaces of this map and the other map's points.
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/maps/CSemanticPointsMap.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/CPointsMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/poses/CPose3D.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace csom {
namespace {

/// The semantic map that `other` is, or is the guise of, or holds beside other maps; null: none.
const CSemanticContinuousMap* semanticOf(const mrpt::maps::CMetricMap* other) {
  if (const auto* set = dynamic_cast<const mrpt::maps::CMultiMetricMap*>(other)) {
    for (const auto& map : set->maps) {
      if (const auto* semantic = semanticOf(map.get())) return semantic;
    }
    return nullptr;
  }
  const auto* points = dynamic_cast<const CSemanticPointsMap*>(other);
  return points != nullptr ? &points->semanticMap()
                           : dynamic_cast<const CSemanticContinuousMap*>(other);
}

const mrpt::maps::CMetricMap& pointsOf(const mrpt::maps::CMetricMap* other) {
  if (other == nullptr) throw std::invalid_argument("the map to be matched is null");
  if (const auto* semantic = semanticOf(other)) return semantic->surfaces().points;
  if (dynamic_cast<const mrpt::maps::CPointsMap*>(other) != nullptr) return *other;
  const mrpt::maps::CSimplePointsMap* points = other->getAsSimplePointsMap();
  if (points == nullptr) {
    throw std::invalid_argument(std::string("a map of class ") +
                                other->GetRuntimeClass()->className +
                                " holds no points that could be matched");
  }
  return *points;
}

std::vector<ClassId> classesOf(const mrpt::maps::CPointsMapXYZI& cloud, const LabelRules& rules) {
  const auto& intensities = intensitiesOf(cloud);
  if (intensities.size() != cloud.size()) return {};
  std::vector<ClassId> classes;
  classes.reserve(intensities.size());
  for (const float intensity : intensities) {
    const PointLabel label = rules.fromIntensity(intensity);
    classes.push_back(label.kind == PointLabel::Kind::Class ? label.id : kFreeClass);
  }
  return classes;
}

/// A class for every point that pointsOf(other) has, kFreeClass where it has none; empty if the
/// other map knows no classes of this label set.
std::vector<ClassId> classesOf(const mrpt::maps::CMetricMap& other, const LabelSet& labels,
                               const LabelRules& rules) {
  if (const auto* semantic = semanticOf(&other)) {
    return semantic->labels().name() == labels.name() ? semantic->surfaces().classes
                                                      : std::vector<ClassId>();
  }
  const auto* cloud = dynamic_cast<const mrpt::maps::CPointsMapXYZI*>(&other);
  if (cloud != nullptr && rules.source() == PointLabels::ByIntensity)
    return classesOf(*cloud, rules);
  return {};
}

/// Leaves pairs out whose classes are known and differ, and lowers the ratio by as much.
void keepConsistent(const std::vector<ClassId>& ours, const std::vector<ClassId>& theirs,
                    ClassId unlabelled, mrpt::tfest::TMatchingPairList& pairs,
                    mrpt::maps::TMatchingExtraResults& results) {
  if (pairs.empty()) return;
  const auto says = [&](ClassId id) { return id != kFreeClass && id != unlabelled; };
  const auto contradicts = [&](const auto& pair) {
    if (pair.globalIdx >= ours.size() || pair.localIdx >= theirs.size()) return false;
    const ClassId our = ours[pair.globalIdx];
    const ClassId their = theirs[pair.localIdx];
    return says(our) && says(their) && our != their;
  };
  const std::size_t before = pairs.size();
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), contradicts), pairs.end());
  results.correspondencesRatio *= static_cast<float>(pairs.size()) / static_cast<float>(before);
}

}  // namespace

void CSemanticContinuousMap::determineMatching2D(const mrpt::maps::CMetricMap* other,
                                                 const mrpt::poses::CPose2D& other_pose,
                                                 mrpt::tfest::TMatchingPairList& correspondences,
                                                 const mrpt::maps::TMatchingParams& params,
                                                 mrpt::maps::TMatchingExtraResults& results) const {
  const mrpt::maps::CMetricMap& points = pointsOf(other);
  const SurfacePoints& surfaces = surfaces_for_2d_.get(map_);
  surfaces.points.determineMatching2D(&points, other_pose, correspondences, params, results);
  keepConsistent(surfaces.classes, classesOf(*other, labels(), labelRules()),
                 labels().unlabelledClass(), correspondences, results);
}

void CSemanticContinuousMap::determineMatching3D(const mrpt::maps::CMetricMap* other,
                                                 const mrpt::poses::CPose3D& other_pose,
                                                 mrpt::tfest::TMatchingPairList& correspondences,
                                                 const mrpt::maps::TMatchingParams& params,
                                                 mrpt::maps::TMatchingExtraResults& results) const {
  const mrpt::maps::CMetricMap& points = pointsOf(other);
  const SurfacePoints& surfaces = surfaces_for_3d_.get(map_);
  surfaces.points.determineMatching3D(&points, other_pose, correspondences, params, results);
  keepConsistent(surfaces.classes, classesOf(*other, labels(), labelRules()),
                 labels().unlabelledClass(), correspondences, results);
}

float CSemanticContinuousMap::compute3DMatchingRatio(
    const mrpt::maps::CMetricMap* other, const mrpt::poses::CPose3D& other_pose,
    const mrpt::maps::TMatchingRatioParams& params) const {
  return surfaces_for_3d_.get(map_).points.compute3DMatchingRatio(&pointsOf(other), other_pose,
                                                                  params);
}

float CSemanticContinuousMap::squareDistanceToClosestCorrespondence(float x0, float y0) const {
  const mrpt::maps::CSimplePointsMap& points = surfaces_for_2d_.get(map_).points;
  if (points.empty()) return std::numeric_limits<float>::max();
  return points.squareDistanceToClosestCorrespondence(x0, y0);
}

const mrpt::maps::CSimplePointsMap* CSemanticContinuousMap::getAsSimplePointsMap() const {
  return &occupied_points_.get(map_);
}

}  // namespace csom
