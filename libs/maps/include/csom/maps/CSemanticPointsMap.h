// SPDX-License-Identifier: BSD-3-Clause
// The semantic map in the guise of a points map.
#pragma once

#include <csom/maps/CSemanticContinuousMap.h>
#include <mrpt/maps/CSimplePointsMap.h>

#include <memory>
#include <optional>
#include <string>

namespace csom {

/// A CSemanticContinuousMap for programs that accept nothing but points maps, like MRPT's icp-slam:
/// it is filled, saved, drawn and queried as that map; its points are the centres of the occupied
/// voxels. In ini files `semanticPointsMap_count = 1`, with the sections of the semantic map.
///
/// Points that are added by other ways than observations are not part of the map and go with the
/// next observation. Thread-safety as CSemanticContinuousMap; the search functions of CPointsMap
/// are not covered by it, matching and likelihood are.
class CSemanticPointsMap : public mrpt::maps::CSimplePointsMap {
  DEFINE_SERIALIZABLE(CSemanticPointsMap, csom)

 public:
  CSemanticPointsMap() = default;
  explicit CSemanticPointsMap(CSemanticContinuousMap map);
  CSemanticPointsMap(const CSemanticPointsMap& other);
  CSemanticPointsMap& operator=(const CSemanticPointsMap& other);

  const CSemanticContinuousMap& semanticMap() const { return semantic_; }

  MAP_DEFINITION_START(CSemanticPointsMap)
  CSemanticContinuousMap::TMapDefinition semantic;
  MAP_DEFINITION_END(CSemanticPointsMap)

  std::string asString() const override { return semantic_.asString(); }
  void getVisualizationInto(mrpt::opengl::CSetOfObjects& scene) const override;
  /// As CSemanticContinuousMap.
  void saveMetricMapRepresentationToFile(const std::string& prefix) const override;
  void determineMatching2D(const mrpt::maps::CMetricMap* other,
                           const mrpt::poses::CPose2D& other_pose,
                           mrpt::tfest::TMatchingPairList& correspondences,
                           const mrpt::maps::TMatchingParams& params,
                           mrpt::maps::TMatchingExtraResults& results) const override;
  void determineMatching3D(const mrpt::maps::CMetricMap* other,
                           const mrpt::poses::CPose3D& other_pose,
                           mrpt::tfest::TMatchingPairList& correspondences,
                           const mrpt::maps::TMatchingParams& params,
                           mrpt::maps::TMatchingExtraResults& results) const override;
  float compute3DMatchingRatio(const mrpt::maps::CMetricMap* other,
                               const mrpt::poses::CPose3D& other_pose,
                               const mrpt::maps::TMatchingRatioParams& params) const override;
  float squareDistanceToClosestCorrespondence(float x0, float y0) const override;

 private:
  void internal_clear() override;
  bool internal_insertObservation(
      const mrpt::obs::CObservation& observation,
      const std::optional<const mrpt::poses::CPose3D>& robot_pose = std::nullopt) override;
  double internal_computeObservationLikelihood(
      const mrpt::obs::CObservation& observation,
      const mrpt::poses::CPose3D& taken_from) const override;
  bool internal_canComputeObservationLikelihood(
      const mrpt::obs::CObservation& observation) const override;

  /// The points of the semantic map become those of this one.
  void takePoints();

  CSemanticContinuousMap semantic_;
};

}  // namespace csom
