// SPDX-License-Identifier: BSD-3-Clause
// Images through a network, or through the cache of what it said before.
#pragma once

#include <csom/io/LabelSet.h>
#include <csom/maps/LabelOptions.h>
#include <csom/vision/LabelCache.h>
#include <csom/vision/SegmentationNetwork.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace csom {

struct LabelledImages {
  std::vector<std::shared_ptr<const SemanticImage>> images;
  std::vector<bool> from_cache;  ///< one an image
  double network_seconds = 0;    ///< the network alone
  std::string cache_fault;       ///< why they could not be kept in the cache; empty: they were
};

/// The class that a raw id stands for in images. Free is no class that something seen can have.
RawToClass rawToClass(const LabelSet& labels);

/// One network, shared by all cameras that use it. The model is loaded at the first image that is
/// not in the cache. Thread-safe, as copies of a map share it; one image at a time.
class ImageLabeller {
 public:
  /// Throws ConfigError or FileError if the description is wrong, the model missing, a class not in
  /// `labels`, or the cache cannot be used.
  ImageLabeller(const LabelSource& source, const std::string& label_cache, const LabelSet& labels);

  /// Loads the model now. Throws FileError.
  void loadNetwork();
  /// One result an image, in order. A cache that cannot be written to is given up: what the network
  /// says is as right without it. Throws FileError if the network cannot be used.
  LabelledImages label(const std::vector<cv::Mat>& images);

 private:
  void loadLocked();
  void keep(const cv::Mat& image, const SemanticImage& labels, LabelledImages& labelled);

  std::mutex mutex_;
  NetworkDescription description_;
  RawToClass class_of_;
  std::optional<LabelCache> cache_;
  std::optional<SegmentationNetwork> network_;
};

}  // namespace csom
