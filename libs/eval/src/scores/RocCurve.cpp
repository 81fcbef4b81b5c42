// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/RocCurve.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace csom {
namespace {

struct Counts {
  std::size_t occupied = 0;
  std::size_t free = 0;
};

}  // namespace

double RocCurve::auc() const {
  double area = 0;
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const RocPoint& a = points_[i - 1];
    const RocPoint& b = points_[i];
    area += (b.false_positive_rate - a.false_positive_rate) *
            (a.true_positive_rate + b.true_positive_rate) / 2;
  }
  return area;
}

double RocCurve::truePositiveRateAt(double rate) const {
  const auto after = std::upper_bound(
      points_.begin(), points_.end(), rate,
      [](double value, const RocPoint& point) { return value < point.false_positive_rate; });
  if (after == points_.begin()) return 0;
  const RocPoint& a = *std::prev(after);
  if (after == points_.end()) return a.true_positive_rate;
  const double share =
      (rate - a.false_positive_rate) / (after->false_positive_rate - a.false_positive_rate);
  return a.true_positive_rate + share * (after->true_positive_rate - a.true_positive_rate);
}

std::vector<RocPoint> RocCurve::thinned(std::size_t count) const {
  if (points_.size() <= count) return points_;
  // A point for each equal step along the way, which is at most 2 long: dense where it is steep.
  std::vector<RocPoint> kept{points_.front()};
  const double step = 2.0 / static_cast<double>(count - 2);
  const auto way = [](const RocPoint& p) { return p.false_positive_rate + p.true_positive_rate; };
  for (std::size_t i = 1; i + 1 < points_.size(); ++i) {
    if (way(points_[i]) - way(kept.back()) >= step) kept.push_back(points_[i]);
  }
  kept.push_back(points_.back());
  return kept;
}

std::optional<RocCurve> RocSamples::curve(double score_of_unknown) const {
  Counts unknown{unknown_occupied_, unknown_free_};
  std::vector<Sample> samples = known_;
  std::sort(samples.begin(), samples.end(),
            [](const Sample& a, const Sample& b) { return a.score > b.score; });
  Counts all = unknown;
  for (const Sample& sample : samples) ++(sample.occupied ? all.occupied : all.free);
  if (all.occupied == 0 || all.free == 0) return std::nullopt;

  std::vector<RocPoint> points{{0, 0}};
  Counts so_far;
  const auto append = [&] {
    points.push_back({static_cast<double>(so_far.free) / static_cast<double>(all.free),
                      static_cast<double>(so_far.occupied) / static_cast<double>(all.occupied)});
  };
  const auto takeUnknown = [&] {
    if (unknown.occupied + unknown.free == 0) return;
    so_far.occupied += unknown.occupied;
    so_far.free += unknown.free;
    unknown = {};
  };
  for (std::size_t i = 0; i < samples.size();) {
    const double score = samples[i].score;
    if (score < score_of_unknown && unknown.occupied + unknown.free > 0) {
      takeUnknown();
      append();
    }
    if (score == score_of_unknown) takeUnknown();
    for (; i < samples.size() && samples[i].score == score; ++i)
      ++(samples[i].occupied ? so_far.occupied : so_far.free);
    append();
  }
  if (unknown.occupied + unknown.free > 0) {
    takeUnknown();
    append();
  }
  return RocCurve(std::move(points));
}

}  // namespace csom
