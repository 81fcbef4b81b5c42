// SPDX-License-Identifier: BSD-3-Clause
// Where the labels of points come from if the points do not carry them: cameras.
#pragma once

#include <csom/vision/PointLabelling.h>

#include <string>
#include <vector>

namespace csom {

/// Where the labels of one sensor come from.
struct LabelSource {
  enum class Kind {
    Network,      ///< the images of a camera go through a segmentation network
    LabelImage,   ///< images of raw ids have a sensor label of their own
    PixelLabels,  ///< a range camera's CObservation3DRangeScan::pixelLabels
    PointLabels   ///< the points of this sensor carry their labels, see TInsertionOptions
  };
  std::string sensor_label;  ///< of the camera, or of the sensor that labels itself
  Kind kind = Kind::Network;
  std::string network;      ///< Network: file of the description
  std::string model;        ///< Network: the model, if not the one that the description names
  std::string label_image;  ///< LabelImage: sensor label of the images of raw ids

  bool isCamera() const { return kind == Kind::Network || kind == Kind::LabelImage; }
};

std::string toString(LabelSource::Kind value);
void parse(const std::string& key, const std::string& text, LabelSource::Kind& value);

/// What becomes of points that no camera sees: left out, as in the paper, or kept as occupied
/// without a label.
enum class OutsideView { Drop, Unlabelled };

struct LabelOptions {
  std::vector<LabelSource> sources;
  PointLabellingOptions points;
  double max_time_offset = 0.1;  ///< between a scan and the images that label it [s]
  OutsideView outside_view = OutsideView::Drop;
  std::string label_cache;  ///< folder for what networks said; empty: none

  bool usesCameras() const;
  /// Throws OptionError or ConfigError that names the key.
  void validate() const;
};

/// Calls `visitor(key, field, unit, help)` for every field but the sources.
template <class LabelOptionsLike, class Visitor>
void visitLabelOptions(LabelOptionsLike& o, Visitor&& visitor) {
  visitor("label_mode", o.points.label_mode, "", "hard | soft");
  visitor("temperature", o.points.temperature, "", "soft: of the softmax, above 1 is less sure");
  visitor("min_confidence", o.points.min_confidence, "", "of a point's best class, 0 to 1");
  visitor("low_confidence", o.points.low_confidence, "", "points below it: drop | soft");
  visitor("max_time_offset", o.max_time_offset, "s", "between a scan and its images");
  visitor("outside_view", o.outside_view, "", "points that no camera sees: drop | unlabelled");
  visitor("visibility", o.points.visibility, "", "reject points that the camera does not see");
  visitor("visibility_margin", o.points.visibility_margin, "m", "nearer by less does not hide");
  visitor("edge_margin", o.points.edge_margin, "px", "rejected around borders with a depth jump");
  visitor("several_cameras", o.points.several_cameras, "", "nearest-to-centre | vote");
  visitor("label_cache", o.label_cache, "", "folder for what networks said, empty = none");
}

/// Visits the fields of one source.
template <class LabelSourceLike, class Visitor>
void visitLabelSource(LabelSourceLike& source, Visitor&& visitor) {
  visitor("sensor_label", source.sensor_label);
  visitor("source", source.kind);
  visitor("network", source.network);
  visitor("model", source.model);
  visitor("label_image", source.label_image);
}

/// Words as in ini files; texts are values of themselves. Parsing throws OptionError.
std::string toString(PointLabellingOptions::LabelMode value);
std::string toString(PointLabellingOptions::SeveralCameras value);
std::string toString(PointLabellingOptions::LowConfidence value);
std::string toString(OutsideView value);
std::string toString(const std::string& value);
void parse(const std::string& key, const std::string& text,
           PointLabellingOptions::LabelMode& value);
void parse(const std::string& key, const std::string& text,
           PointLabellingOptions::SeveralCameras& value);
void parse(const std::string& key, const std::string& text,
           PointLabellingOptions::LowConfidence& value);
void parse(const std::string& key, const std::string& text, OutsideView& value);
void parse(const std::string& key, const std::string& text, std::string& value);

}  // namespace csom
