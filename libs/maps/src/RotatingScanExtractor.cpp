// SPDX-License-Identifier: BSD-3-Clause
// Points of CObservationRotatingScan.
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/VelodyneCalibration.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>

#include "Extractors.h"

namespace csom {
namespace {

using mrpt::obs::CObservationRotatingScan;
using mrpt::obs::VelodyneCalibration;

bool isVelodyne(const CObservationRotatingScan& scan) {
  return scan.lidarModel == "VLP-16" || scan.lidarModel == "HDL-32E";
}

/// Sine and cosine of a row's elevation.
struct Elevation {
  double sine = 0;
  double cosine = 1;
};

/// The observation does not hold the elevations of its rows: only the models that MRPT has a
/// calibration of are known, and scanners of one row.
std::vector<Elevation> computeElevations(const CObservationRotatingScan& scan) {
  if (scan.rowCount == 1) return {Elevation{}};
  if (isVelodyne(scan)) {
    const char* model = scan.lidarModel == "VLP-16" ? "VLP16" : "HDL32";
    const auto& lasers = VelodyneCalibration::LoadDefaultCalibration(model).laser_corrections;
    if (lasers.size() == scan.rowCount) {
      std::vector<Elevation> elevations;
      for (const auto& laser : lasers)
        elevations.push_back({laser.sinVertCorrection, laser.cosVertCorrection});
      return elevations;
    }
  }
  throw std::runtime_error("the elevations of lidar model '" + scan.lidarModel + "' with " +
                           std::to_string(scan.rowCount) +
                           " rows are not known; VLP-16, HDL-32E and single rows are");
}

bool knowsElevations(const CObservationRotatingScan& scan) {
  try {
    computeElevations(scan);
  } catch (const std::exception&) {
    return false;
  }
  return true;
}

bool columnsEmptyFrom(const CObservationRotatingScan& scan, int first) {
  for (int row = 0; row < scan.rangeImage.rows(); ++row) {
    for (int column = first; column < scan.rangeImage.cols(); ++column) {
      if (scan.rangeImage(row, column) != 0) return false;
    }
  }
  return true;
}

/// The number of each row of the observation in the order of elevations.
std::vector<std::uint16_t> orderOf(const std::vector<Elevation>& elevations) {
  std::vector<std::size_t> by_elevation(elevations.size());
  std::iota(by_elevation.begin(), by_elevation.end(), std::size_t{0});
  std::stable_sort(by_elevation.begin(), by_elevation.end(), [&](std::size_t a, std::size_t b) {
    return elevations[a].sine < elevations[b].sine;
  });
  std::vector<std::uint16_t> order(elevations.size());
  for (std::size_t i = 0; i < by_elevation.size(); ++i)
    order[by_elevation[i]] = static_cast<std::uint16_t>(i);
  return order;
}

/// Azimuth of a column, counter-clockwise from the sensor's forward direction.
struct Azimuths {
  double start = 0;
  double step = 0;

  /// Columns of a full turn; 0 if `columns` of them are less than one, or more.
  std::int32_t columnsOfTurn(int columns) const {
    constexpr double kTurn = 2 * 3.14159265358979323846;
    const double turn = kTurn / std::abs(step);
    const bool is_turn = std::abs(turn - std::round(turn)) < 0.1 && std::abs(turn - columns) < 1.5;
    return is_turn ? std::max(columns, static_cast<int>(std::lround(turn))) : 0;
  }
};

/// Whether fromVelodyne() of MRPT has made the scan: it counts one column for each laser, of which
/// it fills the first 1/rows, and writes clockwise azimuths although they are defined
/// counter-clockwise.
bool isFromVelodyne(const CObservationRotatingScan& scan) {
  const int firings = static_cast<int>(scan.rangeImage.cols()) / scan.rowCount;
  return isVelodyne(scan) && firings > 0 && columnsEmptyFrom(scan, firings);
}

/// Those in which something may have been measured.
int measuredColumns(const CObservationRotatingScan& scan) {
  const int columns = static_cast<int>(scan.rangeImage.cols());
  return isFromVelodyne(scan) ? columns / scan.rowCount : columns;
}

Azimuths computeAzimuths(const CObservationRotatingScan& scan) {
  const int columns = measuredColumns(scan);
  if (isFromVelodyne(scan)) return {-scan.startAzimuth, -scan.azimuthSpan / columns};
  return {scan.startAzimuth, columns > 1 ? scan.azimuthSpan / (columns - 1) : 0.0};
}

class RotatingScanExtractor : public PointExtractor {
 public:
  bool accepts(const mrpt::obs::CObservation& observation) const override {
    return dynamic_cast<const CObservationRotatingScan*>(&observation) != nullptr;
  }

  bool seesAllAround() const override { return true; }

  bool holdsPoints(const mrpt::obs::CObservation& observation) const override {
    const auto& scan = dynamic_cast<const CObservationRotatingScan&>(observation);
    return scan.rangeImage.rows() > 0 && scan.rangeImage.cols() > 0 && knowsElevations(scan);
  }

  SensorPoints extract(const mrpt::obs::CObservation& observation,
                       const LabelRules& rules) const override {
    const auto& scan = dynamic_cast<const CObservationRotatingScan&>(observation);
    const int rows = static_cast<int>(scan.rangeImage.rows());
    const int columns = static_cast<int>(scan.rangeImage.cols());
    if (rows != scan.rowCount || columns != scan.columnCount)
      throw std::runtime_error("its range image has not rowCount x columnCount pixels");
    const bool labelled = rules.source() == PointLabels::ByIntensity && hasIntensities(scan);

    SensorPoints out;
    out.sensor_pose = scan.sensorPose;
    if (rows == 0 || columns == 0) return out;
    const std::vector<Elevation> elevations = computeElevations(scan);
    const std::vector<std::uint16_t> order = orderOf(elevations);
    const Azimuths azimuths = computeAzimuths(scan);
    // A single row says nothing about what is above and below it.
    const bool has_image = rows > 1;
    if (has_image) {
      out.image_origin = ImageOrigin::Sensor;
      out.image.columns_of_turn = azimuths.columnsOfTurn(measuredColumns(scan));
    }
    // What fromVelodyne() leaves empty is no beam.
    for (int column = 0; column < measuredColumns(scan); ++column) {
      const double azimuth = azimuths.start + azimuths.step * column;
      const Eigen::Vector2d direction(std::cos(azimuth), std::sin(azimuth));
      for (int row = 0; row < rows; ++row) {
        const std::uint16_t steps = scan.rangeImage(row, column);
        const double range = steps * scan.rangeResolution;
        const Elevation& elevation = elevations[static_cast<std::size_t>(row)];
        const Eigen::Vector3d beam(elevation.cosine * direction.x(),
                                   elevation.cosine * direction.y(), elevation.sine);
        const RangeImage::Pixel pixel{order[static_cast<std::size_t>(row)], column};
        if (steps == 0 || steps == kSaturatedRange || !(range > 0) || range > scan.maxRange) {
          if (has_image)
            out.addEmpty({(scan.maxRange * beam).cast<float>(), pixel});
          else
            ++out.no_returns;
          continue;
        }
        const Eigen::Vector3f point = (range * beam).cast<float>();
        const PointLabel label =
            labelled ? rules.fromRaw(scan.intensityImage(row, column)) : PointLabel{};
        if (has_image)
          out.add(point, label, pixel);
        else
          out.add(point, label);
      }
    }
    return out;
  }

 private:
  static bool hasIntensities(const CObservationRotatingScan& scan) {
    if (scan.intensityImage.rows() == 0 || scan.intensityImage.cols() == 0) return false;
    if (scan.intensityImage.rows() != scan.rangeImage.rows() ||
        scan.intensityImage.cols() != scan.rangeImage.cols())
      throw std::runtime_error("its intensity image has not the size of its range image");
    return true;
  }
};

}  // namespace

std::unique_ptr<PointExtractor> makeRotatingScanExtractor() {
  return std::make_unique<RotatingScanExtractor>();
}

}  // namespace csom
