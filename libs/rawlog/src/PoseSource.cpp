// SPDX-License-Identifier: BSD-3-Clause
// Where the robot was when an observation was taken.
#include <csom/core/Error.h>
#include <csom/io/TextParser.h>
#include <csom/io/TrajectoryFile.h>
#include <csom/rawlog/Deskew.h>
#include <csom/rawlog/PoseSource.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include "EigenPose.h"
#include "MrptText.h"
#include "RegisteredScans.h"

namespace csom {
namespace {

using Kind = PoseChoice::Kind;

constexpr char kAccepted[] =
    "odometry, robot-pose, robot-pose:LABEL, tum:FILE, kitti:FILE, simplemap:FILE, icp or "
    "icp:LABEL";

struct KindName {
  Kind kind;
  const char* name;
  bool needs_file;
};
constexpr KindName kKinds[] = {{Kind::Odometry, "odometry", false},
                               {Kind::RobotPose, "robot-pose", false},
                               {Kind::Tum, "tum", true},
                               {Kind::Kitti, "kitti", true},
                               {Kind::SimpleMap, "simplemap", true},
                               {Kind::Icp, "icp", false}};

/// The only track, or that of `label`.
const std::pair<const std::string, PoseTrack>& pickTrack(
    const std::map<std::string, PoseTrack>& tracks, const std::string& label,
    const std::string& file) {
  std::vector<std::string> labels;
  for (const auto& track : tracks) {
    if (track.first == label) return track;
    labels.push_back(detail::quoted(track.first));
  }
  if (!label.empty())
    throw ConfigError(file + ": no robot poses with the label " + detail::quoted(label) +
                      "; there are " + detail::joined(labels));
  if (tracks.size() > 1)
    throw ConfigError(file + ": robot poses with several labels (" + detail::joined(labels) +
                      "); choose one with --poses robot-pose:LABEL");
  return *tracks.begin();
}

PoseTrack trackOfTum(const std::string& file) {
  PoseTrack track;
  for (const TimedPose& pose : readTumTrajectory(file))
    track.add(pose.timestamp, detail::toMrpt(pose.pose));
  return track;
}

PoseTrack trackOfSimpleMap(const std::string& file) {
  const RawlogSurvey survey = surveyRawlog(file);
  if (!survey.is_simplemap) throw FileError(file, "is not a simplemap, but a rawlog");
  if (!survey.end.complete) throw FileError(file, survey.end.reason);
  if (survey.key_frames.empty())
    throw FileError(file, "no key frame has a time stamp, so it cannot give poses to a rawlog");
  return survey.key_frames;
}

}  // namespace

PoseChoice PoseChoice::parse(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  const std::string argument = colon == std::string::npos ? "" : text.substr(colon + 1);
  for (const KindName& known : kKinds) {
    if (name != known.name) continue;
    const bool takes_label = known.kind == Kind::RobotPose || known.kind == Kind::Icp;
    if (known.needs_file && argument.empty()) break;
    if (colon != std::string::npos && !known.needs_file && !takes_label) break;
    return {known.kind, argument};
  }
  throw ConfigError("--poses '" + text + "': expected " + kAccepted);
}

bool PoseChoice::takesFile() const {
  return kind == Kind::Tum || kind == Kind::Kitti || kind == Kind::SimpleMap;
}

std::string PoseChoice::toString() const {
  for (const KindName& known : kKinds) {
    if (kind == known.kind) return known.name + (argument.empty() ? "" : ":" + argument);
  }
  return "key-frames";
}

PoseSource::PoseSource(const std::optional<PoseChoice>& choice, const RawlogSurvey& survey)
    : choice_(choice ? *choice : defaultChoice(survey)) {
  if (choice_.kind == Kind::Odometry || choice_.kind == Kind::RobotPose)
    useLog(survey);
  else if (choice_.kind == Kind::Icp)
    useScans(survey);
  else
    useFile();
}

PoseSource::~PoseSource() = default;
PoseSource::PoseSource(PoseSource&&) noexcept = default;

PoseChoice PoseSource::defaultChoice(const RawlogSurvey& survey) {
  if (survey.is_simplemap) return {Kind::KeyFrames, ""};
  if (!survey.robot_poses.empty()) return {Kind::RobotPose, ""};
  if (survey.has_actions || !survey.odometry.empty()) return {Kind::Odometry, ""};
  throw ConfigError(
      survey.file +
      ": holds neither robot poses nor odometry; name a source of poses with --poses "
      "tum:FILE, kitti:FILE or simplemap:FILE, or let --poses icp register its scans");
}

void PoseSource::useLog(const RawlogSurvey& survey) {
  if (choice_.kind == Kind::RobotPose) {
    if (survey.robot_poses.empty())
      throw ConfigError(survey.file + ": holds no robot poses (CObservationRobotPose)");
    const auto& [label, track] = pickTrack(survey.robot_poses, choice_.argument, survey.file);
    choice_.argument = label;
    track_ = track;
    return;
  }
  integrates_actions_ = survey.has_actions;
  if (integrates_actions_) return;
  if (survey.odometry.empty())
    throw ConfigError(survey.file + ": holds no odometry (actions or CObservationOdometry)");
  if (survey.odometry.size() > 1)
    throw ConfigError(survey.file +
                      ": odometry of several sensor labels; keep one of them "
                      "(rawlog-edit --remove-label) or choose another --poses");
  track_ = survey.odometry.begin()->second;
}

void PoseSource::useFile() {
  if (choice_.kind == Kind::Tum) track_ = trackOfTum(choice_.argument);
  if (choice_.kind == Kind::SimpleMap) track_ = trackOfSimpleMap(choice_.argument);
  if (choice_.kind == Kind::Kitti) {
    for (const Eigen::Isometry3d& pose : readKittiPoses(choice_.argument))
      by_index_.push_back(detail::toMrpt(pose));
  }
}

void PoseSource::useScans(const RawlogSurvey& survey) {
  std::vector<std::string> labels;
  for (const auto& [label, count] : survey.scans_3d) labels.push_back(detail::quoted(label));
  if (labels.empty())
    throw ConfigError(survey.file +
                      ": holds no 3-D scans (CObservationVelodyneScan, CObservationPointCloud, "
                      "CObservationRotatingScan) that --poses icp could register");
  if (choice_.argument.empty()) {
    if (labels.size() > 1)
      throw ConfigError(survey.file + ": 3-D scans with several labels (" + detail::joined(labels) +
                        "); choose one with --poses icp:LABEL");
    choice_.argument = survey.scans_3d.begin()->first;
  } else if (survey.scans_3d.count(choice_.argument) == 0) {
    throw ConfigError(survey.file + ": no 3-D scans with the label " +
                      detail::quoted(choice_.argument) + "; there are " + detail::joined(labels));
  }
  scans_ = std::make_unique<detail::RegisteredScans>(choice_.argument);
}

void PoseSource::advance(const RawlogEntry& entry) {
  if (scans_) {
    for (const auto& observation : entry.observations) scans_->add(*observation, track_);
    return;
  }
  if (!integrates_actions_ || !entry.action) return;
  mrpt::poses::CPose3D movement;
  if (entry.action->getFirstMovementEstimationMean(movement)) integrated_ = integrated_ + movement;
}

bool PoseSource::knows(const RawlogEntry& entry) const {
  if (!scans_) return true;
  for (const auto& observation : entry.observations) {
    auto last_time = sweepEnd(*observation);
    if (!last_time) last_time = detail::secondsOf(observation->timestamp);
    if (last_time && !track_.reaches(*last_time)) return false;
  }
  return true;
}

std::optional<RegistrationReport> PoseSource::registration() const {
  if (!scans_) return std::nullopt;
  return scans_->report();
}

std::optional<mrpt::poses::CPose3D> PoseSource::poseOf(const RawlogEntry& entry,
                                                       const mrpt::obs::CObservation& observation) {
  if (choice_.kind == Kind::KeyFrames) return entry.key_frame_pose;
  if (integrates_actions_) return integrated_;
  if (choice_.kind == Kind::Kitti) {
    const std::size_t index = next_index_[observation.sensorLabel]++;
    if (index >= by_index_.size()) return std::nullopt;
    return by_index_[index];
  }
  if (choice_.kind == Kind::RobotPose) {
    for (const auto& other : entry.observations) {
      const auto* robot = dynamic_cast<const mrpt::obs::CObservationRobotPose*>(other.get());
      if (robot != nullptr && robot->sensorLabel == choice_.argument) return robot->pose.mean;
    }
  }
  const auto time = detail::secondsOf(observation.timestamp);
  return time ? track_.at(*time) : std::nullopt;
}

}  // namespace csom
