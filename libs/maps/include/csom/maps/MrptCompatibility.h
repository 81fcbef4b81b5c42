// SPDX-License-Identifier: BSD-3-Clause
// What differs between the versions of MRPT that the plug-in is built against (docs/mrpt.md).
#pragma once

#include <mrpt/maps/CMetricMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/version.h>

/// MRPT 2.5.8 calls itself 0x258; versions with a byte for each number are larger than that.
#define CSOM_MRPT_SINCE(major, minor, patch) \
  (MRPT_VERSION >= (((major) << 16) | ((minor) << 8) | (patch)))

#if CSOM_MRPT_SINCE(2, 11, 3)
#define CSOM_OVERRIDE_SINCE_2_11_3 override
#else
#define CSOM_OVERRIDE_SINCE_2_11_3
#endif

namespace csom {

/// What internal_CreateFromMapDefinition() returns. Made of a pointer to a new map by a cast.
#if CSOM_MRPT_SINCE(2, 11, 3)
using CreatedMap = mrpt::maps::CMetricMap::Ptr;
#else
using CreatedMap = mrpt::maps::CMetricMap*;
#endif

namespace detail {
template <class Buffer>
const Buffer& bufferOf(const Buffer& buffer) {
  return buffer;
}
template <class Buffer>
const Buffer& bufferOf(const Buffer* buffer) {
  return *buffer;
}
}  // namespace detail

/// The intensities of a cloud, which MRPT gives by reference, later versions by pointer.
inline const auto& intensitiesOf(const mrpt::maps::CPointsMapXYZI& cloud) {
  return detail::bufferOf(cloud.getPointsBufferRef_intensity());
}

}  // namespace csom
