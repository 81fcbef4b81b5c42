// SPDX-License-Identifier: BSD-3-Clause
// Joins scans and images by time, and labels the one from the other.
#pragma once

#include <csom/io/LabelSet.h>
#include <csom/maps/CameraImage.h>
#include <csom/maps/CameraLabelledAdapter.h>

#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "ImageLabeller.h"
#include "ImageStream.h"
#include "WaitingScan.h"

namespace csom {

/// What CameraLabelledAdapter is made of; copies share pixels and networks.
class CameraLabelling {
 public:
  static constexpr std::size_t kMostWaiting = 64;
  static constexpr double kRestart = 1.0;  ///< [s], or twice max_time_offset if that is more

  /// Throws ConfigError or FileError if a network is described wrongly or missing.
  CameraLabelling(const LabelOptions& options, const LabelSet& labels);

  /// See ObservationAdapter and CameraLabelledAdapter.
  void loadNetworks();
  std::optional<std::vector<AdaptedScan>> adapt(const mrpt::obs::CObservation& observation,
                                                const Eigen::Isometry3d& robot_pose,
                                                const LabelRules& rules);
  std::vector<AdaptedScan> flush();
  std::vector<AdaptedScan> takeFinished() { return std::exchange(finished_, {}); }
  void takeNetworksOf(const CameraLabelling& other);
  void writeTo(ByteWriter& out) const;
  void readFrom(ByteReader& in, std::uint8_t version);

  const CameraStatistics& statistics() const { return statistics_; }
  LabelledScanObserver observer;

 private:
  struct Camera {
    LabelSource source;
    std::shared_ptr<ImageLabeller> labeller;  ///< null: its images are labels
    ImageStream images;
    std::shared_ptr<const CameraProjection> projection;  ///< of the last image
    StreamedImage last_photo;                            ///< of a camera with label images
    std::size_t image_count = 0;

    const std::string& imageLabel() const {
      return labeller ? source.sensor_label : source.label_image;
    }
  };

  std::shared_ptr<ImageLabeller> labellerOf(const LabelSource& source,
                                            const LabelSet& labels) const;
  bool labelsItself(const std::string& sensor_label) const;
  bool labelsItself(const SensorPoints& points, const LabelRules& rules) const;
  std::optional<CameraImage> readImage(std::size_t camera,
                                       const mrpt::obs::CObservation& observation);
  bool takePhoto(const mrpt::obs::CObservation& observation);
  void addImage(std::size_t camera, const CameraImage& image, double time,
                const Eigen::Isometry3d& robot_pose);
  void advanceClock(double time);
  bool isReady(const WaitingScan& scan) const;
  void finishReady();
  void finish(const WaitingScan& scan);
  void evaluate(const std::vector<std::pair<std::size_t, StreamedImage*>>& images);
  void forgetImages();

  double restart() const { return std::max(kRestart, 2 * options_.max_time_offset); }

  LabelOptions options_;
  RawToClass raw_to_class_;
  int number_of_classes_;
  ClassId unlabelled_ = kFreeClass;  ///< free: points without a label are dropped
  std::vector<Camera> cameras_;
  std::deque<WaitingScan> waiting_;
  std::vector<AdaptedScan> finished_;  ///< handed out by the next call
  std::optional<double> clock_;        ///< latest time of an observation
  CameraStatistics statistics_;
};

}  // namespace csom
