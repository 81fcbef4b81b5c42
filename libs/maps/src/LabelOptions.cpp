// SPDX-License-Identifier: BSD-3-Clause
// Where the labels of points come from if the points do not carry them.
#include <csom/core/Error.h>
#include <csom/maps/LabelOptions.h>

#include <algorithm>
#include <set>

namespace csom {

namespace {

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
  requireInRanges([&](auto&& visitor) { visit(*this, visitor); });
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

}  // namespace csom
