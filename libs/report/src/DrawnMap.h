// SPDX-License-Identifier: BSD-3-Clause
// A map as one sees it from somewhere, before scale bar, axes and legend are around it.
#pragma once

#include <csom/core/types.h>

#include <cstddef>
#include <map>
#include <opencv2/core.hpp>
#include <set>
#include <string>
#include <vector>

namespace csom {

struct DrawnAxis {
  std::string name;       ///< "x", "-y"
  cv::Point2d direction;  ///< in the picture, y down; of length 1 or less
};

struct DrawnMap {
  cv::Mat picture;              ///< 8-bit BGR in pixels of a Canvas before it is reduced
  double metres_per_pixel = 0;  ///< of the final picture, along the axes
  std::vector<DrawnAxis> axes;
  std::map<ClassId, std::size_t> seen;  ///< how often the picture shows a class
  bool free_space = false;              ///< it shows some
  std::set<ClassId> left_out;           ///< classes that the map has but that are not drawn
};

}  // namespace csom
