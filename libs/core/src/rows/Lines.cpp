// SPDX-License-Identifier: BSD-3-Clause
#include "rows/Lines.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "util/Median.h"

namespace csom::detail {

namespace {

constexpr std::size_t kFewest = 4;  ///< lines, and points of a line
/// Ends of lines are farther apart than so many points of a line.
constexpr float kJump = 3;

/// Of directions of length 1, or (0,0,0) where a point has none.
class UnitVectors {
 public:
  explicit UnitVectors(const std::vector<Eigen::Vector3f>& points) {
    directions_.reserve(points.size());
    for (const Eigen::Vector3f& p : points) {
      const float norm = p.norm();
      directions_.push_back(norm > 0 && std::isfinite(norm) ? Eigen::Vector3f(p / norm)
                                                            : Eigen::Vector3f(0, 0, 0));
    }
  }
  std::size_t size() const { return directions_.size(); }
  bool has(std::size_t i) const { return !directions_[i].isZero(); }
  const Eigen::Vector3f& of(std::size_t i) const { return directions_[i]; }
  float between(std::size_t a, std::size_t b) const { return (of(a) - of(b)).norm(); }

 private:
  std::vector<Eigen::Vector3f> directions_;
};

/// Points of a line; 0 if these are no lines of one length.
std::size_t lengthOfLines(const UnitVectors& directions) {
  std::vector<float> steps;
  for (std::size_t i = 1; i < directions.size(); ++i)
    if (directions.has(i - 1) && directions.has(i)) steps.push_back(directions.between(i - 1, i));
  if (steps.size() < kFewest * kFewest) return 0;
  const float jump = kJump * medianOf(steps);
  // Some lines begin or end with a beam that did not return: not every end is seen.
  std::size_t length = 0;
  for (std::size_t i = 1; i < directions.size(); ++i)
    if (directions.has(i - 1) && directions.has(i) && directions.between(i - 1, i) > jump)
      length = std::gcd(length, i);
  if (length < kFewest || directions.size() % length != 0 || directions.size() < kFewest * length)
    return 0;
  for (std::size_t i = 1; i < directions.size(); ++i) {
    if (!directions.has(i - 1) || !directions.has(i)) continue;
    if ((directions.between(i - 1, i) > jump) != (i % length == 0)) return 0;
  }
  return length;
}

/// Whether points of the same place in adjacent lines are about equally far apart, nearer than
/// lines are long.
bool lieSideBySide(const UnitVectors& directions, std::size_t length) {
  std::vector<float> steps;
  std::vector<float> lengths;
  for (std::size_t i = length; i < directions.size(); ++i)
    if (directions.has(i - length) && directions.has(i))
      steps.push_back(directions.between(i - length, i));
  for (std::size_t begin = 0; begin < directions.size(); begin += length)
    if (directions.has(begin) && directions.has(begin + length - 1))
      lengths.push_back(directions.between(begin, begin + length - 1));
  if (steps.empty() || lengths.empty()) return false;
  const float step = medianOf(steps);
  const auto regular = std::count_if(steps.begin(), steps.end(),
                                     [&](float s) { return s > 0.25F * step && s < 4 * step; });
  return step > 0 && 2 * step < medianOf(lengths) &&
         10 * static_cast<std::size_t>(regular) >= 9 * steps.size();
}

/// Whether lines run along azimuths rather than up.
bool runAlongAzimuths(const UnitVectors& directions, std::size_t length) {
  float aside = 0;
  float up = 0;
  for (std::size_t i = 1; i < directions.size(); ++i) {
    if (i % length == 0 || !directions.has(i - 1) || !directions.has(i)) continue;
    const Eigen::Vector3f step = directions.of(i) - directions.of(i - 1);
    up += std::abs(step.z());
    aside += std::hypot(step.x(), step.y());
  }
  return aside > up;
}

}  // namespace

std::optional<RangeImage> findLines(const std::vector<Eigen::Vector3f>& points) {
  const UnitVectors directions(points);
  const std::size_t length = lengthOfLines(directions);
  if (length == 0 || points.size() / length >= RangeImage::kNoRow || length >= RangeImage::kNoRow ||
      !lieSideBySide(directions, length))
    return std::nullopt;
  const bool lines_are_rows = runAlongAzimuths(directions, length);
  RangeImage image;
  image.pixels.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!directions.has(i)) continue;
    const std::size_t line = i / length;
    const std::size_t in_line = i % length;
    image.pixels[i] = {static_cast<std::uint16_t>(lines_are_rows ? line : in_line),
                       static_cast<std::int32_t>(lines_are_rows ? in_line : line)};
  }
  return image;
}

}  // namespace csom::detail
