// SPDX-License-Identifier: BSD-3-Clause
// What a network said about images, kept as PNG files.
#pragma once

#include <csom/vision/SegmentationNetwork.h>

#include <memory>
#include <string>

namespace csom {

/// A folder of PNG files, one an image: the bytes of a ScoreImage (or of an index map), so that a
/// second run needs no network and makes the same map bit for bit. A file's name is a hash of the
/// image's pixels, of the model's bytes and of what the description says about input and output:
/// another image or another network never finds it, and a hash at its end tells whether it is what
/// was written for that image. Several processes can share a folder: each file is complete or
/// absent. Immutable, hence thread-safe.
class LabelCache {
 public:
  /// `folder` is created if missing. Throws FileError if it cannot be, or if the model cannot be
  /// read.
  LabelCache(std::string folder, const NetworkDescription& description);

  /// Null if the image is not in the cache, or its file is not what store() wrote for it (then
  /// it is made anew).
  std::shared_ptr<const SemanticImage> find(const cv::Mat& image, const RawToClass& class_of) const;
  /// Keeps what the network said about an image. Throws FileError.
  void store(const cv::Mat& image, const SemanticImage& labels) const;

 private:
  std::string keyOf(const cv::Mat& image) const;
  std::string fileOf(const std::string& key) const;

  std::string folder_;
  NetworkDescription description_;
  std::string network_hash_;
};

}  // namespace csom
