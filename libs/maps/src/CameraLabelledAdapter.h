// SPDX-License-Identifier: BSD-3-Clause
// Joins scans and images by time, and labels the one from the other.
#pragma once

#include <csom/io/LabelSet.h>
#include <csom/maps/CameraImage.h>
#include <csom/maps/LabelOptions.h>
#include <csom/maps/ObservationAdapter.h>
#include <csom/vision/CameraStatistics.h>

#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "ImageLabeller.h"
#include "ImageStream.h"
#include "WaitingScan.h"

namespace csom {

/// Joins scans and images that are near to each other in time (docs/camera.md).
///
/// A scan waits until every camera has an image of its time or later, or until an observation of
/// more than max_time_offset later has come; then the nearest image of each camera within
/// max_time_offset labels it. At most 64 scans wait: beyond that the oldest is labelled
/// with what there is. Robot poses are taken for the moment of each observation, so that motion
/// between image and scan is accounted for. If time goes back by more than a second (or
/// twice max_time_offset), all that waits is finished first and all images are forgotten.
///
/// A sensor whose source is pixel_labels or point_labels, and points that carry labels of pixels,
/// need no camera and are handed on at once. Images of cameras that the options do not list are not
/// taken.
class CameraLabelledAdapter : public ObservationAdapter {
 public:
  static constexpr std::size_t kMaxWaiting = 64;
  static constexpr double kRestart = 1.0;  ///< [s], or twice max_time_offset if that is more

  /// Throws ConfigError or FileError if a network is described wrongly or missing.
  CameraLabelledAdapter(const LabelOptions& options, const LabelSet& labels,
                        const BeamRequest& beams = {});

  std::optional<std::vector<AdaptedScan>> adapt(const mrpt::obs::CObservation& observation,
                                                const Eigen::Isometry3d& robot_pose,
                                                const LabelRules& rules) override;
  std::vector<AdaptedScan> flush() override;
  /// Copies share pixels and networks, and have no observer.
  std::unique_ptr<ObservationAdapter> clone() const override;
  std::vector<AdaptedScan> takeFinished() override { return std::exchange(finished_, {}); }
  const CameraStatistics* cameraStatistics() const override { return &statistics_; }
  void loadNetworks() override;
  void takeNetworksOf(const ObservationAdapter& other) override;
  void setObserver(LabelledScanObserver observer) override { observer_ = std::move(observer); }
  void writeTo(ByteWriter& out) const override;
  void readFrom(ByteReader& in, std::uint8_t version) override;

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

  std::shared_ptr<ImageLabeller> makeLabeller(const LabelSource& source,
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
  LabelledScanObserver observer_;
};

}  // namespace csom
