// SPDX-License-Identifier: BSD-3-Clause
// A log whose observations have poses.
#include "logs/PosedLog.h"

#include <csom/core/Error.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include "logs/ExternalFiles.h"

namespace csom::detail {
namespace {

/// Observations that say where the robot is, not what is around it.
bool tellsPose(const mrpt::obs::CObservation& observation) {
  return dynamic_cast<const mrpt::obs::CObservationRobotPose*>(&observation) != nullptr ||
         dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation) != nullptr;
}

}  // namespace

PosedLog::PosedLog(const RawlogSurvey& survey, PoseSource& poses, const Options& options)
    : reader_(survey.file, RawlogReader::Soundness::Known),
      unread_(survey.end.entries),
      poses_(poses),
      options_(options) {}

std::optional<PosedEntry> PosedLog::next() {
  while (waiting_.empty() || (waiting_.size() <= kMaxWaiting && !poses_.knows(waiting_.front()))) {
    if (!readOne()) break;
  }
  if (waiting_.empty()) return std::nullopt;
  PosedEntry entry = posed(waiting_.front());
  waiting_.pop_front();
  return entry;
}

bool PosedLog::readOne() {
  if (unread_ == 0) return false;
  --unread_;
  auto entry = reader_.next();
  if (!entry) throw FileError(reader_.file(), "changed while it was being read");
  poses_.advance(*entry);
  waiting_.push_back(std::move(*entry));
  return true;
}

PosedEntry PosedLog::posed(const RawlogEntry& entry) {
  PosedEntry out;
  for (const auto& observation : entry.observations) {
    if (tellsPose(*observation)) continue;
    const auto pose = poses_.poseOf(entry, *observation);  // it counts what it is asked for
    if (entry.index < options_.skip) continue;
    if (options_.load_images) loadImages(*observation);
    out.observations.push_back(
        {pose && options_.deskew ? withoutMotion(observation, out.deskew) : observation, pose});
  }
  return out;
}

mrpt::obs::CObservation::Ptr PosedLog::withoutMotion(
    const mrpt::obs::CObservation::Ptr& observation, DeskewStatistics& statistics) const {
  const auto* scan = dynamic_cast<const mrpt::obs::CObservationVelodyneScan*>(observation.get());
  if (scan == nullptr) return observation;
  const auto moved = deskewed(
      *scan, [this](double time) { return poses_.at(time); }, statistics);
  if (!moved) return observation;
  return moved;
}

}  // namespace csom::detail
