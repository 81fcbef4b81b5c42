// SPDX-License-Identifier: BSD-3-Clause
// Where the labels of points come from if the points do not carry them: cameras.
#pragma once

#include <csom/core/EnumWords.h>
#include <csom/core/OptionInfo.h>
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

  template <class Self, class Visitor>
  static void visit(Self& o, Visitor&& visitor) {
    visitor(
        OptionInfo{"sensor_label", "", "of the camera's images; of the sensor that labels itself"},
        o.sensor_label);
    visitor(
        OptionInfo{
            "source", "",
            "network: the images go through a segmentation network; label_image: images of raw ids "
            "come with a sensor label of their own; pixel_labels: a CObservation3DRangeScan with "
            "labels of its pixels; point_labels: the points of this sensor carry their labels"},
        o.kind);
    visitor(
        OptionInfo{
            "network", "",
            "network: its description, a path relative to the ini file or to the working folder"},
        o.network);
    visitor(OptionInfo{"model", "", "network: the model, if it is not where the description says"},
            o.model);
    visitor(OptionInfo{"label_image", "",
                       "label_image: sensor label of the images of raw ids (8 or 16 bits, gray)"},
            o.label_image);
  }
};

template <>
inline constexpr EnumWords<LabelSource::Kind, 4> kWords<LabelSource::Kind>{
    {{LabelSource::Kind::Network, "network"},
     {LabelSource::Kind::LabelImage, "label_image"},
     {LabelSource::Kind::PixelLabels, "pixel_labels"},
     {LabelSource::Kind::PointLabels, "point_labels"}}};

/// What becomes of points that no camera sees, or that show nothing with a class: left out, as in
/// the paper, or kept as occupied without a label, so that what stands beside the robot is in the
/// map.
enum class OutsideView { Drop, Unlabelled };
template <>
inline constexpr EnumWords<OutsideView, 2> kWords<OutsideView>{
    {{OutsideView::Drop, "drop"}, {OutsideView::Unlabelled, "unlabelled"}}};

struct LabelOptions {
  std::vector<LabelSource> sources;
  PointLabellingOptions points;
  double max_time_offset = 0.1;  ///< between a scan and the images that label it [s]
  OutsideView outside_view = OutsideView::Unlabelled;
  std::string label_cache;  ///< folder for what networks said; empty: none

  bool usesCameras() const;
  /// Throws OptionError or ConfigError that names the key.
  void validate() const;

  /// Visits every field but the sources.
  template <class Self, class Visitor>
  static void visit(Self& o, Visitor&& visitor) {
    PointLabellingOptions::visit(o.points, visitor);
    visitor(
        OptionInfo{
            "max_time_offset", "s", "between a scan and the images that label it", {0, 3600}},
        o.max_time_offset);
    visitor(
        OptionInfo{
            "outside_view", "",
            "points that no camera sees, or not properly, become occupied by a class `unlabelled`, "
            "which "
            "is added to the label set and which any label outvotes (unlabelled), or are left out "
            "(drop), as in the paper"},
        o.outside_view);
    visitor(
        OptionInfo{"label_cache", "",
                   "folder in which what networks said is kept for the next run; without it none"},
        o.label_cache);
  }
};

/// Texts are values of themselves.
inline std::string toString(const std::string& value) {
  return value;
}
inline void parse(const std::string& /*key*/, const std::string& text, std::string& value) {
  value = text;
}

}  // namespace csom
