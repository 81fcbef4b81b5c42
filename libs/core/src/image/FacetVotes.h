// SPDX-License-Identifier: BSD-3-Clause
// The voxels that hits lie in and facets pass through.
#pragma once

#include <csom/core/Options.h>
#include <csom/core/ScanPreparation.h>

#include <cstddef>

#include "image/Facets.h"
#include "image/ImageBeams.h"
#include "image/VoxelWords.h"

namespace csom::detail {

/// Counts the hits begin … end−1 of the scan: each is one of its class, or its scores.
void addHits(const PreparedScan& scan, const ImageBeams& beams, const Options& options,
             std::size_t begin, std::size_t end, VoxelWords& words);

/// Counts the facets from the beams begin … end−1 to those beside and above them.
///
/// A facet passes through the voxels of m − 1 points that divide it into m equal pieces, m odd and
/// as small as pieces of at most 0.4 voxels (or 2047 pieces) allow. Its weight at each of them is
/// 0.4/(1 + (d/1 m)²) of a full word, d being the distance to the nearer end (its class: Facets.h):
/// between two beams a scan cannot see what is lower than the wedge between them, and that grows
/// with the distance from both.
void addFacets(const ImageBeams& beams, const Facets& facets, const Options& options,
               std::size_t begin, std::size_t end, VoxelWords& words);

}  // namespace csom::detail
