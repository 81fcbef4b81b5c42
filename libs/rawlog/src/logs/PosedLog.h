// SPDX-License-Identifier: BSD-3-Clause
// A log whose observations have poses.
#pragma once

#include <csom/rawlog/Deskew.h>
#include <csom/rawlog/PoseSource.h>
#include <csom/rawlog/RawlogReader.h>
#include <csom/rawlog/RawlogSurvey.h>

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace csom::detail {

struct PosedObservation {
  mrpt::obs::CObservation::Ptr observation;
  std::optional<mrpt::poses::CPose3D> pose;  ///< of the robot; nothing: there is none at its time
};

struct PosedEntry {
  /// Those that say something of the world: what only tells poses is left out.
  std::vector<PosedObservation> observations;
  DeskewStatistics deskew;
};

/// Reads a log that has been surveyed, up to where it is sound. An entry is handed out when its
/// poses are known, or kMaxWaiting entries later: a time stamp far ahead of all scans must not
/// collect the rest of the log in memory.
class PosedLog {
 public:
  struct Options {
    bool deskew = true;        ///< take the robot's motion out of scans
    bool load_images = false;  ///< from their files
    std::size_t skip = 0;      ///< so many entries at the beginning are handed out empty
  };

  /// `poses` must outlive this.
  PosedLog(const RawlogSurvey& survey, PoseSource& poses, const Options& options);

  std::optional<PosedEntry> next();

 private:
  static constexpr std::size_t kMaxWaiting = 256;

  bool readOne();
  PosedEntry posed(const RawlogEntry& entry);
  mrpt::obs::CObservation::Ptr withoutMotion(const mrpt::obs::CObservation::Ptr& observation,
                                             DeskewStatistics& statistics) const;

  RawlogReader reader_;
  std::size_t unread_;
  PoseSource& poses_;
  Options options_;
  std::deque<RawlogEntry> waiting_;
};

}  // namespace csom::detail
