// SPDX-License-Identifier: BSD-3-Clause
// What the beams of a street tell of its voxels, which ones they cross among them.
#include <csom/core/SemanticMap.h>
#include <csom/protocols/StreetProtocol.h>

#include <array>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <tuple>
#include <vector>

namespace csom {
namespace {

constexpr double kFirstSample = 1.5;  // [m]
constexpr double kSampleStep = 0.8;   // of a voxel's edge
constexpr int kSamplesOfFree = 2;

/// The voxels in which points or samples of beams lie.
class BeamVoxels {
 public:
  explicit BeamVoxels(const Grid& grid) : grid_(grid) {}

  void addPoint(const Eigen::Vector3d& point) { at(point) = kHit; }

  void addBeam(const Eigen::Vector3d& origin, const Eigen::Vector3d& point) {
    const double distance = (point - origin).norm();
    const Eigen::Vector3d direction = (point - origin) / distance;
    const double edge = grid_.resolution();
    for (int i = 0;; ++i) {
      const double at_range = kFirstSample + i * kSampleStep * edge;
      if (at_range >= kJudgedRange || distance <= at_range + edge) return;
      std::uint8_t& samples = at(origin + at_range * direction);
      if (samples < kSamplesOfFree) ++samples;
    }
  }

  /// The centres of the voxels that beams cross and no point lies in, as points of class free.
  Scan freeVoxels() const {
    Scan scan;
    for (const auto& [place, samples] : chunks_)
      for (int i = 0; i < kVoxelsPerChunk; ++i) {
        if (samples[static_cast<std::size_t>(i)] != kSamplesOfFree) continue;
        const auto [x, y, z] = place;
        scan.points.push_back(grid_.center(voxelOfChunk({x, y, z}, i)).cast<float>());
        scan.labels.push_back(kFreeClass);
      }
    return scan;
  }

 private:
  using Samples = std::array<std::uint8_t, kVoxelsPerChunk>;
  using Place = std::tuple<std::int32_t, std::int32_t, std::int32_t>;
  static constexpr std::uint8_t kHit = 255;
  static_assert(kSamplesOfFree < kHit);

  std::uint8_t& at(const Eigen::Vector3d& point) {
    const VoxelIndex voxel = grid_.voxelAt(point);
    const ChunkIndex chunk = chunkOf(voxel);
    const Place place{chunk.x, chunk.y, chunk.z};
    if (latest_ == nullptr || place != latest_place_) {
      latest_ = &chunks_[place];
      latest_place_ = place;
    }
    return (*latest_)[static_cast<std::size_t>(indexInChunk(voxel))];
  }

  Grid grid_;
  std::map<Place, Samples> chunks_;
  Samples* latest_ = nullptr;  // a beam stays in a chunk for several samples
  Place latest_place_;
};

}  // namespace

VoxelTruth computeStreetTruth(const Street& street, double resolution) {
  Options options;
  options.method = Method::SCsm;
  options.resolution = resolution;
  options.number_of_classes = street.labels.numberOfClasses();
  SemanticMap truth(options);
  BeamVoxels beams(truth.grid());
  const auto isJudged = [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& point) {
    return (point - origin).norm() < kJudgedRange && truth.grid().contains(origin) &&
           truth.grid().contains(point);
  };
  LabelledCloud labelled;
  for (const StreetScan& scan : street.scans)
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      if (!isJudged(scan.origin, scan.points[i])) continue;
      labelled.add(scan.points[i], scan.labels[i]);
      beams.addBeam(scan.origin, scan.points[i]);
      beams.addPoint(scan.points[i]);
    }
  truth.insert(scanOf(labelled, Eigen::Vector3d::Zero()));
  if (!truth.boundingBox()) throw std::invalid_argument("no point of the street has a label");
  truth.insert(beams.freeVoxels());
  return VoxelTruth(truth);
}

}  // namespace csom
