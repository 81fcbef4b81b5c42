// SPDX-License-Identifier: BSD-3-Clause
// The observations of a run as key frames of a simplemap.
#pragma once

#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3D.h>

namespace csom::detail {

/// Collects observations with their poses: those of one entry of the log that have the same pose
/// are one key frame.
class KeyFrames {
 public:
  /// What comes from now on belongs to another entry.
  void beginEntry() { open_.reset(); }
  void add(const mrpt::obs::CObservation::Ptr& observation, const mrpt::poses::CPose3D& pose);
  mrpt::maps::CSimpleMap take() { return std::move(frames_); }

 private:
  mrpt::maps::CSimpleMap frames_;
  mrpt::obs::CSensoryFrame::Ptr open_;
  mrpt::poses::CPose3D pose_;  ///< of open_
};

}  // namespace csom::detail
