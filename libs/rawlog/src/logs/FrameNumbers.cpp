// SPDX-License-Identifier: BSD-3-Clause
// Which frame of its data set an observation is.
#include "logs/FrameNumbers.h"

#include <csom/io/TextParser.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace csom::detail {
namespace {

/// MRPT writes no sensor labels of comments: they are known by their first line.
constexpr std::string_view kFirstLine = "csom: frame, time stamp and sensor label of observations";

std::int64_t ticksOf(const mrpt::obs::CObservation& observation) {
  return static_cast<std::int64_t>(observation.timestamp.time_since_epoch().count());
}

}  // namespace

void FrameNumbers::add(const std::string& sensor_label, double time, std::size_t frame) {
  const auto ticks = mrpt::Clock::fromDouble(time).time_since_epoch().count();
  frames_[{sensor_label, static_cast<std::int64_t>(ticks)}] = frame;
}

std::optional<std::size_t> FrameNumbers::of(const mrpt::obs::CObservation& observation) const {
  const auto found = frames_.find({observation.sensorLabel, ticksOf(observation)});
  if (found == frames_.end()) return std::nullopt;
  return found->second;
}

std::size_t FrameNumbers::last() const {
  std::size_t last = 0;
  for (const auto& [place, frame] : frames_) last = std::max(last, frame);
  return last;
}

mrpt::obs::CObservationComment FrameNumbers::toComment() const {
  mrpt::obs::CObservationComment comment;
  comment.text = std::string(kFirstLine) + "\n";
  for (const auto& [place, frame] : frames_) {
    comment.text += std::to_string(frame) + " " + std::to_string(place.second) + " " + place.first;
    comment.text += "\n";
  }
  return comment;
}

void FrameNumbers::addComment(const std::string& text) {
  LineReader lines(text);
  std::string_view first;
  if (!lines.next(first) || first != kFirstLine) return;
  std::vector<std::string_view> columns;
  for (std::string_view line; lines.next(line);) {
    splitColumns(line, columns);
    std::size_t frame = 0;
    std::int64_t ticks = 0;
    if (columns.size() != 3 || !parseNumber(columns[0], frame) || !parseNumber(columns[1], ticks))
      throw std::runtime_error("line " + std::to_string(lines.lineNumber()) +
                               " of its frame numbers is damaged: " + quoted(line));
    frames_[{std::string(columns[2]), ticks}] = frame;
  }
}

}  // namespace csom::detail
