// SPDX-License-Identifier: BSD-3-Clause
// From logs to a map: what `csom map` does, without its files and its terminal.
#include <csom/core/Error.h>
#include <csom/io/InputFile.h>
#include <csom/io/TextParser.h>
#include <csom/rawlog/MappingRun.h>
#include <csom/rawlog/RawlogSurvey.h>
#include <csom/rawlog/ReadAhead.h>

#include <chrono>
#include <filesystem>
#include <new>

#include "logs/MrptText.h"
#include "logs/ObservationKind.h"
#include "logs/PosedLog.h"
#include "poses/EigenPose.h"
#include "run/Checkpoints.h"
#include "run/CrashReport.h"
#include "run/KeyFrames.h"
#include "run/MappingState.h"
#include "run/MappingWarnings.h"

namespace csom {
namespace {

using mrpt::poses::CPose3D;

/// Not worth a warning: logs hold many kinds of observations.
constexpr char kOtherKind[] = "of a kind that this map does not take";

constexpr char kNoLabelSource[] = "no label source of the ini names their sensor label";
constexpr char kNoPoints[] = "none of its points can be used";

/// Enough for the network to find the next scan ready, few enough for memory.
constexpr std::size_t kEntriesAhead = 8;

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

CSemanticContinuousMap::TMapDefinition loadDefinition(const std::string& file) {
  if (std::filesystem::is_directory(file))
    throw ConfigError(file + ": is a folder, not an ini file");
  try {
    return CSemanticContinuousMap::definitionFromIni(file);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw ConfigError(file + ": is no ini file: " + detail::oneLine(error));
  }
}

CSemanticContinuousMap::Ptr emptyMap(const MappingRequest& request) {
  auto definition = loadDefinition(request.config_file);
  if (const auto unknown = definition.unknownKeys(); !unknown.empty()) {
    std::string rest;
    if (unknown.size() > 1) rest = " (and " + std::to_string(unknown.size() - 1) + " more)";
    throw ConfigError(unknown.front() + ": no such key" + rest +
                      "; docs/ini-reference.md lists all");
  }
  if (request.threads) definition.options.threads = *request.threads;
  if (request.label_cache) definition.labelOpts.label_cache = *request.label_cache;
  auto map = std::make_shared<CSemanticContinuousMap>(definition);
  map->warn_of_damaged = false;  // it is reported as refused
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
      throw ConfigError("registered, " + std::to_string(request_.logs.size()) +
                            " logs would each begin at the same place; map them one by one",
                        {"poses icp"});
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
  void sample(const LabelledScan& scan);
  void refuse(const mrpt::obs::CObservation& observation, const std::string& reason) {
    refuse(detail::shortName(observation.GetRuntimeClass()->className), reason);
  }
  void refuse(const std::string& observation_class, const std::string& reason) {
    ++state_.refused[{observation_class, reason}];
    // A log holds many kinds of observations, and not to want them is no trouble.
    if (reason != kOtherKind && reason != kNoLabelSource) ++state_.observations_refused;
  }
  void warn(const std::string& text) { result_.warnings.push_back(text); }
  void finish();

  const MappingRequest& request_;
  const std::function<void(const MappingProgress&)>& on_progress_;
  const std::optional<CheckpointRequest>& checkpoint_request_;
  MappingResult result_;
  detail::MappingState state_;  ///< all that is counted, as far as it goes into the result
  std::optional<detail::Checkpoints> checkpoints_;
  std::size_t entries_ = 0;
  std::size_t entries_done_ = 0;
  detail::KeyFrames key_frames_;
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
                             detail::counted(found.missing_files, "such files") +
                             "); put it there, or remove these observations with rawlog-edit "
                             "--remove-label");
  if (!found.end.complete)
    warn(log + ": " + found.end.reason + "; mapped what it holds before, " +
         detail::counted(found.end.entries, "entries") + " in " +
         detail::counted(found.end.bytes, "bytes"));
  if (found.invalid_poses > 0)
    warn(log + ": left out " + detail::counted(found.invalid_poses, "poses") +
         " that are not finite or have no time stamp");
  if (request_.keep_key_frames && found.external_files > 0)
    warn(log + ": " + detail::counted(found.external_files, "of its images or clouds") +
         " are files of their own; the simplemap refers to where they are now");
  return found;
}

void MappingRun::mapAll(const std::vector<RawlogSurvey>& surveys, std::vector<PoseSource>& poses) {
  result_.map->setLabelledScanObserver([this](const LabelledScan& scan) { sample(scan); });
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
    throw Error("memory is used up; " + std::to_string(checkpoints_->scansCommitted()) +
                    " scans are saved, and the rest can be mapped with less",
                {"max-memory"});
  }
}

void MappingRun::mapEntry(const detail::PosedEntry& entry) {
  if (state_.deskew) addStatistics(*state_.deskew, entry.deskew);
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
  if (!request_.keep_key_frames) return;
  key_frames_.beginEntry();
  for (const auto& [observation, pose] : entry.observations) {
    if (pose) key_frames_.add(observation, *pose);
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
  if (report.statistics.doubtful > report.doubts.size())
    warn("registration of " +
         detail::counted(report.statistics.doubtful, "scans in all is doubtful"));
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
  if (const auto cameras = map.cameraStatistics()) rejected += cameras->points.rejected();
  const bool in_parts = checkpoints_ && !checkpoints_->voxelsInMemory();
  return {log,       entries_done_,
          entries_,  map.scans().size(),
          rejected,  state_.observations_refused,
          map.map(), in_parts ? checkpoints_->chunksCommitted() : 0};
}

void MappingRun::sample(const LabelledScan& scan) {
  if (!result_.first_labelled) result_.first_labelled = scan;
  if (!result_.middle_labelled && 2 * entries_done_ >= entries_) result_.middle_labelled = scan;
  result_.last_labelled = scan;
}

void MappingRun::finish() {
  result_.insert_ms = state_.insert_ms;
  result_.observations_read = state_.observations_read;
  result_.refused = state_.refused;
  result_.deskew = state_.deskew;
  if (result_.deskew && result_.deskew->not_possible > 0)
    warn(detail::counted(result_.deskew->not_possible, "scans") +
         " are in the map as if the robot had stood still while they were taken: the poses do not "
         "span the time of their packets");
  if (state_.up.norm() > 0) result_.up = state_.up.normalized();
  for (const std::string& warning : detail::warningsAbout(*result_.map, state_.farthest))
    warn(warning);
  for (const auto& [what, count] : result_.refused) {
    if (what.second == kOtherKind || what.second == kNoLabelSource) continue;
    warn("refused " + detail::counted(count, what.first) + ": " + what.second);
  }
  if (result_.map->scans().empty()) throw Error(detail::whyEmpty(request_, result_));
  result_.key_frames = key_frames_.take();
  if (!checkpoints_) return;
  result_.voxels_in_memory = checkpoints_->voxelsInMemory();
  result_.store = checkpoints_->release();
}

}  // namespace

MappingResult mapLogs(const MappingRequest& request,
                      const std::function<void(const MappingProgress&)>& on_progress,
                      const std::optional<CheckpointRequest>& checkpoints) {
  return MappingRun(request, on_progress, checkpoints).run();
}

}  // namespace csom
