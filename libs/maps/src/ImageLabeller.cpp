// SPDX-License-Identifier: BSD-3-Clause
// Images through a network, or through the cache of what it said before.
#include "ImageLabeller.h"

#include <csom/core/Error.h>

#include <chrono>
#include <filesystem>

namespace csom {
namespace {

constexpr char kIgnore[] = "ignore";

ClassId classNamed(const std::string& name, const NetworkDescription& description,
                   const LabelSet& labels) {
  if (name == kIgnore) return kIgnoredPixel;
  const std::optional<ClassId> id = labels.classByName(name);
  if (!id || *id == kFreeClass)
    throw ConfigError(description.file + ": class '" + name + "' is no class of label set '" +
                      labels.name() + "' that a pixel can have; use its names, or '" + kIgnore +
                      "'");
  return *id;
}

RawToClass channelToClass(const NetworkDescription& description, const LabelSet& labels) {
  if (description.classes.empty()) return rawToClass(labels);
  std::vector<ClassId> classes;
  for (const std::string& name : description.classes)
    classes.push_back(classNamed(name, description, labels));
  return [classes](std::uint32_t channel) {
    return channel < classes.size() ? classes[channel] : kUnknownPixel;
  };
}

}  // namespace

RawToClass rawToClass(const LabelSet& labels) {
  return [labels](std::uint32_t raw) {
    const LabelSet::Raw found = labels.classOfRaw(raw);
    switch (found.kind) {
      case LabelSet::RawKind::Class:
        return found.id == kFreeClass ? kIgnoredPixel : found.id;
      case LabelSet::RawKind::Ignored:
        return kIgnoredPixel;
      case LabelSet::RawKind::Unknown:
        break;
    }
    return kUnknownPixel;
  };
}

ImageLabeller::ImageLabeller(const LabelSource& source, const std::string& label_cache,
                             const LabelSet& labels)
    : description_(NetworkDescription::load(source.network, source.model)),
      class_of_(channelToClass(description_, labels)) {
  if (!std::filesystem::is_regular_file(description_.model))
    throw FileError(description_.model, "no such file; it is the model of " + description_.file);
  if (!label_cache.empty()) cache_.emplace(label_cache, description_);
}

void ImageLabeller::loadNetwork() {
  const std::lock_guard<std::mutex> lock(mutex_);
  loadLocked();
}

void ImageLabeller::loadLocked() {
  if (!network_) network_.emplace(description_);
}

LabelledImages ImageLabeller::label(const std::vector<cv::Mat>& images) {
  const std::lock_guard<std::mutex> lock(mutex_);
  LabelledImages labelled;
  std::vector<cv::Mat> missing;
  std::vector<std::size_t> places;
  for (const cv::Mat& image : images) {
    labelled.images.push_back(cache_ ? cache_->find(image, class_of_) : nullptr);
    labelled.from_cache.push_back(labelled.images.back() != nullptr);
    if (labelled.images.back()) continue;
    missing.push_back(image);
    places.push_back(labelled.images.size() - 1);
  }
  if (missing.empty()) return labelled;
  loadLocked();
  const auto start = std::chrono::steady_clock::now();
  const auto segmented = network_->segment(missing, class_of_);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  labelled.network_seconds = elapsed.count();
  for (std::size_t i = 0; i < missing.size(); ++i) {
    labelled.images[places[i]] = segmented[i];
    keep(missing[i], *segmented[i], labelled);
  }
  return labelled;
}

void ImageLabeller::keep(const cv::Mat& image, const SemanticImage& labels,
                         LabelledImages& labelled) {
  if (!cache_) return;
  try {
    cache_->store(image, labels);
  } catch (const FileError& error) {
    labelled.cache_fault = error.what();
    cache_.reset();
  }
}

}  // namespace csom
