// SPDX-License-Identifier: BSD-3-Clause
// The extractors of the library, one for each kind of observation.
#pragma once

#include <csom/maps/PointExtractor.h>

#include <cstdint>
#include <memory>

namespace csom {

/// What range images of 16 bits hold where the sensor gave up measuring; 0 where nothing came back.
constexpr std::uint16_t kSaturatedRange = 0xffff;

using MakePointExtractor = std::unique_ptr<PointExtractor>();
/// CObservationVelodyneScan: raw packets if there are any, else the stored cloud; labels in the
/// intensities.
MakePointExtractor makeVelodyneExtractor;
/// CObservationPointCloud: labels in the intensities of a CPointsMapXYZI or the colours of a
/// CColouredPointsMap.
MakePointExtractor makePointCloudExtractor;
/// CObservation3DRangeScan: the range image, or else the stored points; labels of pixels.
MakePointExtractor makeRangeCameraExtractor;
/// CObservationRotatingScan: labels in the intensity image.
MakePointExtractor makeRotatingScanExtractor;
/// CObservation2DRangeScan: all valid rays, one class.
MakePointExtractor makeLaserScanExtractor;

/// All. The first one that accepts an observation reads it.
constexpr MakePointExtractor* kMakePointExtractors[] = {
    makeVelodyneExtractor, makePointCloudExtractor, makeRangeCameraExtractor,
    makeRotatingScanExtractor, makeLaserScanExtractor};

}  // namespace csom
