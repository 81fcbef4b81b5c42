// SPDX-License-Identifier: BSD-3-Clause
// The range image of those points of an observation that become a scan.
#pragma once

#include <csom/maps/ObservationAdapter.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

namespace csom {

/// Takes the pixels of points over to the scan that is made of them.
class ImageOfKept {
 public:
  /// Both must outlive this.
  ImageOfKept(const SensorPoints& points, AdaptedScan& out) : from_(points), to_(out.scan) {
    if (points.image.empty()) return;
    out.image_origin = points.image_origin;
    to_.image.column_step = points.image.column_step;
    to_.image.columns_of_turn = points.image.columns_of_turn;
    to_.image.pixels.reserve(points.points.size());
  }
  /// To be called for each point of the scan, in its order.
  void keep(std::size_t point) {
    if (!from_.image.empty()) to_.image.pixels.push_back(from_.image.pixels[point]);
  }
  /// Behind all points: a point for each beam without a return, at `range` at most [m], and a call
  /// of label(), which is to give it its class. Nothing if the range is 0.
  template <class Label>
  void keepEmpty(const Eigen::Matrix3d& rotation, double range, const Label& label) {
    // Not beyond the limit by a rounding.
    constexpr double kJustBefore = 1 - 1e-6;
    if (range <= 0 || from_.image.empty()) return;
    for (const EmptyBeam& beam : from_.empty_beams) {
      const Eigen::Vector3d farthest = beam.farthest.cast<double>();
      const double part = std::min(1.0, range / farthest.norm()) * kJustBefore;
      to_.points.push_back((rotation * (part * farthest)).cast<float>());
      to_.image.pixels.push_back(beam.pixel);
      label();
    }
  }

 private:
  const SensorPoints& from_;
  Scan& to_;
};

}  // namespace csom
