// SPDX-License-Identifier: BSD-3-Clause
// Names of the files with pictures.
#pragma once

#include <csom/report/CameraPicture.h>
#include <csom/report/MapPicture.h>

#include <string>

namespace csom {

/// "camera-first-points.jpg"; `what` is "segmentation" or "points".
inline std::string pictureFile(CameraPicture::Moment moment, const char* what) {
  return std::string("camera-") + toString(moment) + "-" + what + ".jpg";
}

/// "top.png"
inline std::string pictureFile(MapView view) {
  return std::string(toString(view)) + ".png";
}

}  // namespace csom
