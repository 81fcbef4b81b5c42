// SPDX-License-Identifier: BSD-3-Clause
// Voxels that a scan looked through, found a chunk at a time from its depths.
#pragma once

#include <csom/core/CountIncrements.h>
#include <csom/core/Options.h>

#include "image/DepthCube.h"
#include "image/ImageBeams.h"

namespace csom::detail {

/// A voxel is free if the cube of 0.8 of its edge around its centre lies in front of everything
/// that was drawn in its directions.
///
/// The word about it is a full one where adjacent beams are nearer than the voxel's edge at its
/// distance, so that one of them went through it; else 0.4/(1 + (g/1 m)²), where g is by how much
/// half the distance of the beams exceeds half an edge: what facets say between hits.
///
/// In any order of chunks. Voxels with surface are among them, if they are seen through: the caller
/// knows.
ScanIncrements findFreeSpace(const ImageBeams& beams, const DepthCube& cube,
                             const Options& options);

}  // namespace csom::detail
