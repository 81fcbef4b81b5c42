// SPDX-License-Identifier: BSD-3-Clause
// Which frame of its data set an observation is: a log may hold every second frame from the tenth
// on, while a file of poses has a line for each.
#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservationComment.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace csom::detail {

/// Kept in a log as a comment at its beginning, by sensor label and time stamp, so that it stays
/// right when observations are cut out of the log.
class FrameNumbers {
 public:
  void add(const std::string& sensor_label, double time, std::size_t frame);
  /// Nothing if the observation is none of those that were added.
  std::optional<std::size_t> of(const mrpt::obs::CObservation& observation) const;
  bool empty() const { return frames_.empty(); }
  /// The largest. Requires !empty().
  std::size_t last() const;

  mrpt::obs::CObservationComment toComment() const;
  /// Adds what a comment of toComment() says; other comments say nothing. Throws
  /// std::runtime_error if it is one that is damaged.
  void addComment(const std::string& text);

 private:
  std::map<std::pair<std::string, std::int64_t>, std::size_t> frames_;  ///< time stamps of MRPT
};

}  // namespace csom::detail
