// SPDX-License-Identifier: BSD-3-Clause
// From a raw scan to training points in blocks: reject, down-sample, sample free space, bin.
#pragma once

#include <csom/core/Grid.h>
#include <csom/core/Options.h>
#include <csom/core/ScanReport.h>
#include <csom/core/types.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace csom {

/// A training point, in voxels (not metres) from the lower corner of its block, rounded to 2⁻¹⁷ of
/// a voxel: single-precision differences between points and voxel centres are then exact within 60
/// voxels, so a scan that is shifted by whole blocks adds the same counts, wherever it lies.
struct TrainingPoint {
  float x, y, z;
  ClassId label;  ///< of a hard scan; 0 in a soft one
};

/// The accepted points of a scan with an image, in the order of the scan.
struct ImagePoints {
  RangeImage image;                     ///< of these points
  std::vector<Eigen::Vector3f> points;  ///< relative to the origin [m]
  std::vector<ClassId> labels;          ///< as in Scan
  std::vector<float> scores;
};

/// A scan ready for inference. Points are grouped by block: those of blocks[b] are
/// points[block_begin[b]] … points[block_begin[b+1]−1].
struct PreparedScan {
  BlockLayout layout{2};                   ///< of `blocks`
  std::vector<TrainingPoint> points;       ///< hits, then free samples, of each block
  std::vector<float> scores;               ///< soft scans: points × K, row-major; else empty
  std::vector<BlockIndex> blocks;          ///< the observed blocks, ascending (z-major)
  std::vector<std::uint32_t> block_begin;  ///< blocks.size() + 1 offsets into `points`

  /// What ray casting needs; filled for FreeSpace::Raycast only.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< sensor in the map frame [m]
  std::vector<Eigen::Vector3d> beam_ends;            ///< down-sampled hits in the map frame [m]
  std::vector<VoxelIndex> hit_voxels;  ///< voxels of every accepted point, with repeats

  /// Of a scan with an image, for methods that look at it: these points, neither down-sampled nor
  /// in blocks, instead of those above.
  ImagePoints image_points;
};

/// How far a scan may reach from its origin along each axis [m].
double scanReach(const Options& options);

/// Steps 0 to 3 of docs/algorithm.md. Bad points are counted in `report`, never thrown for; throws
/// std::invalid_argument if labels, scores or the pixels of an image do not match the points, if
/// the image is none (see RangeImage.h), or if there are more than 2^27 free samples.
///
/// A scan may reach almost 2^20 voxels (and down-sampling cells) from its origin along each axis;
/// points beyond are rejected as OutsideIndexRange. With free space, points farther than 8192 steps
/// of it (free_resolution or voxels) are rejected as BeamTooLong.
PreparedScan prepareScan(const Scan& scan, const Options& options, ScanReport& report);

}  // namespace csom
