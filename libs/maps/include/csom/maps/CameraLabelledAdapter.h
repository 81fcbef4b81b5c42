// SPDX-License-Identifier: BSD-3-Clause
// Scans take their labels from the images of cameras.
#pragma once

#include <csom/maps/CameraStatistics.h>
#include <csom/maps/LabelOptions.h>
#include <csom/maps/ObservationAdapter.h>

#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>

namespace csom {

class CameraLabelling;

/// A scan and the images that labelled it, for pictures. Copies share pixels.
struct LabelledScan {
  struct View {
    std::string sensor_label;
    double timestamp = 0;    ///< of the image [s since 1970]
    std::size_t number = 0;  ///< of the image among those of its camera
    cv::Mat photo;           ///< what the camera saw; empty if only ids are known
    std::shared_ptr<const CameraProjection> projection;
    Eigen::Isometry3d camera_from_points;
    std::shared_ptr<const SemanticImage> labels;
  };
  std::vector<Eigen::Vector3f> points;  ///< in the frame of their sensor
  LabelledPoints labelled;              ///< its views are indices into `views`
  std::vector<View> views;
};

using LabelledScanObserver = std::function<void(const LabelledScan&)>;

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
  /// Throws ConfigError or FileError if a
  /// network is described wrongly or missing.
  CameraLabelledAdapter(const LabelOptions& options, const LabelSet& labels);
  ~CameraLabelledAdapter() override;

  /// Loads the networks now rather than at the first image. Throws FileError.
  void loadNetworks();
  /// Uses the networks of another adapter, which has the same label sources. Throws
  /// std::invalid_argument if they are not the same.
  void takeNetworksOf(const CameraLabelledAdapter& other);
  /// Called with every scan that had an image. Clones have no observer.
  void setObserver(LabelledScanObserver observer);

  std::optional<std::vector<AdaptedScan>> adapt(const mrpt::obs::CObservation& observation,
                                                const Eigen::Isometry3d& robot_pose,
                                                const LabelRules& rules) override;
  std::vector<AdaptedScan> flush() override;
  std::unique_ptr<ObservationAdapter> clone() const override;
  std::vector<AdaptedScan> takeFinished() override;
  const CameraStatistics* cameraStatistics() const override;
  void writeTo(ByteWriter& out) const override;
  void readFrom(ByteReader& in, std::uint8_t version) override;

 private:
  explicit CameraLabelledAdapter(std::unique_ptr<CameraLabelling> labelling);

  std::unique_ptr<CameraLabelling> labelling_;
};

/// The adapter for these options: a CameraLabelledAdapter if they name a camera. Throws like its
/// constructor.
std::unique_ptr<ObservationAdapter> makeAdapter(const LabelOptions& options,
                                                const LabelSet& labels);

}  // namespace csom
