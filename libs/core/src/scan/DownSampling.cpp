// SPDX-License-Identifier: BSD-3-Clause
#include "scan/DownSampling.h"

#include <utility>

#include "scan/CellKeys.h"

namespace csom::detail {

namespace {

/// Makes one point of each run of points of a cell.
template <class Key>
class CellMerger {
 public:
  CellMerger(const PointSet& in, const std::vector<KeyedItem<Key>>& sorted, int classes)
      : in_(in), sorted_(sorted), votes_(static_cast<std::size_t>(classes)) {}

  /// The cells that begin in [first, last).
  PointSet merge(std::size_t first, std::size_t last) {
    PointSet out;
    out.points.reserve(last - first);
    if (!in_.labels.empty()) out.labels.reserve(last - first);
    forEachRun(sorted_, first, last, [&](std::size_t begin, std::size_t end) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::size_t i = begin; i < end; ++i)
        sum += in_.points[sorted_[i].item].template cast<double>();
      out.points.push_back((sum / static_cast<double>(end - begin)).template cast<float>());
      if (!in_.labels.empty()) out.labels.push_back(majority(begin, end));
      if (!in_.scores.empty()) appendMeanScores(out.scores, begin, end);
    });
    return out;
  }

 private:
  ClassId majority(std::size_t begin, std::size_t end) {
    ClassId best = in_.labels[sorted_[begin].item];
    std::size_t i = begin + 1;
    while (i < end && in_.labels[sorted_[i].item] == best) ++i;
    if (i == end) return best;
    for (i = begin; i < end; ++i) {
      const ClassId label = in_.labels[sorted_[i].item];
      ++votes_[label];
      if (votes_[label] > votes_[best] || (votes_[label] == votes_[best] && label < best))
        best = label;
    }
    for (i = begin; i < end; ++i) votes_[in_.labels[sorted_[i].item]] = 0;
    return best;
  }

  void appendMeanScores(std::vector<float>& out, std::size_t begin, std::size_t end) const {
    const std::size_t classes = votes_.size();
    for (std::size_t k = 0; k < classes; ++k) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += in_.scores[sorted_[i].item * classes + k];
      out.push_back(static_cast<float>(sum / static_cast<double>(end - begin)));
    }
  }

  const PointSet& in_;
  const std::vector<KeyedItem<Key>>& sorted_;
  std::vector<std::uint32_t> votes_;
};

}  // namespace

PointSet downSample(PointSet in, const Eigen::Vector3d& origin, const Options& options) {
  if (options.scan.ds_resolution <= 0 || in.points.empty()) return in;
  const CellGrid cells{origin, options.scan.ds_resolution, 0};
  const KeyPacking packing = makePacking(cells, in.points);
  return withKeyOf(packing, [&](auto key) {
    using Key = decltype(key);
    const auto sorted = sortedByCell<Key>(cells, packing, in.points, options.threads);
    const std::size_t count = partsFor(sorted.size(), options.threads);
    std::vector<PointSet> parts(count);
    parallelRanges(count, options.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t part = begin; part < end; ++part)
        parts[part] = CellMerger<Key>(in, sorted, options.number_of_classes)
                          .merge(partBegin(sorted.size(), part, count),
                                 partBegin(sorted.size(), part + 1, count));
    });
    PointSet out = std::move(parts.front());
    for (std::size_t part = 1; part < count; ++part) out.append(parts[part]);
    return out;
  });
}

}  // namespace csom::detail
