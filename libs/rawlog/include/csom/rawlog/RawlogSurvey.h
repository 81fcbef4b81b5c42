// SPDX-License-Identifier: BSD-3-Clause
// A first reading of a log: how long it is and which poses it holds.
#pragma once

#include <csom/rawlog/PoseTrack.h>
#include <csom/rawlog/RawlogReader.h>

#include <cstddef>
#include <map>
#include <memory>
#include <string>

namespace csom {

namespace detail {
class FrameNumbers;
}

struct RawlogSurvey {
  std::string file;
  RawlogEnd end;
  bool is_simplemap = false;
  std::size_t observations = 0;
  bool has_actions = false;                      ///< any entry is an action
  std::map<std::string, PoseTrack> robot_poses;  ///< by sensor label
  std::map<std::string, PoseTrack> odometry;     ///< CObservationOdometry, by sensor label
  std::map<std::string, std::size_t> scans_3d;   ///< what `--poses icp` takes, by sensor label
  std::map<std::string, std::size_t> sensors;    ///< scans and images of any kind, by sensor label
  /// Nothing if the log does not say which frame of a data set its observations are.
  std::shared_ptr<const detail::FrameNumbers> frames;
  PoseTrack key_frames;            ///< of a simplemap, at the first time stamp of each key frame
  std::size_t invalid_poses = 0;   ///< poses left out: not finite or without a time stamp
  std::size_t external_files = 0;  ///< externalised images and clouds
  std::size_t missing_files = 0;   ///< those of them that are not there
  std::string first_missing;       ///< entry, sensor label and path of the first one
};

/// Reads the whole log, keeping only its poses. Throws FileError as RawlogReader does.
RawlogSurvey surveyRawlog(const std::string& file);

}  // namespace csom
