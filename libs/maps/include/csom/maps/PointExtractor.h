// SPDX-License-Identifier: BSD-3-Clause
// Points and labels of one observation, as the sensor sees them.
#pragma once

#include <csom/core/RangeImage.h>
#include <csom/maps/LabelRules.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace csom {

/// Which points of an observation lie beside each other.
enum class ImageOrigin {
  None,     ///< there is no way to tell
  Sensor,   ///< the observation says it
  Unknown,  ///< the order of the points may tell it: nobody has looked yet
  Found,    ///< the order of the points, or their elevations, have told it
};

/// A beam that nothing has thrown back.
struct EmptyBeam {
  Eigen::Vector3f farthest;  ///< in the frame of the sensor: what lies farther it cannot see [m]
  RangeImage::Pixel pixel;
};

/// Points in the frame of the sensor, with one label each.
///
/// Sensors write down a beam that nothing has thrown back as well: as a range of 0, below 0 or
/// beyond what they can measure, or as the point (0,0,0). Such a beam is no point, whatever
/// `min_range` is.
struct SensorPoints {
  mrpt::poses::CPose3D sensor_pose;     ///< on the robot
  std::vector<Eigen::Vector3f> points;  ///< [m]; may hold non-finite values, but never (0,0,0)
  std::vector<PointLabel> labels;       ///< as many as points
  ImageOrigin image_origin = ImageOrigin::None;
  RangeImage image;  ///< of ImageOrigin::Sensor and Found; else empty
  /// Of points that came as ImageOrigin::Unknown: how many beams the observation lists before each
  /// point, the points themselves not counted: those that returned nothing.
  std::vector<std::uint32_t> no_returns_before;
  /// Beams that hit nothing and that the observation lists all the same.
  std::size_t no_returns = 0;
  /// Those of them of which it is known where they went; only beside an image of the sensor.
  std::vector<EmptyBeam> empty_beams;

  void reserve(std::size_t count) {
    points.reserve(count);
    labels.reserve(count);
  }
  /// (0,0,0) counts as no return.
  void add(const Eigen::Vector3f& point, const PointLabel& label) {
    if (point == Eigen::Vector3f::Zero()) {
      ++no_returns;
      return;
    }
    points.push_back(point);
    labels.push_back(label);
    if (image_origin == ImageOrigin::Unknown)
      no_returns_before.push_back(static_cast<std::uint32_t>(no_returns));
  }
  /// With its place in the image: all points or none have one.
  void add(const Eigen::Vector3f& point, const PointLabel& label, const RangeImage::Pixel& pixel) {
    const std::size_t before = points.size();
    add(point, label);
    if (points.size() > before) image.pixels.push_back(pixel);
  }
  void addEmpty(const EmptyBeam& beam) {
    ++no_returns;
    empty_beams.push_back(beam);
  }
};

/// Reads one kind of observation. Stateless: any number of threads may use one extractor.
class PointExtractor {
 public:
  virtual ~PointExtractor() = default;
  /// True for observations of the kind that it reads.
  virtual bool accepts(const mrpt::obs::CObservation& observation) const = 0;
  /// Whether they are 3-D scans of the surroundings, which can be laid over one another.
  virtual bool seesAllAround() const = 0;
  /// Requires accepts(observation). False if it is plain, without reading files, that extract()
  /// would find no point or throw.
  virtual bool holdsPoints(const mrpt::obs::CObservation& observation) const = 0;
  /// Requires accepts(observation). Throws std::exception if the observation is damaged.
  virtual SensorPoints extract(const mrpt::obs::CObservation& observation,
                               const LabelRules& rules) const = 0;
};

/// The extractor that accepts `observation`; null for all but CObservationVelodyneScan,
/// CObservationPointCloud, CObservation3DRangeScan, CObservationRotatingScan and
/// CObservation2DRangeScan. Thread-safe; what it returns lives as long as the program.
const PointExtractor* findPointExtractor(const mrpt::obs::CObservation& observation);

}  // namespace csom
