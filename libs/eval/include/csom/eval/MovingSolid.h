// SPDX-License-Identifier: BSD-3-Clause
// A solid that goes somewhere, stops, and goes on.
#pragma once

#include <csom/eval/Solid.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace csom {

/// Where something is at which time. Units: seconds since the start of the simulation, metres.
struct TimedOffset {
  double time = 0;
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< from where the solid is defined
};

/// A solid that is moved along straight lines at constant speed from one place to the next, without
/// turning. It stands at the first place before its time, and at the last one after it.
class MovingSolid {
 public:
  /// Throws std::invalid_argument if there are fewer than two places, their times do not ascend or
  /// anything is not finite.
  MovingSolid(const Solid& solid, std::vector<TimedOffset> places);

  const Solid& solid() const { return solid_; }
  const std::vector<TimedOffset>& places() const { return places_; }

  /// From where the solid is defined.
  Eigen::Vector3d offsetAt(double time) const;
  /// Solid::enter() at a time.
  std::optional<Solid::Entry> enter(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                    double time) const;
  /// The smallest box around it at all times.
  const Eigen::AlignedBox3d& bounds() const { return bounds_; }

 private:
  Solid solid_;
  std::vector<TimedOffset> places_;
  Eigen::AlignedBox3d bounds_;
};

}  // namespace csom
