// SPDX-License-Identifier: BSD-3-Clause
// Where the labels of points come from if the points do not carry them.
#include <csom/core/EnumWords.h>
#include <csom/core/Error.h>
#include <csom/maps/LabelOptions.h>

#include <algorithm>
#include <set>

namespace csom {

using detail::EnumWords;
using detail::parseWord;
using detail::wordOf;
using LabelMode = PointLabellingOptions::LabelMode;
using LowConfidence = PointLabellingOptions::LowConfidence;
using SeveralCameras = PointLabellingOptions::SeveralCameras;

namespace {

constexpr EnumWords<LabelSource::Kind, 4> kKinds{
    {{LabelSource::Kind::Network, "network"},
     {LabelSource::Kind::LabelImage, "label_image"},
     {LabelSource::Kind::PixelLabels, "pixel_labels"},
     {LabelSource::Kind::PointLabels, "point_labels"}}};
constexpr EnumWords<OutsideView, 2> kOutsideViews{
    {{OutsideView::Drop, "drop"}, {OutsideView::Unlabelled, "unlabelled"}}};
constexpr EnumWords<LabelMode, 2> kLabelModes{
    {{LabelMode::Hard, "hard"}, {LabelMode::Soft, "soft"}}};
constexpr EnumWords<LowConfidence, 2> kLowConfidences{
    {{LowConfidence::Drop, "drop"}, {LowConfidence::Soft, "soft"}}};
constexpr EnumWords<SeveralCameras, 2> kSeveralCameras{
    {{SeveralCameras::NearestToCentre, "nearest-to-centre"}, {SeveralCameras::Vote, "vote"}}};

void requireGiven(const std::string& key, const std::string& value, const LabelSource& source) {
  if (value.empty())
    throw ConfigError("source = " + toString(source.kind) +
                      " of sensor_label = " + source.sensor_label + " needs the key " + key);
}

void requireUnused(const std::string& key, const std::string& value, const LabelSource& source) {
  if (!value.empty())
    throw ConfigError(key + " = " + value +
                      " has no meaning with source = " + toString(source.kind));
}

void validate(const LabelSource& source) {
  if (source.sensor_label.empty()) throw ConfigError("sensor_label is missing");
  if (source.kind == LabelSource::Kind::Network) {
    requireGiven("network", source.network, source);
  } else {
    requireUnused("network", source.network, source);
    requireUnused("model", source.model, source);
  }
  if (source.kind == LabelSource::Kind::LabelImage)
    requireGiven("label_image", source.label_image, source);
  else
    requireUnused("label_image", source.label_image, source);
}

}  // namespace

bool LabelOptions::usesCameras() const {
  return std::any_of(sources.begin(), sources.end(),
                     [](const LabelSource& source) { return source.isCamera(); });
}

void LabelOptions::validate() const {
  points.validate();
  if (!(max_time_offset >= 0 && max_time_offset <= 3600))
    throw OptionError("max_time_offset = " + toString(max_time_offset) +
                      ": expected a number from 0 to 3600");
  std::set<std::string> sensors;
  std::set<std::string> label_images;
  for (const LabelSource& source : sources) {
    csom::validate(source);
    if (!sensors.insert(source.sensor_label).second)
      throw ConfigError("sensor_label = " + source.sensor_label + " has two label sources");
    if (!source.label_image.empty() && !label_images.insert(source.label_image).second)
      throw ConfigError("label_image = " + source.label_image + " serves two label sources");
  }
  for (const std::string& name : label_images) {
    if (sensors.count(name) != 0)
      throw ConfigError("label_image = " + name + " is the sensor_label of a label source too");
  }
}

std::string toString(LabelSource::Kind value) {
  return wordOf(kKinds, value);
}
std::string toString(OutsideView value) {
  return wordOf(kOutsideViews, value);
}
std::string toString(LabelMode value) {
  return wordOf(kLabelModes, value);
}
std::string toString(LowConfidence value) {
  return wordOf(kLowConfidences, value);
}
std::string toString(SeveralCameras value) {
  return wordOf(kSeveralCameras, value);
}
std::string toString(const std::string& value) {
  return value;
}

void parse(const std::string& key, const std::string& text, LabelSource::Kind& value) {
  parseWord(kKinds, key, text, value);
}
void parse(const std::string& key, const std::string& text, OutsideView& value) {
  parseWord(kOutsideViews, key, text, value);
}
void parse(const std::string& key, const std::string& text, LabelMode& value) {
  parseWord(kLabelModes, key, text, value);
}
void parse(const std::string& key, const std::string& text, LowConfidence& value) {
  parseWord(kLowConfidences, key, text, value);
}
void parse(const std::string& key, const std::string& text, SeveralCameras& value) {
  parseWord(kSeveralCameras, key, text, value);
}
void parse(const std::string& /*key*/, const std::string& text, std::string& value) {
  value = text;
}

}  // namespace csom
