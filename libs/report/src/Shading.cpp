// SPDX-License-Identifier: BSD-3-Clause
// Brightness of pixels.
#include "Shading.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace csom {

cv::Vec3b shade(const Color& color, double brightness) {
  const auto channel = [&](std::size_t i) {
    const double c = color[i];
    const double shaded = brightness < 1 ? c * brightness : c + (255 - c) * (brightness - 1);
    return static_cast<std::uint8_t>(std::lround(std::clamp(shaded, 0.0, 255.0)));
  };
  return {channel(2), channel(1), channel(0)};
}

CommonRange::CommonRange(std::vector<std::int32_t> values) {
  if (values.empty()) return;
  const auto at = [&](std::size_t rank) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank),
                     values.end());
    return values[rank];
  };
  const std::size_t last = values.size() - 1;
  low = at(last / 50);
  high = std::max(low + 1, double(at(last - last / 50)));
}

double CommonRange::share(double value) const {
  return std::clamp((value - low) / (high - low), 0.0, 1.0);
}

}  // namespace csom
