// SPDX-License-Identifier: BSD-3-Clause
// From observations to semantic points.
#pragma once

#include <csom/core/Options.h>
#include <csom/core/types.h>
#include <csom/io/RunStatistics.h>
#include <csom/maps/LabelOptions.h>
#include <csom/maps/LabelRules.h>
#include <csom/maps/LabelledScan.h>
#include <csom/maps/PointExtractor.h>
#include <csom/vision/CameraStatistics.h>
#include <mrpt/obs/CObservation.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace csom {

class ByteReader;
class ByteWriter;

/// A scan that is ready to be inserted, and the observation that its points come from.
struct AdaptedScan {
  Scan scan;
  LabelCounts labels;
  ImageOrigin image_origin = ImageOrigin::None;  ///< never Unknown
  std::size_t no_returns = 0;                    ///< see SensorPoints
  double timestamp = 0;                          ///< seconds since 1970 (UTC); 0 if unknown
  std::string sensor_label;
  std::string observation_class;  ///< "CObservationVelodyneScan", …
};

/// What a map wants to know of the beams of scans.
struct BeamRequest {
  /// Whether the rows of clouds that do not tell them are to be searched for
  /// (csom::findRangeImage()).
  bool images = false;
  /// Beams without a return become points of class free at this range, or that of the sensor [m].
  /// 0: they do not.
  double free_range = 0;
};
/// What a map with these options wants to know.
BeamRequest beamsOf(const Options& options);

/// Turns observations into scans of labelled points. Labels may arrive with another observation
/// than the points: an adapter may keep an observation and return its scan when the missing part is
/// there, which is why adapt() is not const and returns any number of scans.
/// Not thread-safe.
class ObservationAdapter {
 public:
  explicit ObservationAdapter(const BeamRequest& beams) : beams_(beams) {}
  virtual ~ObservationAdapter() = default;
  /// Nothing: an observation of a kind that this adapter cannot use. Otherwise the scans that are
  /// complete now, in the order of their observations; none if the observation is kept for later.
  /// `robot_pose`: robot in the map frame. Throws std::exception if the observation is damaged.
  virtual std::optional<std::vector<AdaptedScan>> adapt(const mrpt::obs::CObservation& observation,
                                                        const Eigen::Isometry3d& robot_pose,
                                                        const LabelRules& rules) = 0;
  /// The scans that are still kept, labelled with what there is: nothing more will come.
  virtual std::vector<AdaptedScan> flush() = 0;
  /// With all that it keeps.
  virtual std::unique_ptr<ObservationAdapter> clone() const = 0;
  /// Scans that were complete before adapt() threw.
  virtual std::vector<AdaptedScan> takeFinished() { return {}; }
  /// Null if it uses no cameras. Valid until the next call.
  virtual const CameraStatistics* cameraStatistics() const { return nullptr; }

  // For adapters that use networks; the others have nothing to do.
  /// Loads them now rather than at the first image. Throws FileError.
  virtual void loadNetworks() {}
  /// Uses those of another adapter of the same kind, which has the same label sources. Throws
  /// std::invalid_argument if they are not the same.
  virtual void takeNetworksOf(const ObservationAdapter& /*other*/) {}
  /// Called with every scan that had an image. Clones have no observer.
  virtual void setObserver(LabelledScanObserver /*observer*/) {}

  /// What it keeps, as bytes and back: MRPT copies maps by streams. readFrom() is for an adapter of
  /// the same configuration and throws std::runtime_error if the bytes are not those of writeTo()
  /// in that version of the map's stream.
  virtual void writeTo(ByteWriter& out) const = 0;
  virtual void readFrom(ByteReader& in, std::uint8_t version) = 0;

 protected:
  ObservationAdapter(const ObservationAdapter&) = default;
  ObservationAdapter& operator=(const ObservationAdapter&) = default;
  const BeamRequest& beams() const { return beams_; }

 private:
  BeamRequest beams_;
};

/// The adapter for observations that carry their labels themselves, point by point or pixel by
/// pixel: one observation in, one scan out.
class SelfLabelledAdapter : public ObservationAdapter {
 public:
  explicit SelfLabelledAdapter(const BeamRequest& beams = {}) : ObservationAdapter(beams) {}
  std::optional<std::vector<AdaptedScan>> adapt(const mrpt::obs::CObservation& observation,
                                                const Eigen::Isometry3d& robot_pose,
                                                const LabelRules& rules) override;
  std::vector<AdaptedScan> flush() override { return {}; }
  std::unique_ptr<ObservationAdapter> clone() const override;
  void writeTo(ByteWriter& out) const override;
  void readFrom(ByteReader& in, std::uint8_t version) override;
};

/// The adapter for these options. Throws ConfigError or FileError if a network is described wrongly
/// or missing.
std::unique_ptr<ObservationAdapter> makeAdapter(const LabelOptions& options, const LabelSet& labels,
                                                const BeamRequest& beams);

/// Seconds since 1970; 0 if the observation has no time stamp.
double secondsSince1970(const mrpt::obs::CObservation& observation);

/// The scan of one observation's points: in the frame of the map, axes parallel to it, relative to
/// the sensor, points without a usable label left out and counted.
AdaptedScan makeScan(const SensorPoints& points, const Eigen::Isometry3d& robot_pose,
                     const LabelRules& rules, const BeamRequest& beams);

/// Gives points of ImageOrigin::Unknown their image, if one is wanted and can be found; else their
/// origin becomes None.
void searchForImage(const BeamRequest& beams, SensorPoints& points);

}  // namespace csom
