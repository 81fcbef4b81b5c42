// SPDX-License-Identifier: BSD-3-Clause
// Where the robot was when an observation was taken.
#pragma once

#include <csom/rawlog/PoseTrack.h>
#include <csom/rawlog/RawlogReader.h>
#include <csom/rawlog/RawlogSurvey.h>
#include <csom/rawlog/ScanRegistration.h>
#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace csom {

namespace detail {
class RegisteredScans;
}

/// What `--poses` asks for.
struct PoseChoice {
  enum class Kind {
    Odometry,   ///< actions of the log if it has any, else its CObservationOdometry
    RobotPose,  ///< CObservationRobotPose of one sensor label
    Tum,        ///< file: `timestamp x y z qx qy qz qw` a line
    Kitti,      ///< file: 3×4 row-major matrix a line, one line a frame
    SimpleMap,  ///< key frames of a simplemap file, by their observations' time stamps
    Icp,        ///< registration of the 3-D scans of one sensor label
    KeyFrames   ///< the log is a simplemap: its own poses
  };
  Kind kind = Kind::Odometry;
  std::string argument;  ///< sensor label (may be empty) or file

  /// `odometry`, `robot-pose[:LABEL]`, `tum:FILE`, `kitti:FILE`, `simplemap:FILE`, `icp[:LABEL]`.
  /// Throws ConfigError.
  static PoseChoice parse(const std::string& text);
  bool takesFile() const;
  /// The inverse of parse(); "key-frames" for KeyFrames.
  std::string toString() const;
};

/// Poses of the robot (not of the sensor) in the map frame, for the observations of one log.
/// In order of preference if nothing is chosen: robot poses of the log, its odometry, its key
/// frames.
class PoseSource {
 public:
  /// Throws ConfigError if the log has no such poses (or several labels of them and none is
  /// chosen) or if a KITTI file has another number of poses than the log has scans, FileError for a
  /// file of poses that is wrong.
  PoseSource(const std::optional<PoseChoice>& choice, const RawlogSurvey& survey);

  ~PoseSource();
  PoseSource(PoseSource&& other) noexcept;

  const PoseChoice& choice() const { return choice_; }

  /// To be called with every entry of the log, in order, before poseOf() its observations.
  void advance(const RawlogEntry& entry);

  /// False if entries that are still to come can give poses to observations of this one: poses by
  /// registration of scans are known up to the last scan.
  bool knows(const RawlogEntry& entry) const;

  /// Nothing if there is no pose for this observation: it lies outside the time span of the poses,
  /// lies in a gap of them that is too long (see PoseTrack), or has no time stamp. Poses in time
  /// are interpolated (positions linearly, rotations by SLERP); a pose of exactly the time of the
  /// observation, or in its sensory frame, is taken as it is. With a KITTI file an observation has
  /// the pose of its frame, if the log says which frames it holds, else the n-th observation of
  /// every sensor label has the n-th pose: call once for each observation.
  std::optional<mrpt::poses::CPose3D> poseOf(const RawlogEntry& entry,
                                             const mrpt::obs::CObservation& observation);

  /// The robot at a time [s since 1970]; nothing outside of the poses, or if they have no times:
  /// sums of actions, lines of a KITTI file, poses of key frames.
  std::optional<mrpt::poses::CPose3D> at(double time) const { return track_.at(time); }

  /// What became of the scans that were registered; nothing with other poses.
  std::optional<RegistrationReport> registration() const;
  const PoseTrack& track() const { return track_; }

  /// What is to be doubted of the poses that were asked for, a line each: none at the time of some
  /// observations, with both spans of time; gaps, with both times.
  std::vector<std::string> doubts() const;

 private:
  /// Observations between two poses that are far apart.
  struct Gaps {
    std::size_t observations = 0;
    PoseGap longest;
    void add(const PoseGap& gap);
  };
  static PoseChoice defaultChoice(const RawlogSurvey& survey);
  void useLog(const RawlogSurvey& survey);
  void useFile(const RawlogSurvey& survey);
  void useKittiFile(const RawlogSurvey& survey);
  std::optional<mrpt::poses::CPose3D> byFrame(const mrpt::obs::CObservation& observation);
  std::optional<mrpt::poses::CPose3D> byTime(const mrpt::obs::CObservation& observation);
  void useScans(const RawlogSurvey& survey);

  PoseChoice choice_;
  PoseTrack track_;
  bool integrates_actions_ = false;
  mrpt::poses::CPose3D integrated_;
  std::vector<std::optional<mrpt::poses::CPose3D>> by_index_;  ///< lines of a KITTI file
  std::map<std::string, std::size_t> next_index_;
  std::shared_ptr<const detail::FrameNumbers> frames_;  ///< null: the n-th scan has the n-th pose
  Gaps refused_;                                        ///< too long to interpolate across
  Gaps interpolated_;                                   ///< all others
  std::size_t outside_ = 0;          ///< observations before the first or after the last pose
  std::optional<PoseGap> observed_;  ///< times of the first and the last observation
  std::map<std::string, double> last_time_;         ///< by sensor label
  std::vector<double> spacings_;                    ///< of the observations of one label [s]
  std::unique_ptr<detail::RegisteredScans> scans_;  ///< null for other poses
};

}  // namespace csom
