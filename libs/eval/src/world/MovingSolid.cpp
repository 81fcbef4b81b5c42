// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/MovingSolid.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace csom {

MovingSolid::MovingSolid(const Solid& solid, std::vector<TimedOffset> places)
    : solid_(solid), places_(std::move(places)) {
  if (places_.size() < 2) throw std::invalid_argument("a solid moves between two places at least");
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (!std::isfinite(places_[i].time) || !places_[i].offset.allFinite())
      throw std::invalid_argument("a place of a moving solid is not finite");
    if (i > 0 && places_[i].time <= places_[i - 1].time)
      throw std::invalid_argument("the times of a moving solid do not ascend");
    const Eigen::Vector3d offset(places_[i].offset.x(), places_[i].offset.y(), 0);
    const Eigen::AlignedBox3d here = solid_.bounds();
    bounds_.extend(Eigen::AlignedBox3d(here.min() + offset, here.max() + offset));
  }
}

Eigen::Vector3d MovingSolid::offsetAt(double time) const {
  const auto next = std::find_if(places_.begin(), places_.end(),
                                 [&](const TimedOffset& place) { return place.time > time; });
  Eigen::Vector2d offset;
  if (next == places_.begin()) {
    offset = places_.front().offset;
  } else if (next == places_.end()) {
    offset = places_.back().offset;
  } else {
    const TimedOffset& before = *(next - 1);
    const double part = (time - before.time) / (next->time - before.time);
    offset = before.offset + part * (next->offset - before.offset);
  }
  return {offset.x(), offset.y(), 0};
}

std::optional<Solid::Entry> MovingSolid::enter(const Eigen::Vector3d& origin,
                                               const Eigen::Vector3d& direction,
                                               double time) const {
  return solid_.enter(origin - offsetAt(time), direction);
}

}  // namespace csom
