// SPDX-License-Identifier: BSD-3-Clause
// From logs to a map: what `csom map` does, without its files and its terminal.
#pragma once

#include <csom/io/TrajectoryFile.h>
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/rawlog/CheckpointRequest.h>
#include <csom/rawlog/Deskew.h>
#include <csom/rawlog/PoseSource.h>
#include <csom/rawlog/RawlogReader.h>
#include <mrpt/maps/CSimpleMap.h>

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace csom {

struct MappingRequest {
  std::vector<std::string> logs;           ///< rawlogs and simplemaps, mapped one after another
  std::string config_file;                 ///< ini with a section [MappingApplication]
  std::optional<PoseChoice> poses;         ///< nothing: the best that each log holds
  std::optional<int> threads;              ///< overrides the option of the ini
  std::optional<std::string> label_cache;  ///< folder, overrides the option of the ini
  bool deskew = true;                      ///< take the robot's motion out of Velodyne scans
  bool keep_key_frames = false;  ///< fill MappingResult::key_frames, which holds all in memory
};

/// How far a run has come: sums over all logs so far.
struct MappingProgress {
  const std::string& log;
  std::size_t entries_done = 0;
  std::size_t entries = 0;  ///< there will be
  std::size_t scans = 0;    ///< inserted
  std::size_t points_rejected = 0;
  std::size_t observations_refused = 0;
  /// As it is now, or the part of it that is not on the disk yet. Its figures are counted when they
  /// are asked for.
  const SemanticMap& map;
  std::size_t chunks_on_disk = 0;  ///< where voxels take more than CheckpointRequest::max_memory
};

struct MappedLog {
  std::string file;
  RawlogEnd end;
  PoseChoice poses;  ///< as taken
};

struct MappingResult {
  CSemanticContinuousMap::Ptr map;
  std::unique_ptr<MapStore> store;  ///< with checkpoints: all that was inserted, committed
  /// All voxels are in `map` too. False: they were more than CheckpointRequest::max_memory, and are
  /// in `store` alone.
  bool voxels_in_memory = true;
  std::vector<MappedLog> logs;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< mean z axis of the robot, in the map frame
  std::vector<double> insert_ms;                  ///< one for each of map->scans()
  std::size_t observations_read = 0;              ///< robot poses and odometry are not counted
  /// Observations that did not reach the map, by (class, reason).
  std::map<std::pair<std::string, std::string>, std::size_t> refused;
  /// Scans that cameras labelled, for pictures: the first of the run, the first of its second half,
  /// the last. Nothing where there was none.
  std::optional<LabelledScan> first_labelled;
  std::optional<LabelledScan> middle_labelled;
  std::optional<LabelledScan> last_labelled;
  std::optional<DeskewStatistics> deskew;          ///< nothing if it was not asked for
  std::optional<RegistrationReport> registration;  ///< nothing if the poses were given
  std::vector<TimedPose> trajectory;               ///< the registered poses, by time
  std::vector<std::string> warnings;               ///< one line each
  /// The observations that had a pose, with it: MRPT's observations2map makes the same map of it.
  mrpt::maps::CSimpleMap key_frames;
};

/// Throws FileError for a log or file of poses that cannot be read, or a log that refers to an
/// externalised file that is missing; ConfigError and OptionError for an ini that is wrong (unknown
/// keys in our sections included), or if several logs are to be registered; std::runtime_error if
/// no observation could be used. A log that is cut off or damaged counts as far as it can be read,
/// with a warning.
///
/// With `checkpoints` the map grows in a file as well, from which a run that has ended in whatever
/// way goes on: see CheckpointRequest. Interrupted, FileError and std::runtime_error (memory is
/// short) may then end a run that could go on; a run that fails before its first commit leaves no
/// file.
MappingResult mapLogs(const MappingRequest& request,
                      const std::function<void(const MappingProgress&)>& on_progress = {},
                      const std::optional<CheckpointRequest>& checkpoints = std::nullopt);

/// The request that the run had which left this state, but for the label cache: where files are
/// written is not for a file to say. Throws FileError, about `file`, if it is no such state.
MappingRequest readRequest(const MapStore::State& state, const std::string& file);

}  // namespace csom
