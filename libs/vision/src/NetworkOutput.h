// SPDX-License-Identifier: BSD-3-Clause
// What a network's output says about an image, be it fresh or from a cache.
#pragma once

#include <csom/vision/SegmentationNetwork.h>

#include <memory>

namespace csom::detail {

/// Where a grid that covers the whole input lies in the image.
GridPlacement placementOf(const NetworkDescription& network, cv::Size image, cv::Size grid);

/// Channel numbers (CV_32F, whole and in 0 … 65535) at the size of the image: CV_16UC1, each from
/// the nearest cell of the grid.
cv::Mat indexImage(const NetworkDescription& network, const cv::Mat& grid, cv::Size image);

/// The semantic image that `stored` stands for: distances as ScoreImage has them, or the image of
/// channel numbers if the network's output is an index. Throws std::invalid_argument if it does not
/// fit to the network and the size of the image.
std::shared_ptr<const SemanticImage> semanticImage(const NetworkDescription& network,
                                                   const cv::Mat& stored, cv::Size image,
                                                   const RawToClass& class_of);

/// The inverse. Throws std::invalid_argument if `labels` is no such image.
cv::Mat storedForm(const SemanticImage& labels);

}  // namespace csom::detail
