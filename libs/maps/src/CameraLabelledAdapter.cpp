// SPDX-License-Identifier: BSD-3-Clause
// Scans take their labels from the images of cameras.
#include <csom/maps/CameraLabelledAdapter.h>

#include "CameraLabelling.h"

namespace csom {

CameraLabelledAdapter::CameraLabelledAdapter(const LabelOptions& options, const LabelSet& labels)
    : labelling_(std::make_unique<CameraLabelling>(options, labels)) {}

CameraLabelledAdapter::CameraLabelledAdapter(std::unique_ptr<CameraLabelling> labelling)
    : labelling_(std::move(labelling)) {}

CameraLabelledAdapter::~CameraLabelledAdapter() = default;

void CameraLabelledAdapter::loadNetworks() {
  labelling_->loadNetworks();
}

void CameraLabelledAdapter::takeNetworksOf(const CameraLabelledAdapter& other) {
  labelling_->takeNetworksOf(*other.labelling_);
}

void CameraLabelledAdapter::setObserver(LabelledScanObserver observer) {
  labelling_->observer = std::move(observer);
}

std::optional<std::vector<AdaptedScan>> CameraLabelledAdapter::adapt(
    const mrpt::obs::CObservation& observation, const Eigen::Isometry3d& robot_pose,
    const LabelRules& rules) {
  return labelling_->adapt(observation, robot_pose, rules);
}

std::vector<AdaptedScan> CameraLabelledAdapter::flush() {
  return labelling_->flush();
}

std::vector<AdaptedScan> CameraLabelledAdapter::takeFinished() {
  return labelling_->takeFinished();
}

std::unique_ptr<ObservationAdapter> CameraLabelledAdapter::clone() const {
  auto labelling = std::make_unique<CameraLabelling>(*labelling_);
  labelling->observer = {};
  return std::unique_ptr<ObservationAdapter>(new CameraLabelledAdapter(std::move(labelling)));
}

const CameraStatistics* CameraLabelledAdapter::cameraStatistics() const {
  return &labelling_->statistics();
}

void CameraLabelledAdapter::writeTo(ByteWriter& out) const {
  labelling_->writeTo(out);
}

void CameraLabelledAdapter::readFrom(ByteReader& in, std::uint8_t version) {
  labelling_->readFrom(in, version);
}

std::unique_ptr<ObservationAdapter> makeAdapter(const LabelOptions& options,
                                                const LabelSet& labels) {
  if (!options.usesCameras()) return std::make_unique<SelfLabelledAdapter>();
  return std::make_unique<CameraLabelledAdapter>(options, labels);
}

}  // namespace csom
