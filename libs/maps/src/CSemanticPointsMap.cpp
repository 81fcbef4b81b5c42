// SPDX-License-Identifier: BSD-3-Clause
// The semantic map in the guise of a points map.
#include <csom/maps/CSemanticPointsMap.h>
#include <mrpt/serialization/CArchive.h>

#include <iostream>
#include <stdexcept>
#include <utility>

namespace csom {

CSemanticPointsMap::CSemanticPointsMap(CSemanticContinuousMap map) : semantic_(std::move(map)) {
  genericMapParams = semantic_.genericMapParams;
  takePoints();
}

CSemanticPointsMap::CSemanticPointsMap(const CSemanticPointsMap& other)
    : mrpt::maps::CSimplePointsMap(other), semantic_(other.semantic_) {
  genericMapParams = other.genericMapParams;
}

CSemanticPointsMap& CSemanticPointsMap::operator=(const CSemanticPointsMap& other) {
  if (this == &other) return *this;
  mrpt::maps::CSimplePointsMap::operator=(other);
  genericMapParams = other.genericMapParams;
  semantic_ = other.semantic_;
  return *this;
}

void CSemanticPointsMap::takePoints() {
  impl_copyFrom(*semantic_.getAsSimplePointsMap());
  mark_as_modified();
}

CSemanticPointsMap::TMapDefinition::TMapDefinition() = default;

void CSemanticPointsMap::TMapDefinition::loadFromConfigFile_map_specific(
    const mrpt::config::CConfigFileBase& source, const std::string& section_prefix) {
  semantic.load(source, section_prefix);
  for (const std::string& key : semantic.unknownKeys())
    std::cerr << "csom: warning: " << key << ": unknown key, ignored\n";
}

void CSemanticPointsMap::TMapDefinition::dumpToTextStream_map_specific(std::ostream& out) const {
  semantic.dumpToTextStream(out);
}

CreatedMap CSemanticPointsMap::internal_CreateFromMapDefinition(
    const mrpt::maps::TMetricMapInitializer& initializer) {
  const auto& definition = dynamic_cast<const TMapDefinition&>(initializer);
  CSemanticContinuousMap map(definition.semantic);
  map.genericMapParams = definition.genericMapParams;
  return CreatedMap(new CSemanticPointsMap(std::move(map)));
}

void CSemanticPointsMap::getVisualizationInto(mrpt::opengl::CSetOfObjects& scene) const {
  semantic_.getVisualizationInto(scene);
}

void CSemanticPointsMap::saveMetricMapRepresentationToFile(const std::string& prefix) const {
  semantic_.saveMetricMapRepresentationToFile(prefix);
}

void CSemanticPointsMap::internal_clear() {
  mrpt::maps::CSimplePointsMap::internal_clear();
  semantic_.clear();
}

bool CSemanticPointsMap::internal_insertObservation(
    const mrpt::obs::CObservation& observation,
    const std::optional<const mrpt::poses::CPose3D>& robot_pose) {
  const bool inserted = semantic_.insertObservation(observation, robot_pose);
  if (inserted) takePoints();
  return inserted;
}

double CSemanticPointsMap::internal_computeObservationLikelihood(
    const mrpt::obs::CObservation& observation, const mrpt::poses::CPose3D& taken_from) const {
  return semantic_.computeObservationLikelihood(observation, taken_from);
}

bool CSemanticPointsMap::internal_canComputeObservationLikelihood(
    const mrpt::obs::CObservation& observation) const {
  return semantic_.canComputeObservationLikelihood(observation);
}

void CSemanticPointsMap::determineMatching2D(const mrpt::maps::CMetricMap* other,
                                             const mrpt::poses::CPose2D& other_pose,
                                             mrpt::tfest::TMatchingPairList& correspondences,
                                             const mrpt::maps::TMatchingParams& params,
                                             mrpt::maps::TMatchingExtraResults& results) const {
  semantic_.determineMatching2D(other, other_pose, correspondences, params, results);
}

void CSemanticPointsMap::determineMatching3D(const mrpt::maps::CMetricMap* other,
                                             const mrpt::poses::CPose3D& other_pose,
                                             mrpt::tfest::TMatchingPairList& correspondences,
                                             const mrpt::maps::TMatchingParams& params,
                                             mrpt::maps::TMatchingExtraResults& results) const {
  semantic_.determineMatching3D(other, other_pose, correspondences, params, results);
}

float CSemanticPointsMap::compute3DMatchingRatio(
    const mrpt::maps::CMetricMap* other, const mrpt::poses::CPose3D& other_pose,
    const mrpt::maps::TMatchingRatioParams& params) const {
  return semantic_.compute3DMatchingRatio(other, other_pose, params);
}

float CSemanticPointsMap::squareDistanceToClosestCorrespondence(float x0, float y0) const {
  return semantic_.squareDistanceToClosestCorrespondence(x0, y0);
}

std::uint8_t CSemanticPointsMap::serializeGetVersion() const {
  return 0;
}

void CSemanticPointsMap::serializeTo(mrpt::serialization::CArchive& out) const {
  // The flags of the map that MRPT knows are those of this one.
  out << genericMapParams.enableSaveAs3DObject << genericMapParams.enableObservationLikelihood
      << genericMapParams.enableObservationInsertion << semantic_;
}

void CSemanticPointsMap::serializeFrom(mrpt::serialization::CArchive& in, std::uint8_t version) {
  if (version > 0)
    throw std::runtime_error("serialised map: version " + std::to_string(version) +
                             " is later than this program's 0");
  mrpt::maps::TMapGenericParams generic;
  in >> generic.enableSaveAs3DObject >> generic.enableObservationLikelihood >>
      generic.enableObservationInsertion >> semantic_;
  genericMapParams = generic;
  takePoints();
}

}  // namespace csom
