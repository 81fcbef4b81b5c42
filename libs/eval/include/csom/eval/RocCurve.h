// SPDX-License-Identifier: BSD-3-Clause
// How well a score tells occupied from free, whatever the threshold.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace csom {

/// What share of the free (FPR) and of the occupied (TPR) has at least some score.
struct RocPoint {
  double false_positive_rate = 0;
  double true_positive_rate = 0;
};

class RocCurve {
 public:
  /// From (0, 0) to (1, 1); a point for every score that occurs, so that equal scores make a
  /// straight line. Needs samples of both kinds.
  explicit RocCurve(std::vector<RocPoint> points) : points_(std::move(points)) {}

  const std::vector<RocPoint>& points() const { return points_; }
  /// Area under the curve.
  double auc() const;
  /// On the curve, linear between its points; the highest where it rises vertically.
  double truePositiveRateAt(double false_positive_rate) const;
  /// At most `count` of its points (at least 3), evenly along the curve, for plots.
  std::vector<RocPoint> thinned(std::size_t count) const;

 private:
  std::vector<RocPoint> points_;
};

/// Collects scores of free and occupied voxels, those that a map does not know apart.
class RocSamples {
 public:
  void add(double score, bool occupied) { known_.push_back({score, occupied}); }
  void addUnknown(bool occupied) { ++(occupied ? unknown_occupied_ : unknown_free_); }

  /// With this score for all that the map does not know. Nothing if all samples are of one kind.
  std::optional<RocCurve> curve(double score_of_unknown) const;

 private:
  struct Sample {
    double score;
    bool occupied;
  };
  std::vector<Sample> known_;
  std::size_t unknown_occupied_ = 0;
  std::size_t unknown_free_ = 0;
};

}  // namespace csom
