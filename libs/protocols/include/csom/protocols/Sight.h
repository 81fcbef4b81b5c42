// SPDX-License-Identifier: BSD-3-Clause
// What a map must say of voxels once they were in clear sight for some time.
#pragma once

#include <csom/core/types.h>
#include <csom/eval/Scenario.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace csom {

/// Seconds of clear sight after which voxels are looked at.
constexpr std::array<double, 4> kSightSeconds{1, 2, 5, 20};

/// A question to the map after an insertion.
struct SightCheck {
  std::size_t scans = 0;     ///< inserted so far
  std::size_t interval = 0;  ///< index into kSightSeconds
  bool moved = false;        ///< true: what was here went away; false: what is here stays
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of the voxel, map frame [m]
};

/// The answers for one of kSightSeconds.
struct SightFigures {
  std::size_t left_by_movers = 0;  ///< voxels that something left, each time that it did
  std::size_t ghosts = 0;          ///< of these, still held to be occupied
  std::size_t stays = 0;           ///< voxels of what stays
  std::size_t lost = 0;            ///< of these, held to be free or unknown

  /// Nothing if there was nothing to ask about.
  std::optional<double> ghostShare() const { return share(ghosts, left_by_movers); }
  std::optional<double> lostShare() const { return share(lost, stays); }

 private:
  static std::optional<double> share(std::size_t part, std::size_t of) {
    if (of == 0) return std::nullopt;
    return static_cast<double>(part) / static_cast<double>(of);
  }
};

/// Which voxels are asked about and when, in ascending order of scans.
///
/// A voxel of `resolution` takes part once a beam has ended in it: on something that moves and in a
/// voxel that is free in the truth, or on something that stays and in one that is occupied. Its
/// time of clear sight begins with the first scan in which nothing that moves reaches into it (for
/// what stays: with its first hit), and grows by the time from scan to scan in each scan in which
/// the sensor could see it: within its range and its elevations, and nothing between the sensor and
/// the voxel's centre, of what stays up to half a voxel's diagonal before it. It begins anew when
/// something that moves comes back. A voxel that is out of sight is not asked about.
///
/// `scans` are those of the scenario's only range sensor, a LiDAR that takes its turns at once
/// (`sweep: instantaneous`), with true poses; each turn has returns. Throws ConfigError otherwise.
std::vector<SightCheck> planSightChecks(const Scenario& scenario, const std::vector<Scan>& scans,
                                        double resolution);

}  // namespace csom
