// SPDX-License-Identifier: BSD-3-Clause
// Images scaled, reordered and normalised.
#include "NetworkInput.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace csom::detail {
namespace {

/// The image at its size in the input, in gray or in BGR order.
cv::Mat scaledTo(cv::Size size, int channels, const cv::Mat& image) {
  cv::Mat converted = image;
  if (image.channels() != channels)
    cv::cvtColor(image, converted, channels == 1 ? cv::COLOR_BGR2GRAY : cv::COLOR_GRAY2BGR);
  cv::Mat scaled;
  // The exact kind has the same result on every processor.
  cv::resize(converted, scaled, size, 0, 0, cv::INTER_LINEAR_EXACT);
  return scaled;
}

}  // namespace

cv::Rect imageInInput(const NetworkDescription& network, cv::Size image) {
  if (network.resize == NetworkDescription::Resize::Stretch)
    return {0, 0, network.width, network.height};
  const double scale = std::min(static_cast<double>(network.width) / image.width,
                                static_cast<double>(network.height) / image.height);
  const auto scaled = [scale](int side, int limit) {
    return std::clamp(static_cast<int>(std::lround(side * scale)), 1, limit);
  };
  const int width = scaled(image.width, network.width);
  const int height = scaled(image.height, network.height);
  return {(network.width - width) / 2, (network.height - height) / 2, width, height};
}

NetworkInput::NetworkInput(const NetworkDescription& network)
    : network_(network),
      input_of_pixel_(network.channels == NetworkDescription::Channels::Gray ? 1 : 3) {
  for (std::size_t channel = 0; channel < input_of_pixel_.size(); ++channel) {
    for (int pixel = 0; pixel < 256; ++pixel)
      input_of_pixel_[channel][static_cast<std::size_t>(pixel)] = static_cast<float>(
          (pixel * network.scale - network.mean[channel]) / network.deviation[channel]);
  }
}

std::vector<int> NetworkInput::shape(int images) const {
  return {images, static_cast<int>(input_of_pixel_.size()), network_.height, network_.width};
}

cv::Mat NetworkInput::of(const std::vector<cv::Mat>& images) const {
  // What an image does not cover stays 0, the mean.
  cv::Mat input(shape(static_cast<int>(images.size())), CV_32FC1, cv::Scalar(0));
  for (std::size_t i = 0; i < images.size(); ++i)
    fill(images[i], input.ptr<float>(static_cast<int>(i)));
  return input;
}

void NetworkInput::fill(const cv::Mat& image, float* input) const {
  const std::size_t channels = input_of_pixel_.size();
  const cv::Rect covered = imageInInput(network_, image.size());
  const cv::Mat scaled = scaledTo(covered.size(), static_cast<int>(channels), image);
  const auto width = static_cast<std::size_t>(covered.width);
  for (std::size_t channel = 0; channel < channels; ++channel) {
    const bool reversed = network_.channels == NetworkDescription::Channels::Rgb;
    const std::size_t channel_in_pixel = reversed ? channels - 1 - channel : channel;
    const std::array<float, 256>& table = input_of_pixel_[channel];
    cv::Mat plane(network_.height, network_.width, CV_32FC1,
                  input + channel * static_cast<std::size_t>(network_.height * network_.width));
    for (int row = 0; row < covered.height; ++row) {
      const std::uint8_t* in = scaled.ptr(row) + channel_in_pixel;
      float* out = plane.ptr<float>(covered.y + row) + covered.x;
      for (std::size_t column = 0; column < width; ++column)
        out[column] = table[in[column * channels]];
    }
  }
}

}  // namespace csom::detail
