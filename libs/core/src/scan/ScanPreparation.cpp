// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/ScanPreparation.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "scan/CellKeys.h"
#include "scan/DownSampling.h"
#include "scan/PointSet.h"
#include "scan/PrepareInto.h"
#include "util/Parallel.h"

namespace csom {

namespace {

using detail::KeyPacking;
using detail::PointSet;

constexpr double kScoreTolerance = 1e-3;
/// Cells from the origin that a scan may reach along an axis: three axes of 21 bits, with a margin
/// of neighbours on both sides, fill a key.
constexpr double kReachCells = (1 << 20) - 4;
/// Steps of free space that one beam may take. A stray point a hundred kilometres away must not
/// cost more than a scan.
constexpr double kMaxFreeSteps = 1 << 13;
/// Free samples of one scan, before down-sampling: some gigabytes.
constexpr double kMaxFreeSamples = 1 << 27;

/// Relative distance from a limit that no rounding bridges.
constexpr double kMargin = 1e-9;

double squareOf(double v) {
  return v * v;
}

void checkImage(const Scan& scan) {
  const RangeImage& image = scan.image;
  if (image.pixels.size() != scan.points.size())
    throw std::invalid_argument("scan of " + std::to_string(scan.points.size()) +
                                " points has an image of " + std::to_string(image.pixels.size()));
  if (image.column_step < 1 || image.columns_of_turn < 0)
    throw std::invalid_argument("image of a scan: column_step is " +
                                std::to_string(image.column_step) + " and columns_of_turn " +
                                std::to_string(image.columns_of_turn) +
                                "; they are at least 1 and at least 0");
  if (image.columns_of_turn == 0) return;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const RangeImage::Pixel& pixel = image.pixels[i];
    if (pixel.row != RangeImage::kNoRow &&
        (pixel.column < 0 || pixel.column >= image.columns_of_turn))
      throw std::invalid_argument("image of a scan: point " + std::to_string(i) + " has column " +
                                  std::to_string(pixel.column) + "; a turn has columns 0 to " +
                                  std::to_string(image.columns_of_turn - 1));
  }
}

void checkSizes(const Scan& scan, int classes) {
  const auto fail = [&](const char* what, std::size_t size, std::size_t expected) {
    throw std::invalid_argument("scan of " + std::to_string(scan.points.size()) + " points has " +
                                std::to_string(size) + " " + what + " instead of " +
                                std::to_string(expected));
  };
  if (scan.points.size() >= std::numeric_limits<std::uint32_t>::max())
    throw std::invalid_argument("a scan may hold at most 2^32-2 points");
  if (!scan.image.empty()) checkImage(scan);
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
  Preparation(const Scan& scan, const Options& options, ScanReport& report, PreparedScan& out)
      : scan_(scan),
        options_(options),
        report_(report),
        grid_(options.resolution),
        origin_is_finite_(scan.origin.allFinite()),
        origin_is_inside_(grid_.contains(scan.origin)),
        reach_(scanReach(options)),
        longest_beam_(longestBeam()),
        nearest_squared_(options.scan.min_range * options.scan.min_range * (1 + kMargin)),
        farthest_squared_(squareOf(options.scan.max_range > 0
                                       ? std::min(options.scan.max_range, longest_beam_)
                                       : longest_beam_) *
                          (1 - kMargin)),
        plain_reach_(plainReach()),
        out_(out) {}

  void run() {
    clear();
    out_.layout =
        BlockLayout(detail::entryOf(options_.method).block_is_voxel ? 1 : options_.block_depth);
    out_.origin = scan_.origin;
    report_.points += scan_.points.size();
    if (usesImage()) {
      takeImage();
      return;
    }
    PointSet accepted;
    accept(accepted);
    if (options_.castsRays()) recordHits(accepted);
    PointSet hits = detail::downSample(std::move(accepted), scan_.origin, options_);
    report_.training_points += hits.points.size();
    if (!hits.points.empty()) {
      if (options_.castsRays()) recordBeams(hits);
      if (options_.free_space.mode == FreeSpace::Sampled)
        appendFreePoints(hits, detail::downSample(sampleFreeSpace(hits), scan_.origin, options_));
      bin(hits);
    }
  }

 private:
  bool usesImage() const { return !scan_.image.empty() && options_.usesImages(); }

  void clear() {
    out_.points.clear();
    out_.scores.clear();
    out_.blocks.clear();
    out_.block_begin.clear();
    out_.beam_ends.clear();
    out_.hit_voxels.clear();
    out_.image_points.image = {std::move(out_.image_points.image.pixels), 1, 0};
    out_.image_points.image.pixels.clear();
    out_.image_points.points.clear();
    out_.image_points.labels.clear();
    out_.image_points.scores.clear();
  }

  void takeImage() {
    ImagePoints& to = out_.image_points;
    PointSet accepted{std::move(to.points), std::move(to.labels), std::move(to.scores),
                      std::move(to.image.pixels)};
    accept(accepted);
    report_.training_points += accepted.points.size();
    if (options_.free_space.mode == FreeSpace::Raycast) {
      recordHits(accepted);
      recordBeams(accepted);
    }
    to.image = {std::move(accepted.pixels), scan_.image.column_step, scan_.image.columns_of_turn};
    to.points = std::move(accepted.points);
    to.labels = std::move(accepted.labels);
    to.scores = std::move(accepted.scores);
  }

  Eigen::Vector3d inMap(const Eigen::Vector3f& point) const {
    return scan_.origin + point.cast<double>();
  }

  std::optional<RejectReason> reasonToReject(std::size_t i) const {
    const Eigen::Vector3d p = scan_.points[i].cast<double>();
    if (!p.allFinite() || !origin_is_finite_) return RejectReason::NonFinite;
    const double range = p.norm();
    if (range < options_.scan.min_range) return RejectReason::TooNear;
    if (options_.scan.max_range > 0 && range > options_.scan.max_range) return RejectReason::TooFar;
    if (p.cwiseAbs().maxCoeff() >= reach_ || !origin_is_inside_ ||
        !grid_.contains(scan_.origin + p))
      return RejectReason::OutsideIndexRange;
    if (range > longest_beam_) return RejectReason::BeamTooLong;
    if (!scan_.isSoft()) {
      if (scan_.labels[i] >= options_.number_of_classes) return RejectReason::ClassOutOfRange;
    } else if (!validScores(rowOf(scan_.scores, i), options_.number_of_classes)) {
      return RejectReason::InvalidScores;
    }
    return std::nullopt;
  }

  /// Whether a point is so far from every limit that reasonToReject() need not be called: nearly
  /// all are, and this costs no square root.
  bool isFarFromLimits(const Eigen::Vector3f& point) const {
    const Eigen::Vector3d p = point.cast<double>();
    const double squared = p.squaredNorm();
    return squared > nearest_squared_ && squared < farthest_squared_ &&
           p.cwiseAbs().maxCoeff() < plain_reach_;
  }
  bool isPlain(std::size_t i) const {
    return !scan_.isSoft() && scan_.labels[i] < options_.number_of_classes &&
           isFarFromLimits(scan_.points[i]);
  }

  /// How far a point may be from the origin along an axis and surely lie in the grid; 0 if none
  /// may.
  double plainReach() const {
    if (!origin_is_finite_ || !origin_is_inside_) return 0;
    const double to_border =
        grid_.resolution() * (kMaxVoxelIndex - 1) - scan_.origin.cwiseAbs().maxCoeff();
    return std::min(reach_, std::max(0.0, to_border));
  }

  double longestBeam() const {
    switch (options_.free_space.mode) {
      case FreeSpace::Sampled:
        return kMaxFreeSteps * options_.free_space.resolution;
      case FreeSpace::Raycast:
      case FreeSpace::Projective:
        return kMaxFreeSteps * options_.resolution;
      case FreeSpace::None:
        break;
    }
    return std::numeric_limits<double>::infinity();
  }

  /// Into `accepted`, whose memory is used again.
  void accept(PointSet& accepted) {
    constexpr std::uint8_t kAccepted = kRejectReasons;
    std::vector<std::uint8_t> reasons(scan_.points.size());
    std::atomic<std::size_t> rejected{0};
    detail::parallelRanges(reasons.size(), options_.threads,
                           [&](std::size_t begin, std::size_t end) {
                             std::size_t rejected_here = 0;
                             for (std::size_t i = begin; i < end; ++i) {
                               const auto reason = isPlain(i) ? std::nullopt : reasonToReject(i);
                               reasons[i] = reason ? static_cast<std::uint8_t>(*reason) : kAccepted;
                               rejected_here += reason ? 1 : 0;
                             }
                             rejected += rejected_here;
                           });
    accepted.points = scan_.points;
    accepted.labels = scan_.labels;
    accepted.scores = scan_.scores;
    accepted.pixels.clear();
    if (usesImage()) accepted.pixels = scan_.image.pixels;
    if (rejected > 0) {
      const auto classes = static_cast<std::size_t>(options_.number_of_classes);
      std::size_t kept = 0;
      for (std::size_t i = 0; i < reasons.size(); ++i) {
        if (reasons[i] != kAccepted) {
          ++report_.rejected[reasons[i]];
          continue;
        }
        accepted.points[kept] = accepted.points[i];
        if (!accepted.pixels.empty()) accepted.pixels[kept] = accepted.pixels[i];
        if (!scan_.isSoft()) {
          accepted.labels[kept] = accepted.labels[i];
        } else if (kept < i) {
          std::copy_n(rowOf(accepted.scores, i), classes,
                      accepted.scores.begin() + static_cast<std::ptrdiff_t>(kept * classes));
        }
        ++kept;
      }
      accepted.points.resize(kept);
      if (!accepted.pixels.empty()) accepted.pixels.resize(kept);
      if (scan_.isSoft()) {
        accepted.scores.resize(kept * classes);
      } else {
        accepted.labels.resize(kept);
      }
    }
  }

  void recordHits(const PointSet& accepted) {
    out_.hit_voxels.resize(accepted.points.size());
    detail::parallelRanges(accepted.points.size(), options_.threads,
                           [&](std::size_t begin, std::size_t end) {
                             for (std::size_t i = begin; i < end; ++i)
                               out_.hit_voxels[i] = grid_.voxelAt(inMap(accepted.points[i]));
                           });
  }

  /// Points of class 0 every free_resolution along each beam, the last one that far before the hit.
  PointSet sampleFreeSpace(const PointSet& hits) const {
    double samples = 0;
    for (const Eigen::Vector3f& hit : hits.points)
      samples += static_cast<double>(hit.norm()) / options_.free_space.resolution;
    if (samples > kMaxFreeSamples)
      throw std::invalid_argument("the beams of this scan have " + toString(samples) +
                                  " free samples; raise free_resolution or lower max_range");
    // Where the samples of each hit begin, for threads to write side by side.
    std::vector<std::size_t> first(hits.points.size() + 1);
    for (std::size_t i = 0; i < hits.points.size(); ++i)
      first[i + 1] = first[i] + freeSteps(hits.points[i].cast<double>().norm());
    PointSet out;
    out.points.resize(first.back());
    detail::parallelRanges(
        hits.points.size(), options_.threads, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            const Eigen::Vector3d p = hits.points[i].cast<double>();
            const double range = p.norm();
            for (std::size_t n = first[i]; n < first[i + 1]; ++n) {
              const auto step = static_cast<double>(n - first[i] + 1);
              out.points[n] =
                  (p * ((range - step * options_.free_space.resolution) / range)).cast<float>();
            }
          }
        });
    return out;
  }

  /// Samples of a beam: steps that end before the sensor.
  std::size_t freeSteps(double range) const {
    // The quotient is rounded; what counts is the difference that a sample lies at.
    auto steps = static_cast<std::size_t>(range / options_.free_space.resolution);
    const auto isBeforeSensor = [&](std::size_t step) {
      return range - static_cast<double>(step) * options_.free_space.resolution > 0;
    };
    while (isBeforeSensor(steps + 1)) ++steps;
    while (steps > 0 && !isBeforeSensor(steps)) --steps;
    return steps;
  }

  void appendFreePoints(PointSet& hits, PointSet free_points) {
    report_.free_points += free_points.points.size();
    if (scan_.isSoft()) {
      const auto classes = static_cast<std::size_t>(options_.number_of_classes);
      free_points.scores.resize(free_points.points.size() * classes);
      for (std::size_t i = 0; i < free_points.points.size(); ++i)
        free_points.scores[i * classes + kFreeClass] = 1.0F;
    } else {
      free_points.labels.resize(free_points.points.size(), kFreeClass);
    }
    hits.append(free_points);
  }

  void recordBeams(const PointSet& hits) {
    out_.beam_ends.reserve(hits.points.size());
    for (const Eigen::Vector3f& hit : hits.points) out_.beam_ends.push_back(inMap(hit));
  }

  void bin(const PointSet& in) {
    const detail::CellGrid blocks{scan_.origin, options_.resolution, out_.layout.sideBits()};
    const KeyPacking packing = detail::makePacking(blocks, in.points);
    detail::withKeyOf(packing, [&](auto key) {
      bin(in, packing,
          detail::sortedByCell<decltype(key)>(blocks, packing, in.points, options_.threads));
    });
    report_.blocks_observed += out_.blocks.size();
  }

  template <class Key>
  void bin(const PointSet& in, const KeyPacking& packing,
           const std::vector<detail::KeyedItem<Key>>& sorted) {
    detail::forEachRun(sorted, [&](std::size_t begin, std::size_t) {
      const KeyPacking::Position b = packing.unpack(sorted[begin].key);
      out_.blocks.push_back({static_cast<std::int32_t>(b[0]), static_cast<std::int32_t>(b[1]),
                             static_cast<std::int32_t>(b[2])});
      out_.block_begin.push_back(static_cast<std::uint32_t>(begin));
    });
    out_.block_begin.push_back(static_cast<std::uint32_t>(sorted.size()));
    out_.points.resize(sorted.size());
    out_.scores.resize(in.scores.size());
    detail::parallelRanges(
        out_.blocks.size(), options_.threads, [&](std::size_t begin, std::size_t end) {
          for (std::size_t b = begin; b < end; ++b)
            for (std::uint32_t i = out_.block_begin[b]; i < out_.block_begin[b + 1]; ++i)
              placePoint(in, sorted[i].item, out_.blocks[b], i);
        });
  }

  /// Makes point `from` of the set the training point `to` of a block.
  void placePoint(const PointSet& in, std::size_t from, const BlockIndex& block, std::size_t to) {
    const Eigen::Vector3d voxels = inMap(in.points[from]) / options_.resolution;
    out_.points[to] = {fromCorner(voxels.x(), block.x), fromCorner(voxels.y(), block.y),
                       fromCorner(voxels.z(), block.z),
                       in.labels.empty() ? kFreeClass : in.labels[from]};
    if (in.scores.empty()) return;
    const auto classes = static_cast<std::size_t>(options_.number_of_classes);
    std::copy_n(rowOf(in.scores, from), classes,
                out_.scores.begin() + static_cast<std::ptrdiff_t>(to * classes));
  }

  /// See TrainingPoint.
  float fromCorner(double voxels, std::int32_t block) const {
    constexpr double kQuanta = 1 << 17;
    const double corner = static_cast<double>(block) * out_.layout.side();
    return static_cast<float>(std::floor((voxels - corner) * kQuanta + 0.5) / kQuanta);
  }

  const float* rowOf(const std::vector<float>& scores, std::size_t row) const {
    return scores.data() + row * static_cast<std::size_t>(options_.number_of_classes);
  }

  const Scan& scan_;
  const Options& options_;
  ScanReport& report_;
  Grid grid_;
  bool origin_is_finite_;
  bool origin_is_inside_;
  double reach_;         ///< of a scan along each axis [m]; see kReachCells
  double longest_beam_;  ///< [m]
  // Of isFarFromLimits().
  double nearest_squared_;
  double farthest_squared_;
  double plain_reach_;
  PreparedScan& out_;
};

}  // namespace

double scanReach(const Options& options) {
  const bool down_sampled = options.scan.ds_resolution > 0;
  return kReachCells * (down_sampled ? std::min(options.scan.ds_resolution, options.resolution)
                                     : options.resolution);
}

PreparedScan prepareScan(const Scan& scan, const Options& options, ScanReport& report) {
  PreparedScan out;
  detail::prepareScan(scan, options, report, out);
  return out;
}

void detail::prepareScan(const Scan& scan, const Options& options, ScanReport& report,
                         PreparedScan& out) {
  checkSizes(scan, options.number_of_classes);
  Preparation(scan, options, report, out).run();
}

}  // namespace csom
