// SPDX-License-Identifier: BSD-3-Clause
// Where the robot was when an observation was taken.
#include <csom/core/Error.h>
#include <csom/io/TextParser.h>
#include <csom/io/TrajectoryFile.h>
#include <csom/rawlog/Deskew.h>
#include <csom/rawlog/PoseSource.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <algorithm>
#include <cstdio>

#include "logs/FrameNumbers.h"
#include "logs/MrptText.h"
#include "poses/EigenPose.h"
#include "poses/Median.h"
#include "poses/RegisteredScans.h"

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
    throw ConfigError(
        file + ": robot poses with several labels (" + detail::joined(labels) + "); choose one",
        {"poses robot-pose:LABEL"});
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

std::string seconds(double time) {
  char text[64];
  std::snprintf(text, sizeof text, "%.3f", time);
  return text;
}

/// What is wrong with times that are a thousand, a million or a billion times too large.
std::string unitHint(const PoseGap& poses, const PoseGap& observed) {
  struct Unit {
    double a_second;
    const char* name;
  };
  constexpr Unit kUnits[] = {{1e3, "milliseconds"}, {1e6, "microseconds"}, {1e9, "nanoseconds"}};
  for (const Unit& unit : kUnits) {
    const bool fits = poses.before / unit.a_second <= observed.after &&
                      poses.after / unit.a_second >= observed.before;
    if (fits && poses.before > observed.after && observed.after > 0)
      return std::string("; the poses seem to be in ") + unit.name + ", they must be in seconds";
  }
  return "";
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
  throw ConfigError("source of poses '" + text + "': expected " + kAccepted, {"poses"});
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
    useFile(survey);
}

PoseSource::~PoseSource() = default;
PoseSource::PoseSource(PoseSource&&) noexcept = default;

PoseChoice PoseSource::defaultChoice(const RawlogSurvey& survey) {
  if (survey.is_simplemap) return {Kind::KeyFrames, ""};
  if (!survey.robot_poses.empty()) return {Kind::RobotPose, ""};
  if (survey.has_actions || !survey.odometry.empty()) return {Kind::Odometry, ""};
  throw ConfigError(
      survey.file +
          ": holds neither robot poses nor odometry; name a file of poses, or let its scans be "
          "registered",
      {"poses tum:FILE", "poses kitti:FILE", "poses simplemap:FILE", "poses icp"});
}

void PoseSource::useLog(const RawlogSurvey& survey) {
  if (choice_.kind == Kind::RobotPose) {
    if (survey.robot_poses.empty())
      throw ConfigError(survey.file + ": holds no robot poses (CObservationRobotPose)");
    const auto& [label, track] = pickTrack(survey.robot_poses, choice_.argument, survey.file);
    choice_.argument = label;
    track_ = track;
    track_.limitGapsBySpacing();
    return;
  }
  integrates_actions_ = survey.has_actions;
  if (integrates_actions_) return;
  if (survey.odometry.empty())
    throw ConfigError(survey.file + ": holds no odometry (actions or CObservationOdometry)");
  if (survey.odometry.size() > 1)
    throw ConfigError(survey.file +
                          ": odometry of several sensor labels; keep one of them "
                          "(rawlog-edit --remove-label) or choose another source of poses",
                      {"poses"});
  track_ = survey.odometry.begin()->second;
  track_.limitGapsBySpacing();
}

void PoseSource::useFile(const RawlogSurvey& survey) {
  if (choice_.kind == Kind::Kitti) {
    useKittiFile(survey);
    return;
  }
  if (choice_.kind == Kind::Tum) track_ = trackOfTum(choice_.argument);
  if (choice_.kind == Kind::SimpleMap) track_ = trackOfSimpleMap(choice_.argument);
  track_.limitGapsBySpacing();
}

/// A line of the file is a frame. Which frames the log holds it says itself; else it must hold all.
void PoseSource::useKittiFile(const RawlogSurvey& survey) {
  for (const auto& pose : readKittiPoses(choice_.argument))
    by_index_.push_back(pose ? std::make_optional(detail::toMrpt(*pose)) : std::nullopt);
  std::vector<std::string> unfitting;
  for (const auto& [label, count] : survey.sensors)
    if (count != by_index_.size())
      unfitting.push_back(std::to_string(count) + " of " + detail::quoted(label));
  if (unfitting.empty()) return;
  frames_ = survey.frames;
  if (frames_ && frames_->last() < by_index_.size()) return;
  const std::string poses = std::to_string(by_index_.size()) + " poses";
  if (frames_)
    throw ConfigError(choice_.argument + ": has " + poses + ", so none for frame " +
                      std::to_string(frames_->last()) + " (counted from 0) of " + survey.file);
  throw ConfigError(
      choice_.argument + ": has " + poses + ", but " + survey.file + " holds " +
          detail::joined(unfitting) +
          " and does not say which frames these are; give it one pose a scan, or poses "
          "with times",
      {"poses tum:FILE"});
}

void PoseSource::useScans(const RawlogSurvey& survey) {
  std::vector<std::string> labels;
  for (const auto& [label, count] : survey.scans_3d) labels.push_back(detail::quoted(label));
  if (labels.empty())
    throw ConfigError(survey.file + ": holds no 3-D scans that could be registered", {"poses"});
  if (choice_.argument.empty()) {
    if (labels.size() > 1)
      throw ConfigError(survey.file + ": 3-D scans with several labels (" + detail::joined(labels) +
                            "); choose one",
                        {"poses icp:LABEL"});
    choice_.argument = survey.scans_3d.begin()->first;
  } else if (survey.scans_3d.count(choice_.argument) == 0) {
    throw ConfigError(survey.file + ": no 3-D scans with the label " +
                      detail::quoted(choice_.argument) + "; there are " + detail::joined(labels));
  }
  constexpr double kLongestBetweenScans = 10;
  track_.limitGaps(kLongestBetweenScans);
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
  if (choice_.kind == Kind::Kitti) return byFrame(observation);
  if (choice_.kind == Kind::RobotPose) {
    for (const auto& other : entry.observations) {
      const auto* robot = dynamic_cast<const mrpt::obs::CObservationRobotPose*>(other.get());
      if (robot != nullptr && robot->sensorLabel == choice_.argument) return robot->pose.mean;
    }
  }
  return byTime(observation);
}

std::optional<mrpt::poses::CPose3D> PoseSource::byFrame(
    const mrpt::obs::CObservation& observation) {
  const std::optional<std::size_t> frame =
      frames_ ? frames_->of(observation) : next_index_[observation.sensorLabel]++;
  if (!frame || *frame >= by_index_.size()) return std::nullopt;
  return by_index_[*frame];
}

std::optional<mrpt::poses::CPose3D> PoseSource::byTime(const mrpt::obs::CObservation& observation) {
  const auto time = detail::secondsOf(observation.timestamp);
  if (!time) return std::nullopt;
  if (!observed_) observed_ = PoseGap{*time, *time};
  observed_ = PoseGap{std::min(observed_->before, *time), std::max(observed_->after, *time)};
  const auto last = last_time_.find(observation.sensorLabel);
  if (last != last_time_.end() && *time > last->second) spacings_.push_back(*time - last->second);
  last_time_[observation.sensorLabel] = *time;

  const auto pose = track_.at(*time);
  const auto gap = track_.gapAt(*time);
  if (gap)
    (pose ? interpolated_ : refused_).add(*gap);
  else if (!pose)
    ++outside_;
  return pose;
}

void PoseSource::Gaps::add(const PoseGap& gap) {
  ++observations;
  if (gap.length() > longest.length()) longest = gap;
}

std::vector<std::string> PoseSource::doubts() const {
  constexpr double kWideGap = 10;  // in distances of observations
  constexpr double kAlwaysPlausible = 1;
  std::vector<std::string> doubts;
  const auto span = [](const PoseGap& gap) {
    return seconds(gap.before) + " to " + seconds(gap.after);
  };
  if (refused_.observations > 0)
    doubts.push_back(std::to_string(refused_.observations) +
                     " observations have no pose, as they lie between poses that are too far apart "
                     "in time (the longest gap: " +
                     span(refused_.longest) + " s)");
  const double spacing = detail::computeMedian(spacings_);
  if (spacing > 0 &&
      interpolated_.longest.length() > std::max(kAlwaysPlausible, kWideGap * spacing))
    doubts.push_back("poses are interpolated across gaps of up to " +
                     seconds(interpolated_.longest.length()) + " s (" +
                     span(interpolated_.longest) + " s), while observations are " +
                     seconds(spacing) + " s apart");
  if (outside_ > 0 && observed_ && !track_.empty()) {
    const PoseGap poses{track_.poses().begin()->first, track_.poses().rbegin()->first};
    doubts.push_back(std::to_string(outside_) +
                     " observations lie outside of the time of the poses: these are from " +
                     span(poses) + " s, the observations from " + span(*observed_) + " s" +
                     unitHint(poses, *observed_));
  }
  return doubts;
}

}  // namespace csom
