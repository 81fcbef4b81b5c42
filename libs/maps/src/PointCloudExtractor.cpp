// SPDX-License-Identifier: BSD-3-Clause
// Points of CObservationPointCloud.
#include <csom/maps/MrptCompatibility.h>
#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "Extractors.h"

namespace csom {
namespace {

using mrpt::maps::CColouredPointsMap;
using mrpt::maps::CPointsMap;
using mrpt::maps::CPointsMapXYZI;
using mrpt::obs::CObservationPointCloud;

std::uint8_t toByte(float channel) {
  const float value = std::round(channel * 255.0f);
  return value >= 0 && value <= 255 ? static_cast<std::uint8_t>(value) : std::uint8_t{0};
}

std::vector<PointLabel> labelsByIntensity(const CPointsMapXYZI& cloud, const LabelRules& rules) {
  const auto& intensities = intensitiesOf(cloud);
  // Some ways of filling this class leave more intensities than points: then no point's own label
  // is known.
  if (intensities.size() != cloud.size()) {
    throw std::runtime_error("the cloud has " + std::to_string(cloud.size()) + " points but " +
                             std::to_string(intensities.size()) + " intensities");
  }
  std::vector<PointLabel> labels;
  labels.reserve(intensities.size());
  for (const float intensity : intensities) labels.push_back(rules.fromIntensity(intensity));
  return labels;
}

std::vector<PointLabel> labelsByColor(const CColouredPointsMap& cloud, const LabelRules& rules) {
  std::vector<PointLabel> labels(cloud.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    float red = 0;
    float green = 0;
    float blue = 0;
    cloud.getPointColor(i, red, green, blue);
    labels[i] = rules.fromColor({toByte(red), toByte(green), toByte(blue)});
  }
  return labels;
}

std::vector<PointLabel> labelsOf(const CPointsMap& cloud, const LabelRules& rules) {
  if (rules.source() == PointLabels::ByIntensity) {
    if (const auto* xyzi = dynamic_cast<const CPointsMapXYZI*>(&cloud))
      return labelsByIntensity(*xyzi, rules);
  }
  if (rules.source() == PointLabels::ByColor) {
    if (const auto* coloured = dynamic_cast<const CColouredPointsMap*>(&cloud))
      return labelsByColor(*coloured, rules);
  }
  return std::vector<PointLabel>(cloud.size());
}

/// The cloud of an observation, read from its file if it lies in one. load() would write into the
/// observation, which other threads may be reading.
CPointsMap::ConstPtr makeCloud(const CObservationPointCloud& scan) {
  if (!scan.isExternallyStored() || (scan.pointcloud && !scan.pointcloud->empty()))
    return scan.pointcloud;
  CObservationPointCloud copy = scan;
  copy.pointcloud.reset();  // would be shared with the original
  copy.load();
  return copy.pointcloud;
}

class PointCloudExtractor : public PointExtractor {
 public:
  bool accepts(const mrpt::obs::CObservation& observation) const override {
    return dynamic_cast<const CObservationPointCloud*>(&observation) != nullptr;
  }

  bool seesAllAround() const override { return true; }

  bool holdsPoints(const mrpt::obs::CObservation& observation) const override {
    const auto& scan = dynamic_cast<const CObservationPointCloud&>(observation);
    return scan.isExternallyStored() || (scan.pointcloud && !scan.pointcloud->empty());
  }

  SensorPoints extract(const mrpt::obs::CObservation& observation,
                       const LabelRules& rules) const override {
    const auto& scan = dynamic_cast<const CObservationPointCloud&>(observation);
    const CPointsMap::ConstPtr loaded = makeCloud(scan);
    if (!loaded) throw std::runtime_error("it has no point cloud");
    const CPointsMap& cloud = *loaded;
    const auto& x = cloud.getPointsBufferRef_x();
    const auto& y = cloud.getPointsBufferRef_y();
    const auto& z = cloud.getPointsBufferRef_z();

    SensorPoints out;
    out.sensor_pose = scan.sensorPose;
    out.image_origin = ImageOrigin::Unknown;
    const std::vector<PointLabel> labels = labelsOf(cloud, rules);
    out.reserve(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) out.add({x[i], y[i], z[i]}, labels[i]);
    return out;
  }
};

}  // namespace

std::unique_ptr<PointExtractor> makePointCloudExtractor() {
  return std::make_unique<PointCloudExtractor>();
}

}  // namespace csom
