// SPDX-License-Identifier: BSD-3-Clause
// What the report page says about cameras and about the motion of sensors.
#pragma once

#include <csom/report/MapFigures.h>
#include <csom/report/RunRecord.h>

#include <ostream>
#include <string>

namespace csom {

/// "What the camera saw": the pictures with a legend; nothing if there are none.
void writeCameraPictures(std::ostream& page, const RunRecord& record, const MapFigures& figures);

/// "What became of the points in view"; nothing if no camera gave labels.
void writeCameraLabels(std::ostream& page, const RunRecord& record);

/// Sentences about registration and de-skewing, each with a blank behind it; empty if there was
/// neither.
std::string motionInWords(const RunRecord& record);

}  // namespace csom
