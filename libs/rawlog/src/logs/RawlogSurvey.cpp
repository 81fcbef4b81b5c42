// SPDX-License-Identifier: BSD-3-Clause
// A first reading of a log: how long it is and which poses it holds.
#include <csom/core/Error.h>
#include <csom/io/TextParser.h>
#include <csom/maps/PointExtractor.h>
#include <csom/rawlog/RawlogSurvey.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <filesystem>

#include "logs/ExternalFiles.h"
#include "logs/FrameNumbers.h"
#include "logs/MrptText.h"
#include "logs/ObservationKind.h"

namespace csom {
namespace {

void addPose(RawlogSurvey& survey, PoseTrack& track, const mrpt::Clock::time_point& timestamp,
             const mrpt::poses::CPose3D& pose) {
  const auto time = detail::secondsOf(timestamp);
  if (!time || !track.add(*time, pose)) ++survey.invalid_poses;
}

void surveyObservation(RawlogSurvey& survey, const mrpt::obs::CObservation& observation) {
  ++survey.observations;
  if (detail::isScan3D(observation)) ++survey.scans_3d[observation.sensorLabel];
  if (findPointExtractor(observation) != nullptr || detail::isImage(observation))
    ++survey.sensors[observation.sensorLabel];
  if (const auto* robot = dynamic_cast<const mrpt::obs::CObservationRobotPose*>(&observation)) {
    addPose(survey, survey.robot_poses[robot->sensorLabel], robot->timestamp, robot->pose.mean);
  } else if (const auto* wheels =
                 dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) {
    addPose(survey, survey.odometry[wheels->sensorLabel], wheels->timestamp,
            mrpt::poses::CPose3D(wheels->odometry));
  }
}

void surveyKeyFrame(RawlogSurvey& survey, const RawlogEntry& entry) {
  for (const auto& observation : entry.observations) {
    if (!detail::secondsOf(observation->timestamp)) continue;
    addPose(survey, survey.key_frames, observation->timestamp, *entry.key_frame_pose);
    return;
  }
  ++survey.invalid_poses;
}

void surveyFiles(RawlogSurvey& survey, std::size_t entry,
                 const mrpt::obs::CObservation& observation) {
  for (const std::string& file : detail::listExternalFiles(observation)) {
    ++survey.external_files;
    std::error_code error;
    if (std::filesystem::is_regular_file(file, error)) continue;
    if (survey.missing_files++ == 0)
      survey.first_missing = "entry " + std::to_string(entry) + " (" +
                             detail::quoted(observation.sensorLabel) +
                             "): " + detail::printable(file);
  }
}

void addFrames(detail::FrameNumbers& frames, const std::string& comment, const std::string& file,
               std::size_t entry) {
  try {
    frames.addComment(comment);
  } catch (const std::exception& error) {
    throw FileError(file, "entry " + std::to_string(entry) + ": " + error.what());
  }
}

}  // namespace

RawlogSurvey surveyRawlog(const std::string& file) {
  RawlogReader reader(file);
  RawlogSurvey survey;
  survey.file = file;
  survey.is_simplemap = reader.isSimpleMap();
  auto frames = std::make_shared<detail::FrameNumbers>();
  while (const auto entry = reader.next()) {
    survey.has_actions = survey.has_actions || entry->action;
    addFrames(*frames, entry->comment, file, entry->index);
    for (const auto& observation : entry->observations) {
      surveyObservation(survey, *observation);
      surveyFiles(survey, entry->index, *observation);
    }
    if (entry->key_frame_pose) surveyKeyFrame(survey, *entry);
  }
  survey.end = reader.end();
  if (!frames->empty()) survey.frames = frames;
  return survey;
}

}  // namespace csom
