// SPDX-License-Identifier: BSD-3-Clause
// Names of the files with camera pictures.
#pragma once

#include <csom/report/CameraRecord.h>

#include <string>

namespace csom {

/// "camera-first-points.jpg"; `what` is "segmentation" or "points".
inline std::string pictureFile(CameraPicture::Moment moment, const char* what) {
  return std::string("camera-") + toString(moment) + "-" + what + ".jpg";
}

}  // namespace csom
