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

/// What becomes of points that no camera sees, or that show nothing with a class: left out, as in
/// the paper, or kept as occupied without a label, so that what stands beside the robot is in the
/// map.
enum class OutsideView { Drop, Unlabelled };

struct LabelOptions {
  std::vector<LabelSource> sources;
  PointLabellingOptions points;
  double max_time_offset = 0.1;  ///< between a scan and the images that label it [s]
  OutsideView outside_view = OutsideView::Unlabelled;
  std::string label_cache;  ///< folder for what networks said; empty: none

  bool usesCameras() const;
  /// Throws OptionError or ConfigError that names the key.
  void validate() const;
};

/// Calls `visitor(key, field, unit, help)` for every field but the sources.
template <class LabelOptionsLike, class Visitor>
void visitLabelOptions(LabelOptionsLike& o, Visitor&& visitor) {
  visitor("label_mode", o.points.label_mode, "",
          "a point takes the best class (hard), or the distribution over the classes (soft)");
  visitor("temperature", o.points.temperature, "",
          "of the softmax; above 1 is less sure of the best class");
  visitor("min_confidence", o.points.min_confidence, "",
          "points whose best class is less sure are treated as low_confidence says, 0 to 1");
  visitor("low_confidence", o.points.low_confidence, "",
          "such points are left out (drop) or keep their distribution (soft)");
  visitor("max_time_offset", o.max_time_offset, "s", "between a scan and the images that label it");
  visitor(
      "outside_view", o.outside_view, "",
      "points that no camera sees, or not properly, become occupied by a class `unlabelled`, which "
      "is added to the label set and which any label outvotes (unlabelled), or are left out "
      "(drop), as in the paper");
  visitor("visibility", o.points.visibility, "",
          "points that something nearer hides from the camera are rejected");
  visitor("visibility_margin", o.points.visibility_margin, "m",
          "what is nearer by less does not hide");
  visitor("edge_margin", o.points.edge_margin, "pixels",
          "points so near to a label border are rejected if the depth jumps there; 0 keeps them");
  visitor("several_cameras", o.points.several_cameras, "",
          "of several cameras that see a point the one counts in whose image it is nearest to the "
          "centre (nearest-to-centre), or all (vote)");
  visitor("label_cache", o.label_cache, "",
          "folder in which what networks said is kept for the next run; without it none");
}

/// Calls `visitor(key, field, help)` for every field of one source.
template <class LabelSourceLike, class Visitor>
void visitLabelSource(LabelSourceLike& source, Visitor&& visitor) {
  visitor("sensor_label", source.sensor_label,
          "of the camera's images; of the sensor that labels itself");
  visitor("source", source.kind,
          "network: the images go through a segmentation network; label_image: images of raw ids "
          "come with a sensor label of their own; pixel_labels: a CObservation3DRangeScan with "
          "labels of its pixels; point_labels: the points of this sensor carry their labels");
  visitor("network", source.network,
          "network: its description, a path relative to the ini file or to the working folder");
  visitor("model", source.model, "network: the model, if it is not where the description says");
  visitor("label_image", source.label_image,
          "label_image: sensor label of the images of raw ids (8 or 16 bits, gray)");
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
