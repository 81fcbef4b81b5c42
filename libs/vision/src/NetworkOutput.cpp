// SPDX-License-Identifier: BSD-3-Clause
// Grids of a network over the pixels of an image.
#include "NetworkOutput.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "NetworkInput.h"

namespace csom::detail {

GridPlacement placementOf(const NetworkDescription& network, cv::Size image, cv::Size grid) {
  const cv::Rect covered = imageInInput(network, image);
  // Pixels are areas: the left edge of the first one is the left edge of the first cell.
  const auto axis = [](int covered_from, int covered_size, int image_size, int input_size,
                       int grid_size, double& scale, double& offset) {
    const double input_from_image = static_cast<double>(covered_size) / image_size;
    const double grid_from_input = static_cast<double>(grid_size) / input_size;
    scale = input_from_image * grid_from_input;
    offset = (0.5 * input_from_image + covered_from) * grid_from_input - 0.5;
  };
  GridPlacement placement;
  axis(covered.x, covered.width, image.width, network.width, grid.width, placement.scale_x,
       placement.offset_x);
  axis(covered.y, covered.height, image.height, network.height, grid.height, placement.scale_y,
       placement.offset_y);
  return placement;
}

cv::Mat indexImage(const NetworkDescription& network, const cv::Mat& grid, cv::Size image) {
  const GridPlacement placement = placementOf(network, image, grid.size());
  const auto nearest = [](double coordinate, int cells) {
    return static_cast<int>(std::clamp(std::floor(coordinate + 0.5), 0.0, cells - 1.0));
  };
  std::vector<int> columns;
  columns.reserve(static_cast<std::size_t>(image.width));
  for (int u = 0; u < image.width; ++u)
    columns.push_back(nearest(u * placement.scale_x + placement.offset_x, grid.cols));
  cv::Mat index(image, CV_16UC1);
  for (int v = 0; v < image.height; ++v) {
    const float* in =
        grid.ptr<float>(nearest(v * placement.scale_y + placement.offset_y, grid.rows));
    std::uint16_t* out = index.ptr<std::uint16_t>(v);
    for (const int column : columns) *out++ = static_cast<std::uint16_t>(in[column]);
  }
  return index;
}

std::shared_ptr<const SemanticImage> semanticImage(const NetworkDescription& network,
                                                   const cv::Mat& stored, cv::Size image,
                                                   const RawToClass& class_of) {
  if (network.output == NetworkDescription::Output::Index) {
    if (stored.size() != image)
      throw std::invalid_argument("channel numbers and their image differ in size");
    return std::make_shared<LabelImage>(stored, class_of);
  }
  std::vector<ClassId> class_of_channel;
  class_of_channel.reserve(static_cast<std::size_t>(network.output_channels));
  for (int channel = 0; channel < network.output_channels; ++channel)
    class_of_channel.push_back(class_of(static_cast<std::uint32_t>(channel)));
  const cv::Size grid(stored.cols, stored.rows / std::max(1, network.output_channels));
  return std::make_shared<ScoreImage>(stored, std::move(class_of_channel), image,
                                      placementOf(network, image, grid));
}

cv::Mat storedForm(const SemanticImage& labels) {
  if (const auto* scores = dynamic_cast<const ScoreImage*>(&labels)) return scores->distances();
  if (const auto* index = dynamic_cast<const LabelImage*>(&labels)) return index->raw();
  throw std::invalid_argument("only what a network said about an image can be stored");
}

}  // namespace csom::detail
