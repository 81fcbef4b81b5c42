// SPDX-License-Identifier: BSD-3-Clause
// One scan's word about one voxel is bounded.
#pragma once

#include <csom/core/CountIncrements.h>
#include <csom/core/DirichletVoxel.h>

#include <cstdint>

namespace csom::detail {

/// The word of a whole scan about a voxel with a surface, however many hits speak [quanta]: 1.
constexpr std::uint32_t kFullWord = 4096;
static_assert(kFullWord * kCountQuantum == 1);

/// How much of it is said by what passes through a part of the voxel: facets, beams.
constexpr float kPartOfWord = 0.4F;
constexpr auto kWordOfBeams = static_cast<std::uint32_t>(kPartOfWord * kFullWord + 0.5F);

/// For scans without an image: divides what is more than a full word among its classes in
/// proportion.
void boundWords(ScanIncrements& increments);

/// Takes out of the free voxels those in which the same scan sees more surface than free space: a
/// beam that grazes a surface does not take it away.
void keepSurfaces(const ScanIncrements& surfaces, ScanIncrements& free);

}  // namespace csom::detail
