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

std::size_t CameraStatistics::pointsRejected() const {
  const bool kept = kept_unlabelled > 0;
  return pointsDropped() - (kept ? 0 : points[static_cast<std::size_t>(PointFate::OutsideView)]);
}

}  // namespace csom
