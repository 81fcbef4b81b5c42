// SPDX-License-Identifier: BSD-3-Clause
// Points of CObservation3DRangeScan.
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <cstdint>
#include <stdexcept>
#include <string>

#include "Extractors.h"

namespace csom {
namespace {

using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::TPixelLabelInfo;
using mrpt::obs::TPixelLabelInfoBase;

/// Reads the bit mask of a pixel. The virtual getLabels() of MRPT hands out only its low 8 bits.
class PixelLabels {
 public:
  PixelLabels(const TPixelLabelInfoBase& info, const LabelRules& rules)
      : info_(&info), rules_(&rules) {
    const bool known = resolve<1>() || resolve<2>() || resolve<4>() || resolve<8>();
    if (!known)
      throw std::runtime_error("pixelLabels has masks of " + std::to_string(info.BITFIELD_BYTES) +
                               " bytes; 1, 2, 4 or 8 are possible");
  }

  int rows() const { return rows_; }
  int columns() const { return columns_; }

  PointLabel at(int row, int column) const {
    const std::uint64_t mask = maskAt(row, column);
    if (mask == 0) return {};
    if ((mask & (mask - 1)) != 0) return {PointLabel::Kind::Ambiguous};
    return ofBit(static_cast<std::uint32_t>(__builtin_ctzll(mask)));
  }

 private:
  template <unsigned int Bytes>
  bool resolve() {
    const auto* typed = dynamic_cast<const TPixelLabelInfo<Bytes>*>(info_);
    if (typed == nullptr) return false;
    rows_ = static_cast<int>(typed->pixelLabels.rows());
    columns_ = static_cast<int>(typed->pixelLabels.cols());
    bytes_ = Bytes;
    return true;
  }

  template <unsigned int Bytes>
  std::uint64_t maskOf(int row, int column) const {
    return static_cast<const TPixelLabelInfo<Bytes>&>(*info_).pixelLabels(row, column);
  }

  std::uint64_t maskAt(int row, int column) const {
    switch (bytes_) {
      case 1:
        return maskOf<1>(row, column);
      case 2:
        return maskOf<2>(row, column);
      case 4:
        return maskOf<4>(row, column);
      default:
        return maskOf<8>(row, column);
    }
  }

  /// A bit that has a name means the class of that name; a nameless one is a raw id.
  PointLabel ofBit(std::uint32_t bit) const {
    const auto name = info_->pixelLabelNames.find(bit);
    return name == info_->pixelLabelNames.end() ? rules_->fromRaw(bit)
                                                : rules_->fromName(name->second);
  }

  const TPixelLabelInfoBase* info_;
  const LabelRules* rules_;
  unsigned int bytes_ = 0;
  int rows_ = 0;
  int columns_ = 0;
};

class RangeCameraExtractor : public PointExtractor {
 public:
  bool accepts(const mrpt::obs::CObservation& observation) const override {
    return dynamic_cast<const CObservation3DRangeScan*>(&observation) != nullptr;
  }

  bool seesAllAround() const override { return false; }

  bool holdsPoints(const mrpt::obs::CObservation& observation) const override {
    const auto& scan = dynamic_cast<const CObservation3DRangeScan&>(observation);
    return scan.hasRangeImage || scan.hasPoints3D;
  }

  SensorPoints extract(const mrpt::obs::CObservation& observation,
                       const LabelRules& rules) const override {
    const auto& scan = dynamic_cast<const CObservation3DRangeScan&>(observation);
    // Unprojecting is not const, and load() writes although it is: others may read the original.
    CObservation3DRangeScan copy = scan;
    copy.load();  // the images may lie in files of their own
    std::size_t no_returns = 0;
    if (copy.hasRangeImage) {
      no_returns = clearNoReturns(copy);
      unproject(copy);
    }
    SensorPoints points = pointsOf(copy, rules);
    points.no_returns += no_returns;
    return points;
  }

 private:
  /// Makes pixels without a return 0, which MRPT leaves out when it unprojects. Returns how many
  /// there are.
  static std::size_t clearNoReturns(CObservation3DRangeScan& scan) {
    std::size_t count = 0;
    for (int row = 0; row < scan.rangeImage.rows(); ++row) {
      for (int column = 0; column < scan.rangeImage.cols(); ++column) {
        std::uint16_t& steps = scan.rangeImage(row, column);
        const bool is_return = steps != 0 && steps != kSaturatedRange &&
                               steps * static_cast<double>(scan.rangeUnits) <= scan.maxRange;
        if (is_return) continue;
        steps = 0;
        ++count;
      }
    }
    return count;
  }

  /// Into the points of the observation itself, in the frame of the sensor: the indices of their
  /// pixels come with them.
  static void unproject(CObservation3DRangeScan& scan) {
    if (scan.rangeImage.rows() == 0 || scan.rangeImage.cols() == 0)
      throw std::runtime_error("its range image is empty");
    if (scan.cameraParams.ncols != static_cast<std::uint32_t>(scan.rangeImage.cols()) ||
        scan.cameraParams.nrows != static_cast<std::uint32_t>(scan.rangeImage.rows()))
      throw std::runtime_error("its range image has not the size of its camera parameters");
    mrpt::maps::CSimplePointsMap points;
    mrpt::obs::T3DPointsProjectionParams parameters;
    parameters.takeIntoAccountSensorPoseOnRobot = false;
    scan.unprojectInto(points, parameters);
    scan.points3D_x.assign(points.getPointsBufferRef_x().begin(),
                           points.getPointsBufferRef_x().end());
    scan.points3D_y.assign(points.getPointsBufferRef_y().begin(),
                           points.getPointsBufferRef_y().end());
    scan.points3D_z.assign(points.getPointsBufferRef_z().begin(),
                           points.getPointsBufferRef_z().end());
    scan.hasPoints3D = true;
  }

  static SensorPoints pointsOf(const CObservation3DRangeScan& scan, const LabelRules& rules) {
    SensorPoints out;
    out.sensor_pose = scan.sensorPose;
    if (!scan.hasPoints3D) return out;
    const std::size_t count = scan.points3D_x.size();
    if (scan.points3D_y.size() != count || scan.points3D_z.size() != count)
      throw std::runtime_error("its points have coordinates of unequal number");
    const std::vector<PointLabel> labels =
        scan.pixelLabels ? labelsOf(scan, rules) : std::vector<PointLabel>(count);
    const bool has_image =
        scan.points3D_idxs_x.size() == count && scan.points3D_idxs_y.size() == count;
    out.image_origin = has_image ? ImageOrigin::Sensor : ImageOrigin::Unknown;
    out.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3f point(scan.points3D_x[i], scan.points3D_y[i], scan.points3D_z[i]);
      if (has_image)
        out.add(point, labels[i], {scan.points3D_idxs_y[i], scan.points3D_idxs_x[i]});
      else
        out.add(point, labels[i]);
    }
    return out;
  }

  static std::vector<PointLabel> labelsOf(const CObservation3DRangeScan& scan,
                                          const LabelRules& rules) {
    const PixelLabels pixels(*scan.pixelLabels, rules);
    if (scan.hasRangeImage &&
        (pixels.rows() != scan.rangeImage.rows() || pixels.columns() != scan.rangeImage.cols()))
      throw std::runtime_error("pixelLabels has not the size of the range image");
    const std::size_t count = scan.points3D_x.size();
    if (scan.points3D_idxs_x.size() != count || scan.points3D_idxs_y.size() != count)
      throw std::runtime_error("its points do not tell their pixels");
    std::vector<PointLabel> labels(count);
    for (std::size_t i = 0; i < count; ++i) {
      const int column = scan.points3D_idxs_x[i];
      const int row = scan.points3D_idxs_y[i];
      if (row >= pixels.rows() || column >= pixels.columns())
        throw std::runtime_error("a point lies outside of pixelLabels");
      labels[i] = pixels.at(row, column);
    }
    return labels;
  }
};

}  // namespace

std::unique_ptr<PointExtractor> makeRangeCameraExtractor() {
  return std::make_unique<RangeCameraExtractor>();
}

}  // namespace csom
