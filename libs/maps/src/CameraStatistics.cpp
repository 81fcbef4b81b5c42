// SPDX-License-Identifier: BSD-3-Clause
#include <csom/maps/CameraStatistics.h>

namespace csom {

std::size_t CameraStatistics::pointsDropped() const {
  std::size_t without_label = 0;
  for (std::size_t i = 0; i < kPointFates; ++i) {
    if (static_cast<PointFate>(i) != PointFate::Labelled) without_label += points[i];
  }
  return without_label - kept_unlabelled;
}

}  // namespace csom
