// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/ScanPreparation.h>

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "SortedKeys.h"

namespace csom {

namespace {

using detail::KeyedItem;
using detail::KeyPacking;

constexpr double kScoreTolerance = 1e-3;
/// Cells from the origin that a scan may reach along an axis: three axes of 21 bits, with a margin
/// of neighbours on both sides, fill a key.
constexpr double kReachCells = (1 << 20) - 4;
/// Steps of free space that one beam may take. A stray point a hundred kilometres away must not
/// cost more than a scan.
constexpr double kMostFreeSteps = 1 << 13;
/// Free samples of one scan, before down-sampling: some gigabytes.
constexpr double kMostFreeSamples = 1 << 27;

/// Labelled points on their way through the stages, relative to the scan's origin.
struct PointSet {
  std::vector<Eigen::Vector3f> points;
  std::vector<ClassId> labels;
  std::vector<float> scores;

  void reserve(std::size_t size) {
    points.reserve(size);
    labels.reserve(size);
  }
};

void checkSizes(const Scan& scan, int classes) {
  const auto fail = [&](const char* what, std::size_t size, std::size_t expected) {
    throw std::invalid_argument("scan of " + std::to_string(scan.points.size()) + " points has " +
                                std::to_string(size) + " " + what + " instead of " +
                                std::to_string(expected));
  };
  if (scan.points.size() >= std::numeric_limits<std::uint32_t>::max())
    throw std::invalid_argument("a scan may hold at most 2^32-2 points");
  if (scan.isSoft()) {
    const std::size_t expected = scan.points.size() * static_cast<std::size_t>(classes);
    if (scan.scores.size() != expected) fail("scores", scan.scores.size(), expected);
    if (!scan.labels.empty()) fail("labels beside its scores", scan.labels.size(), 0);
  } else if (scan.labels.size() != scan.points.size()) {
    fail("labels", scan.labels.size(), scan.points.size());
  }
}

bool validScores(const float* scores, int classes) {
  double sum = 0;
  for (int k = 0; k < classes; ++k) {
    if (!(scores[k] >= 0)) return false;
    sum += scores[k];
  }
  return std::abs(sum - 1) <= kScoreTolerance;
}

class Preparation {
 public:
  Preparation(const Scan& scan, const Options& options, ScanReport& report)
      : scan_(scan), options_(options), report_(report), grid_(options.resolution) {}

  PreparedScan run() {
    out_.block_depth = options_.method == Method::SCsm ? 1 : options_.block_depth;
    out_.origin = scan_.origin;
    report_.points += scan_.points.size();
    PointSet hits = downSample(accept());
    report_.training_points += hits.points.size();
    if (!hits.points.empty()) {
      if (options_.free_space == FreeSpace::Raycast) recordBeams(hits);
      if (options_.free_space == FreeSpace::Sampled)
        append(hits, downSample(sampleFreeSpace(hits)));
      bin(hits);
    }
    return std::move(out_);
  }

 private:
  Eigen::Vector3d inMap(const Eigen::Vector3f& point) const {
    return scan_.origin + point.cast<double>();
  }

  std::optional<RejectReason> reasonToReject(std::size_t i) const {
    const Eigen::Vector3d p = scan_.points[i].cast<double>();
    if (!p.allFinite() || !scan_.origin.allFinite()) return RejectReason::NonFinite;
    const double range = p.norm();
    if (range < options_.min_range) return RejectReason::TooNear;
    if (options_.max_range > 0 && range > options_.max_range) return RejectReason::TooFar;
    const double cell = options_.ds_resolution > 0
                            ? std::min(options_.ds_resolution, options_.resolution)
                            : options_.resolution;
    if (p.cwiseAbs().maxCoeff() >= kReachCells * cell || !grid_.contains(scan_.origin) ||
        !grid_.contains(scan_.origin + p))
      return RejectReason::OutsideIndexRange;
    if (range > longestBeam()) return RejectReason::BeamTooLong;
    if (!scan_.isSoft()) {
      if (scan_.labels[i] >= options_.number_of_classes) return RejectReason::ClassOutOfRange;
    } else if (!validScores(rowOf(scan_.scores, i), options_.number_of_classes)) {
      return RejectReason::InvalidScores;
    }
    return std::nullopt;
  }

  double longestBeam() const {
    switch (options_.free_space) {
      case FreeSpace::Sampled:
        return kMostFreeSteps * options_.free_resolution;
      case FreeSpace::Raycast:
        return kMostFreeSteps * options_.resolution;
      case FreeSpace::None:
        break;
    }
    return std::numeric_limits<double>::infinity();
  }

  PointSet accept() {
    PointSet accepted;
    accepted.reserve(scan_.points.size());
    for (std::size_t i = 0; i < scan_.points.size(); ++i) {
      if (const auto reason = reasonToReject(i)) {
        ++report_.rejected[static_cast<std::size_t>(*reason)];
        continue;
      }
      accepted.points.push_back(scan_.points[i]);
      accepted.labels.push_back(scan_.isSoft() ? kFreeClass : scan_.labels[i]);
      if (scan_.isSoft()) appendScores(accepted.scores, rowOf(scan_.scores, i));
      if (options_.free_space == FreeSpace::Raycast)
        out_.hit_voxels.push_back(grid_.voxelAt(inMap(scan_.points[i])));
    }
    return accepted;
  }

  /// One point a cell, at the centroid, with the majority class (ties: the lower id) or mean
  /// scores.
  PointSet downSample(PointSet in) const {
    if (options_.ds_resolution <= 0 || in.points.empty()) return in;
    const double cell = options_.ds_resolution;
    std::vector<KeyPacking::Position> cells(in.points.size());
    KeyPacking packing;
    for (std::size_t i = 0; i < in.points.size(); ++i) {
      const Eigen::Vector3d p = inMap(in.points[i]);
      for (std::size_t a = 0; a < 3; ++a)
        cells[i][a] = static_cast<std::int64_t>(std::floor(p[static_cast<Eigen::Index>(a)] / cell));
      packing.include(cells[i]);
    }
    packing.finish();
    std::vector<KeyedItem> sorted(in.points.size());
    for (std::size_t i = 0; i < sorted.size(); ++i)
      sorted[i] = {packing.pack(cells[i]), static_cast<std::uint32_t>(i)};
    detail::stableSort(sorted, packing.bits());

    PointSet out;
    out.reserve(in.points.size());
    std::vector<std::uint32_t> votes(static_cast<std::size_t>(options_.number_of_classes));
    detail::forEachRun(sorted, [&](std::size_t begin, std::size_t end) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::size_t i = begin; i < end; ++i) sum += in.points[sorted[i].item].cast<double>();
      out.points.push_back((sum / static_cast<double>(end - begin)).cast<float>());
      if (in.scores.empty()) {
        out.labels.push_back(majority(in.labels, sorted, begin, end, votes));
      } else {
        out.labels.push_back(kFreeClass);
        appendMeanScores(out.scores, in.scores, sorted, begin, end);
      }
    });
    return out;
  }

  static ClassId majority(const std::vector<ClassId>& labels, const std::vector<KeyedItem>& sorted,
                          std::size_t begin, std::size_t end, std::vector<std::uint32_t>& votes) {
    ClassId best = labels[sorted[begin].item];
    for (std::size_t i = begin; i < end; ++i) {
      const ClassId label = labels[sorted[i].item];
      ++votes[label];
      if (votes[label] > votes[best] || (votes[label] == votes[best] && label < best)) best = label;
    }
    for (std::size_t i = begin; i < end; ++i) votes[labels[sorted[i].item]] = 0;
    return best;
  }

  void appendMeanScores(std::vector<float>& out, const std::vector<float>& scores,
                        const std::vector<KeyedItem>& sorted, std::size_t begin,
                        std::size_t end) const {
    for (int k = 0; k < options_.number_of_classes; ++k) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += rowOf(scores, sorted[i].item)[k];
      out.push_back(static_cast<float>(sum / static_cast<double>(end - begin)));
    }
  }

  /// Points of class 0 every free_resolution along each beam, the last one that far before the hit.
  PointSet sampleFreeSpace(const PointSet& hits) const {
    double samples = 0;
    for (const Eigen::Vector3f& hit : hits.points)
      samples += static_cast<double>(hit.norm()) / options_.free_resolution;
    if (samples > kMostFreeSamples)
      throw std::invalid_argument("the beams of this scan have " + toString(samples) +
                                  " free samples; raise free_resolution or lower max_range");
    PointSet out;
    for (const Eigen::Vector3f& hit : hits.points) {
      const Eigen::Vector3d p = hit.cast<double>();
      const double range = p.norm();
      for (double step = 1; range - step * options_.free_resolution > 0; ++step) {
        out.points.push_back(
            (p * ((range - step * options_.free_resolution) / range)).cast<float>());
        out.labels.push_back(kFreeClass);
        if (scan_.isSoft()) {
          out.scores.push_back(1.0F);
          out.scores.resize(
              out.scores.size() + static_cast<std::size_t>(options_.number_of_classes) - 1, 0.0F);
        }
      }
    }
    return out;
  }

  void append(PointSet& hits, const PointSet& free_points) {
    report_.free_points += free_points.points.size();
    hits.points.insert(hits.points.end(), free_points.points.begin(), free_points.points.end());
    hits.labels.insert(hits.labels.end(), free_points.labels.begin(), free_points.labels.end());
    hits.scores.insert(hits.scores.end(), free_points.scores.begin(), free_points.scores.end());
  }

  void recordBeams(const PointSet& hits) {
    out_.beam_ends.reserve(hits.points.size());
    for (const Eigen::Vector3f& hit : hits.points) out_.beam_ends.push_back(inMap(hit));
  }

  void bin(const PointSet& in) {
    std::vector<KeyPacking::Position> blocks(in.points.size());
    KeyPacking packing;
    for (std::size_t i = 0; i < in.points.size(); ++i) {
      const BlockIndex b = blockOf(grid_.voxelAt(inMap(in.points[i])), out_.block_depth);
      blocks[i] = {b.x, b.y, b.z};
      packing.include(blocks[i]);
    }
    packing.finish();
    std::vector<KeyedItem> sorted(in.points.size());
    for (std::size_t i = 0; i < sorted.size(); ++i)
      sorted[i] = {packing.pack(blocks[i]), static_cast<std::uint32_t>(i)};
    detail::stableSort(sorted, packing.bits());

    out_.points.reserve(sorted.size());
    out_.scores.reserve(in.scores.size());
    for (const KeyedItem& entry : sorted) {
      const Eigen::Vector3d voxels = inMap(in.points[entry.item]) / options_.resolution;
      const KeyPacking::Position& b = blocks[entry.item];
      out_.points.push_back({fromCorner(voxels.x(), b[0]), fromCorner(voxels.y(), b[1]),
                             fromCorner(voxels.z(), b[2]), in.labels[entry.item]});
      if (!in.scores.empty()) appendScores(out_.scores, rowOf(in.scores, entry.item));
    }
    detail::forEachRun(sorted, [&](std::size_t begin, std::size_t) {
      const KeyPacking::Position b = blocks[sorted[begin].item];
      out_.blocks.push_back({static_cast<std::int32_t>(b[0]), static_cast<std::int32_t>(b[1]),
                             static_cast<std::int32_t>(b[2])});
      out_.block_begin.push_back(static_cast<std::uint32_t>(begin));
    });
    out_.block_begin.push_back(static_cast<std::uint32_t>(sorted.size()));
    report_.blocks_observed += out_.blocks.size();
  }

  /// See TrainingPoint.
  float fromCorner(double voxels, std::int64_t block) const {
    constexpr double kQuanta = 1 << 17;
    const double corner = std::ldexp(static_cast<double>(block), out_.block_depth - 1);
    return static_cast<float>(std::floor((voxels - corner) * kQuanta + 0.5) / kQuanta);
  }

  const float* rowOf(const std::vector<float>& scores, std::size_t row) const {
    return scores.data() + row * static_cast<std::size_t>(options_.number_of_classes);
  }
  void appendScores(std::vector<float>& out, const float* row) const {
    out.insert(out.end(), row, row + options_.number_of_classes);
  }

  const Scan& scan_;
  const Options& options_;
  ScanReport& report_;
  Grid grid_;
  PreparedScan out_;
};

}  // namespace

PreparedScan prepareScan(const Scan& scan, const Options& options, ScanReport& report) {
  checkSizes(scan, options.number_of_classes);
  return Preparation(scan, options, report).run();
}

}  // namespace csom
