// SPDX-License-Identifier: BSD-3-Clause
// Fewer points, evenly spread.
#include "poses/ThinnedPoints.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace csom::detail {
namespace {

using Member = std::pair<std::uint64_t, std::size_t>;  // cube, index of the point

std::uint64_t cubeOf(const Eigen::Vector3f& point, float edge) {
  constexpr std::int64_t kOffset = 1 << 20;
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::int64_t>(std::floor(point[axis] / edge));
    key = key << 21 | static_cast<std::uint64_t>(cell + kOffset);
  }
  return key;
}

}  // namespace

std::vector<Eigen::Vector3f> thinned(const std::vector<Eigen::Vector3f>& points, float edge) {
  std::vector<Member> members;
  members.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) members.emplace_back(cubeOf(points[i], edge), i);
  std::sort(members.begin(), members.end());

  std::vector<Eigen::Vector3f> chosen;
  for (auto begin = members.begin(); begin != members.end();) {
    const auto end = std::find_if(begin, members.end(),
                                  [&](const Member& m) { return m.first != begin->first; });
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (auto m = begin; m != end; ++m) mean += points[m->second];
    mean /= static_cast<float>(end - begin);
    const auto nearest = std::min_element(begin, end, [&](const Member& a, const Member& b) {
      return (points[a.second] - mean).squaredNorm() < (points[b.second] - mean).squaredNorm();
    });
    chosen.push_back(points[nearest->second]);
    begin = end;
  }
  return chosen;
}

}  // namespace csom::detail
