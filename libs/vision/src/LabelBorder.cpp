// SPDX-License-Identifier: BSD-3-Clause
// Fits lines to the staircases that borders between labels are.
#include "LabelBorder.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace csom::detail {
namespace {

/// A border next to a pixel: that of its class with the class of the next pixel in one direction
/// ("outwards"). Places are counted along the border from the pixel, and outwards from it.
class Border {
 public:
  Border(const cv::Mat& classes, int x, int y, bool along_x, int outwards)
      : classes_(classes),
        x_(x),
        y_(y),
        along_x_(along_x),
        outwards_(outwards),
        inside_(at(0, 0)),
        outside_(at(0, 1)) {}

  bool exists() const { return outside_ != kBeyondImage && outside_ != inside_; }

  /// Where the line through its steps is `along` from the pixel.
  double outwardsAt(double along) const;

 private:
  static constexpr int kBeyondImage = -1;
  /// Steps on each side, and the fewest of both that make a line.
  static constexpr int kReach = 4;
  static constexpr int kFewest = 3;
  /// A border that turns more than this from step to step runs rather along the other axis.
  static constexpr int kSteepest = 2;

  int at(int along, int out) const {
    const int x = x_ + (along_x_ ? along : outwards_ * out);
    const int y = y_ + (along_x_ ? outwards_ * out : along);
    if (x < 0 || y < 0 || x >= classes_.cols || y >= classes_.rows) return kBeyondImage;
    return classes_.at<std::uint16_t>(y, x);
  }

  /// The last pixel inside, going outwards at `along`, near to where it was one step before.
  std::optional<int> lastInside(int along, int before) const {
    int last = before + kSteepest;
    while (last >= before - kSteepest && at(along, last) != inside_) --last;
    if (last < before - kSteepest || at(along, last + 1) != outside_) return std::nullopt;
    return last;
  }

  const cv::Mat& classes_;
  int x_;
  int y_;
  bool along_x_;
  int outwards_;
  int inside_;
  int outside_;
};

double Border::outwardsAt(double along) const {
  double count = 1;
  double sum_a = 0;
  double sum_aa = 0;
  double sum_o = 0;
  double sum_ao = 0;
  for (const int side : {-1, 1}) {
    int before = 0;
    for (int a = side; std::abs(a) <= kReach; a += side) {
      const auto last = lastInside(a, before);
      if (!last) break;
      before = *last;
      count += 1;
      sum_a += a;
      sum_aa += a * a;
      sum_o += before;
      sum_ao += a * before;
    }
  }
  constexpr double kHalfPixel = 0.5;
  if (count < kFewest) return kHalfPixel;
  const double slope = (count * sum_ao - sum_a * sum_o) / (count * sum_aa - sum_a * sum_a);
  return (sum_o - slope * sum_a) / count + slope * along + kHalfPixel;
}

}  // namespace

float distanceToBorder(const cv::Mat& classes, const Eigen::Vector2f& pixel) {
  const int x = std::clamp(static_cast<int>(std::floor(pixel.x() + 0.5F)), 0, classes.cols - 1);
  const int y = std::clamp(static_cast<int>(std::floor(pixel.y() + 0.5F)), 0, classes.rows - 1);
  const double from_x = pixel.x() - static_cast<float>(x);
  const double from_y = pixel.y() - static_cast<float>(y);
  double nearest = std::numeric_limits<double>::infinity();
  for (const bool along_x : {true, false}) {
    for (const int outwards : {-1, 1}) {
      const Border border(classes, x, y, along_x, outwards);
      if (!border.exists()) continue;
      const double along = along_x ? from_x : from_y;
      const double across = along_x ? from_y : from_x;
      nearest = std::min(nearest, border.outwardsAt(along) - outwards * across);
    }
  }
  return static_cast<float>(nearest);
}

}  // namespace csom::detail
