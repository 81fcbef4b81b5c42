// SPDX-License-Identifier: BSD-3-Clause
// From logs to a map: what `csom map` does, without its files and its terminal.
#include <csom/core/Error.h>
#include <csom/core/ScanPreparation.h>
#include <csom/io/InputFile.h>
#include <csom/io/TextParser.h>
#include <csom/rawlog/MappingRun.h>
#include <csom/rawlog/RawlogSurvey.h>
#include <csom/rawlog/ReadAhead.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <new>
#include <stdexcept>

#include "Checkpoints.h"
#include "CrashReport.h"
#include "EigenPose.h"
#include "ExternalFiles.h"
#include "MappingState.h"
#include "MrptText.h"
#include "ObservationKind.h"
#include "PosedLog.h"

namespace csom {
namespace {

using mrpt::poses::CPose3D;

/// Not worth a warning: logs hold many kinds of observations.
constexpr char kOtherKind[] = "of a kind that this map does not take";

constexpr char kNoLabelSource[] = "no label source of the ini names their sensor label";
constexpr char kNoPoints[] = "none of its points can be used";

/// Enough for the network to find the next scan ready, few enough for memory.
constexpr std::size_t kEntriesAhead = 8;

std::string counted(std::size_t count, const std::string& things) {
  return std::to_string(count) + " " + things;
}

/// Nothing if the observation was taken.
std::optional<std::string> whyNotTaken(const LastInsertion& last) {
  switch (last.outcome) {
    case LastInsertion::Outcome::Damaged:
      return "damaged: " + last.reason;
    case LastInsertion::Outcome::Disabled:
      return "the map's enableObservationInsertion is false";
    case LastInsertion::Outcome::NotTaken:
      return kOtherKind;
    case LastInsertion::Outcome::NoPoints:  // counted with the scans that it completed
    case LastInsertion::Outcome::Inserted:
    case LastInsertion::Outcome::Kept:
      break;
  }
  return std::nullopt;
}

CSemanticContinuousMap::TMapDefinition definitionOf(const std::string& file) {
  if (std::filesystem::is_directory(file))
    throw ConfigError(file + ": is a folder, not an ini file");
  try {
    return CSemanticContinuousMap::definitionFromIni(file);
  } catch (const FileError&) {
    throw;
  } catch (const ConfigError&) {
    throw;
  } catch (const std::exception& error) {
    throw ConfigError(file + ": is no ini file: " + detail::oneLine(error));
  }
}

CSemanticContinuousMap::Ptr emptyMap(const MappingRequest& request) {
  auto definition = definitionOf(request.config_file);
  if (const auto unknown = definition.unknownKeys(); !unknown.empty()) {
    std::string rest;
    if (unknown.size() > 1) rest = " (and " + std::to_string(unknown.size() - 1) + " more)";
    throw ConfigError(unknown.front() + ": no such key" + rest +
                      "; docs/ini-reference.md lists all");
  }
  if (request.threads) definition.options.threads = *request.threads;
  if (request.label_cache) definition.labelOpts.label_cache = *request.label_cache;
  auto map = std::make_shared<CSemanticContinuousMap>(definition);
  map->announce_damaged = false;  // it is reported as refused
  {
    const detail::CrashReport report("csom: " + request.config_file +
                                     ": a network makes OpenCV crash while it is read; its model "
                                     "file is damaged");
    map->openLabelSources();
  }
  return map;
}

/// One run: logs in, MappingResult out.
class MappingRun {
 public:
  MappingRun(const MappingRequest& request,
             const std::function<void(const MappingProgress&)>& on_progress,
             const std::optional<CheckpointRequest>& checkpoints)
      : request_(request), on_progress_(on_progress), checkpoint_request_(checkpoints) {}

  MappingResult run() {
    result_.map = emptyMap(request_);
    if (request_.deskew) state_.deskew.emplace();
    // All that can be wrong with the input is found out before the long part starts.
    std::vector<PoseSource> poses;
    std::vector<RawlogSurvey> surveys;
    if (request_.poses && request_.poses->kind == PoseChoice::Kind::Icp && request_.logs.size() > 1)
      throw ConfigError("--poses icp: " + std::to_string(request_.logs.size()) +
                        " logs would each begin at the same place; map them one by one");
    requireDifferentLogs();
    for (const std::string& log : request_.logs) {
      surveys.push_back(survey(log));
      poses.emplace_back(request_.poses, surveys.back());
      entries_ += surveys.back().end.entries;
    }
    if (checkpoint_request_)
      checkpoints_.emplace(*checkpoint_request_, request_, result_.map, state_);
    try {
      mapAll(surveys, poses);
    } catch (const std::exception&) {
      if (checkpoints_) checkpoints_->discardIfEmpty();
      throw;
    }
    return std::move(result_);
  }

 private:
  void requireDifferentLogs() const;
  RawlogSurvey survey(const std::string& log);
  void mapAll(const std::vector<RawlogSurvey>& surveys, std::vector<PoseSource>& poses);
  void mapLog(const RawlogSurvey& survey, PoseSource& poses, std::size_t entries_before);
  void mapEntry(const detail::PosedEntry& entry);
  void keepEntry(const detail::PosedEntry& entry);
  void mapInMemory(const detail::PosedEntry& entry);
  MappingProgress progress(const std::string& log) const;
  void notePoses(const std::string& log, const PoseSource& poses);
  void insert(const mrpt::obs::CObservation& observation, const CPose3D& pose);
  void flush();
  void noteScans(std::size_t scans_before, double elapsed_ms);
  void keepSeen(const LabelledScan& scan);
  void keep(const mrpt::obs::CObservation::Ptr& observation, const CPose3D& pose);
  void refuse(const mrpt::obs::CObservation& observation, const std::string& reason) {
    refuse(detail::shortName(observation.GetRuntimeClass()->className), reason);
  }
  void refuse(const std::string& observation_class, const std::string& reason) {
    ++state_.refused[{observation_class, reason}];
    // A log holds many kinds of observations, and not to want them is no trouble.
    if (reason != kOtherKind && reason != kNoLabelSource) ++state_.observations_refused;
  }
  void warn(const std::string& text) { result_.warnings.push_back(text); }
  std::string rangeHint() const;
  void warnAboutPoints();
  void warnAboutViews(const CameraStatistics& cameras);
  void warnAboutCameras();
  void finish();
  std::string whyEmpty() const;

  const MappingRequest& request_;
  const std::function<void(const MappingProgress&)>& on_progress_;
  const std::optional<CheckpointRequest>& checkpoint_request_;
  MappingResult result_;
  detail::MappingState state_;  ///< all that is counted, as far as it goes into the result
  std::optional<detail::Checkpoints> checkpoints_;
  std::size_t entries_ = 0;
  std::size_t entries_done_ = 0;
  /// Key frame that the entry at hand has opened, to which observations of the same pose are added.
  mrpt::obs::CSensoryFrame::Ptr open_frame_;
  CPose3D open_frame_pose_;
};

/// A log that is named twice would count twice.
void MappingRun::requireDifferentLogs() const {
  if (request_.logs.size() < 2) return;
  std::map<std::string, std::string> file_of;
  for (const std::string& log : request_.logs) {
    const auto [same, is_new] = file_of.emplace(detail::fileHash(log), log);
    if (!is_new)
      throw ConfigError(log + ": has the same content as " + same->second +
                        ": its scans would count twice; name each log once");
  }
}

RawlogSurvey MappingRun::survey(const std::string& log) {
  RawlogSurvey found = surveyRawlog(log);
  if (found.missing_files > 0)
    throw FileError(log, found.first_missing + " is missing (" +
                             counted(found.missing_files, "such files") +
                             "); put it there, or remove these observations with rawlog-edit "
                             "--remove-label");
  if (!found.end.complete)
    warn(log + ": " + found.end.reason + "; mapped what it holds before, " +
         counted(found.end.entries, "entries") + " in " + counted(found.end.bytes, "bytes"));
  if (found.invalid_poses > 0)
    warn(log + ": left out " + counted(found.invalid_poses, "poses") +
         " that are not finite or have no time stamp");
  if (request_.keep_key_frames && found.external_files > 0)
    warn(log + ": " + counted(found.external_files, "of its images or clouds") +
         " are files of their own; the simplemap refers to where they are now");
  return found;
}

void MappingRun::mapAll(const std::vector<RawlogSurvey>& surveys, std::vector<PoseSource>& poses) {
  result_.map->setLabelledScanObserver([this](const LabelledScan& scan) { keepSeen(scan); });
  const detail::MappingState before = state_;  // of an earlier run that this one goes on with
  for (std::size_t i = 0; i < surveys.size(); ++i) {
    result_.logs.push_back({surveys[i].file, surveys[i].end, poses[i].choice()});
    const std::size_t all = surveys[i].end.entries;
    mapLog(surveys[i], poses[i], i < before.log ? all : i == before.log ? before.entries : 0);
    if (i < before.log) continue;
    state_.log = i + 1;
    state_.entries = 0;
  }
  result_.map->setLabelledScanObserver({});
  if (checkpoints_) checkpoints_->commit(*result_.map, state_);
  finish();
}

/// `entries_before` of the log are in the map already: their poses are needed, no more.
void MappingRun::mapLog(const RawlogSurvey& survey, PoseSource& poses, std::size_t entries_before) {
  const bool mapped_before =
      entries_before == survey.end.entries && state_.log > result_.logs.size() - 1;
  if (!mapped_before || request_.keep_key_frames) {
    const bool cameras = result_.map->labelOptions.usesCameras();
    const std::size_t skip = request_.keep_key_frames ? 0 : entries_before;
    detail::PosedLog log(survey, poses, {request_.deskew, cameras, skip});
    ReadAhead<detail::PosedEntry> entries(kEntriesAhead, [&log] { return log.next(); });
    for (std::size_t done = 0; const auto entry = entries.next();) {
      if (++done <= entries_before) {
        keepEntry(*entry);
      } else {
        mapInMemory(*entry);
        state_.entries = done;
        if (checkpoints_) checkpoints_->afterEntry(*result_.map, state_);
      }
      ++entries_done_;
      if (on_progress_) on_progress_(progress(survey.file));
    }
  } else {
    entries_done_ += survey.end.entries;
  }
  if (!mapped_before) flush();
  notePoses(survey.file, poses);
}

/// An insertion that memory was too short for may be in the map by half: what counts is what was
/// committed before.
void MappingRun::mapInMemory(const detail::PosedEntry& entry) {
  try {
    mapEntry(entry);
  } catch (const std::bad_alloc&) {
    if (!checkpoints_) throw;
    throw std::runtime_error("memory is used up; " +
                             std::to_string(checkpoints_->scansCommitted()) +
                             " scans are saved, and --max-memory maps the rest with less");
  }
}

void MappingRun::mapEntry(const detail::PosedEntry& entry) {
  if (state_.deskew) *state_.deskew += entry.deskew;
  for (const auto& [observation, pose] : entry.observations) {
    ++state_.observations_read;
    if (!pose) {
      refuse(*observation, "no pose at its time");
      continue;
    }
    insert(*observation, *pose);
  }
  keepEntry(entry);
}

void MappingRun::keepEntry(const detail::PosedEntry& entry) {
  open_frame_.reset();
  if (!request_.keep_key_frames) return;
  for (const auto& [observation, pose] : entry.observations) {
    if (pose) keep(observation, *pose);
  }
}

void MappingRun::notePoses(const std::string& log, const PoseSource& poses) {
  for (const std::string& doubt : poses.doubts()) warn(log + ": " + doubt);
  result_.registration = poses.registration();
  if (!result_.registration) return;
  for (const auto& [time, pose] : poses.track().poses())
    result_.trajectory.push_back({time, detail::toEigen(pose)});
  const RegistrationReport& report = *result_.registration;
  for (const std::string& doubt : report.doubts) warn(doubt);
  if (report.doubtful > report.doubts.size())
    warn("registration of " + counted(report.doubtful, "scans in all is doubtful"));
}

void MappingRun::insert(const mrpt::obs::CObservation& observation, const CPose3D& pose) {
  CSemanticContinuousMap& map = *result_.map;
  const Eigen::Vector3d position(pose.x(), pose.y(), pose.z());
  if (position.cwiseAbs().maxCoeff() > state_.farthest.cwiseAbs().maxCoeff())
    state_.farthest = position;
  const std::size_t scans_before = map.scans().size();
  const auto start = std::chrono::steady_clock::now();
  map.insertObservation(observation, pose);
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - start;
  noteScans(scans_before, elapsed.count());

  const LastInsertion last = map.lastInsertion();
  if (auto reason = whyNotTaken(last)) {
    if (reason == kOtherKind && map.labelOptions.usesCameras() && detail::isImage(observation))
      reason = kNoLabelSource;
    refuse(observation, *reason);
    return;
  }
  const auto rotation = pose.getRotationMatrix();
  state_.up += Eigen::Vector3d(rotation(0, 2), rotation(1, 2), rotation(2, 2));
}

/// What one log leaves waiting is not joined with the images of the next.
void MappingRun::flush() {
  const std::size_t scans_before = result_.map->scans().size();
  const auto start = std::chrono::steady_clock::now();
  result_.map->flush();
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - start;
  noteScans(scans_before, elapsed.count());
}

void MappingRun::noteScans(std::size_t scans_before, double elapsed_ms) {
  for (const std::string& name : result_.map->lastInsertion().without_points)
    refuse(name, kNoPoints);
  const auto& scans = result_.map->scans();
  const std::size_t added = scans.size() - scans_before;
  for (std::size_t i = scans_before; i < scans.size(); ++i) {
    state_.insert_ms.push_back(elapsed_ms / static_cast<double>(added));
    state_.points_rejected += scans[i].report.rejectedTotal();
  }
}

MappingProgress MappingRun::progress(const std::string& log) const {
  const CSemanticContinuousMap& map = *result_.map;
  const InsertionStatistics& statistics = map.statistics();
  std::size_t rejected =
      state_.points_rejected + statistics.unused.rejectedTotal() + statistics.labels.dropped();
  if (const auto cameras = map.cameraStatistics()) rejected += cameras->pointsRejected();
  const bool in_parts = checkpoints_ && !checkpoints_->voxelsInMemory();
  return {log,       entries_done_,
          entries_,  map.scans().size(),
          rejected,  state_.observations_refused,
          map.map(), in_parts ? checkpoints_->chunksCommitted() : 0};
}

void MappingRun::keepSeen(const LabelledScan& scan) {
  if (!result_.first_labelled) result_.first_labelled = scan;
  if (!result_.middle_labelled && 2 * entries_done_ >= entries_) result_.middle_labelled = scan;
  result_.last_labelled = scan;
}

void MappingRun::keep(const mrpt::obs::CObservation::Ptr& observation, const CPose3D& pose) {
  if (!open_frame_ || !(open_frame_pose_ == pose)) {
    open_frame_ = std::make_shared<mrpt::obs::CSensoryFrame>();
    open_frame_pose_ = pose;
    const mrpt::poses::CPose3DPDF::Ptr exact =
        std::make_shared<mrpt::poses::CPose3DPDFGaussian>(pose);
    result_.key_frames.insert(exact, open_frame_);
  }
  open_frame_->insert(detail::withAbsoluteImagePaths(observation));
}

/// How far a map and a scan reach, and what to do with coordinates of a country's grid.
std::string MappingRun::rangeHint() const {
  const Options& options = result_.map->map().options();
  const double reach = options.resolution * kMaxVoxelIndex;
  std::string farthest;
  if (state_.farthest.cwiseAbs().maxCoeff() > reach) {
    char place[128];
    std::snprintf(place, sizeof place, "; the robot was at (%.1f, %.1f, %.1f)", state_.farthest.x(),
                  state_.farthest.y(), state_.farthest.z());
    farthest = place;
  }
  char text[320];
  std::snprintf(
      text, sizeof text,
      "; with voxels of %g m a map reaches %.0f km from its origin along each axis, and a "
      "scan %.0f km from its sensor%s. Subtract one offset from all poses (for UTM, the "
      "position of the first one), or take larger voxels",
      options.resolution, reach / 1000, scanReach(options) / 1000, farthest.c_str());
  return text;
}

void MappingRun::warnAboutPoints() {
  const InsertionStatistics& statistics = result_.map->statistics();
  ScanReport sum = statistics.unused;
  for (const ScanRecord& scan : result_.map->scans()) sum += scan.report;
  for (std::size_t i = 0; i < kRejectReasons; ++i) {
    const auto reason = static_cast<RejectReason>(i);
    // A range limit is a wish of the user's, not a fault of the data.
    if (reason == RejectReason::TooNear || reason == RejectReason::TooFar) continue;
    if (sum.rejected[i] == 0) continue;
    warn("rejected " + counted(sum.rejected[i], "points: ") + toString(reason) +
         (reason == RejectReason::OutsideIndexRange ? rangeHint() : ""));
  }
  const std::string set = "'" + result_.map->labels().name() + "'";
  const LabelCounts& labels = statistics.labels;
  const auto warnAboutUnknown = [&](const char* what, std::size_t count, const char* rest) {
    if (count == 0) return;
    warn(what + counted(count, "points whose label is not in the label set ") + set +
         ", or means free" + rest +
         "; if their intensities are no labels, set point_labels = none");
  };
  warnAboutUnknown("left out ", labels.unknown, "");
  warnAboutUnknown("kept ", labels.kept_unknown, ", as unlabelled");
  if (labels.ambiguous > 0)
    warn("left out " + counted(labels.ambiguous, "points with several labels"));
  if (labels.missing > 0)
    warn("left out " + counted(labels.missing, "points without a label") +
         "; unlabelled_class or scan_2d_class can give them a class, such as unlabelled");
}

/// Cameras that look past nearly all points are probably turned the wrong way.
void MappingRun::warnAboutViews(const CameraStatistics& cameras) {
  constexpr double kNearlyAll = 0.98;
  const std::size_t outside = cameras.points[static_cast<std::size_t>(PointFate::OutsideView)];
  std::size_t all = 0;
  for (const std::size_t count : cameras.points) all += count;
  if (cameras.scans_labelled == 0 ||
      static_cast<double>(outside) < kNearlyAll * static_cast<double>(all))
    return;
  std::string text = std::to_string(outside) + " of " + counted(all, "points lie") +
                     " outside of the view of all cameras";
  for (const CameraStatistics::Source& source : cameras.sources) {
    if (source.images_read == source.images_refused) continue;
    char axis[96];
    std::snprintf(axis, sizeof axis, "; %s looks along (%.2f, %.2f, %.2f) of the robot",
                  detail::quoted(source.sensor_label).c_str(), source.looks_along[0],
                  source.looks_along[1], source.looks_along[2]);
    text += axis;
  }
  warn(text +
       " (x ahead, y left, z up). The pose of a camera has z along its view, x to the right "
       "and y down; one with the axes of the robot lacks a turn by yaw -90, roll -90 degrees");
}

void MappingRun::warnAboutCameras() {
  const auto cameras = result_.map->cameraStatistics();
  if (!cameras) return;
  for (const CameraStatistics::Source& source : cameras->sources) {
    if (source.images_read == 0)
      warn("label source " + detail::quoted(source.sensor_label) + ": no image of it was read");
  }
  if (!cameras->cache_fault.empty())
    warn("what networks said is not kept for later runs from here on: " + cameras->cache_fault);
  warnAboutViews(*cameras);
  if (cameras->scans_without_image > 0)
    warn(counted(cameras->scans_without_image, "scans") +
         " had no image within max_time_offset: their points have no label");
}

void MappingRun::finish() {
  result_.insert_ms = state_.insert_ms;
  result_.observations_read = state_.observations_read;
  result_.refused = state_.refused;
  result_.deskew = state_.deskew;
  if (result_.deskew && result_.deskew->not_possible > 0)
    warn(counted(result_.deskew->not_possible, "scans") +
         " are in the map as if the robot had stood still while they were taken: the poses do not "
         "span the time of their packets");
  if (state_.up.norm() > 0) result_.up = state_.up.normalized();
  warnAboutPoints();
  warnAboutCameras();
  for (const auto& [what, count] : result_.refused) {
    if (what.second == kOtherKind || what.second == kNoLabelSource) continue;
    warn("refused " + counted(count, what.first) + ": " + what.second);
  }
  if (result_.map->scans().empty()) throw std::runtime_error(whyEmpty());
  if (!checkpoints_) return;
  result_.voxels_in_memory = checkpoints_->voxelsInMemory();
  result_.store = checkpoints_->release();
}

std::string MappingRun::whyEmpty() const {
  std::string text = request_.logs.front();
  if (request_.logs.size() > 1)
    text += " and " + std::to_string(request_.logs.size() - 1) + " more";
  text += ": no observation could be used";
  if (result_.observations_read == 0) text += "; it holds none";
  for (const auto& [what, count] : result_.refused)
    text += "; " + counted(count, what.first) + ": " + what.second;
  for (const std::string& warning : result_.warnings) {
    if (warning.rfind("refused ", 0) != 0) text += "; " + warning;
  }
  return text;
}

}  // namespace

MappingResult mapLogs(const MappingRequest& request,
                      const std::function<void(const MappingProgress&)>& on_progress,
                      const std::optional<CheckpointRequest>& checkpoints) {
  return MappingRun(request, on_progress, checkpoints).run();
}

}  // namespace csom
