// SPDX-License-Identifier: BSD-3-Clause
// Light and shade of pictures.
#pragma once

#include <csom/io/LabelSet.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace csom {

/// Darker below 1, towards white above. BGR.
cv::Vec3b shade(const Color& color, double brightness);

/// The range of some numbers without the outermost two percent; at least 1 wide.
struct CommonRange {
  explicit CommonRange(std::vector<std::int32_t> values);

  /// 0 … 1
  double share(double value) const;

  double low = 0;
  double high = 1;
};

}  // namespace csom
