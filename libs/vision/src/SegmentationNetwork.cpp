// SPDX-License-Identifier: BSD-3-Clause
// Images into a network of cv::dnn, and what it says out of it.
#include <csom/core/Error.h>
#include <csom/vision/SegmentationNetwork.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/dnn.hpp>
#include <stdexcept>

#include "NetworkInput.h"
#include "NetworkOutput.h"

namespace csom {
namespace {

using Output = NetworkDescription::Output;
using Shape = std::vector<int>;

constexpr float kLargestIndex = 65535;

/// The reason of an OpenCV exception as one short line: it may be pages of source text.
std::string shortReason(const std::exception& error) {
  constexpr std::size_t kLongest = 160;
  const auto* of_opencv = dynamic_cast<const cv::Exception*>(&error);
  std::string reason = of_opencv != nullptr ? of_opencv->err : error.what();
  reason.erase(reason.find_last_not_of(" \n") + 1);
  std::replace_if(
      reason.begin(), reason.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
  if (reason.size() > kLongest) reason = reason.substr(0, kLongest) + "…";
  return reason;
}

std::string toText(const Shape& shape) {
  std::string text;
  for (const int size : shape) text += (text.empty() ? "" : " × ") + std::to_string(size);
  return text.empty() ? "nothing" : text;
}

cv::dnn::Net readModel(const NetworkDescription& description) {
  for (const std::string& file : {description.model, description.config}) {
    std::error_code error;
    if (!file.empty() && !std::filesystem::is_regular_file(file, error))
      throw FileError(file, "no such file; a model of a network is expected (" + description.file +
                                " describes it)");
  }
  try {
    return cv::dnn::readNet(description.model, description.config);
  } catch (const std::exception& error) {
    throw FileError(description.model,
                    "is damaged, or no model that OpenCV can use: " + shortReason(error));
  }
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

}  // namespace

/// The model, and what its output has to look like.
struct SegmentationNetwork::Network {
  explicit Network(const NetworkDescription& of) : description(of), input(of), net(readModel(of)) {
    // Other backends would take other ways to other last bits.
    net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    chooseOutput();
    // A model that does not fit is found here, not hours later at the first image.
    attempt(description.batch, [&] {
      std::vector<Shape> inputs;
      std::vector<Shape> outputs;
      net.getLayerShapes(input.shape(description.batch), net.getLayerId(output), inputs, outputs);
      checkOutput(outputs.empty() ? Shape() : outputs.front(), description.batch);
    });
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw FileError(description.model, reason + " (described by " + description.file + ")");
  }

  template <class Action>
  void attempt(int images, Action&& action) const {
    try {
      action();
    } catch (const cv::Exception& error) {
      fail("does not take an input of " + toText(input.shape(images)) + ": " + shortReason(error));
    }
  }

  void chooseOutput() {
    const std::vector<std::string> names = net.getUnconnectedOutLayersNames();
    output = description.output_name;
    if (output.empty() && names.size() == 1) output = names.front();
    if (output.empty())
      fail("has the outputs " + joined(names) + "; the description must name one (output: name)");
    if (net.getLayerId(output) < 0) fail("has no output '" + output + "', but " + joined(names));
  }

  void checkOutput(const Shape& shape, int images) const {
    const bool index = description.output == Output::Index;
    const int channels = index ? 1 : description.output_channels;
    const bool plain_index = index && shape.size() == 3 && shape[0] == images;
    const bool in_channels = shape.size() == 4 && shape[0] == images && shape[1] == channels;
    const bool some = std::all_of(shape.begin(), shape.end(), [](int size) { return size > 0; });
    if (some && (plain_index || in_channels)) return;
    fail("output '" + output + "' is " + toText(shape) + ", but " + std::to_string(images) + " × " +
         (index ? "" : std::to_string(channels) + " × ") + "height × width is expected");
  }

  /// What the network says about images: 32-bit numbers in the shape of the output.
  cv::Mat run(const std::vector<cv::Mat>& images) {
    const int count = static_cast<int>(images.size());
    cv::Mat result;
    attempt(count, [&] {
      net.setInput(input.of(images));
      net.forward(output).convertTo(result, CV_32F);
    });
    checkOutput(Shape(result.size.p, result.size.p + result.dims), count);
    return result;
  }

  /// The share of one image in the output, as detail::semanticImage() wants it.
  cv::Mat storedForm(cv::Mat& result, int image, cv::Size size) const {
    const int rows = result.size[result.dims - 2];
    const int columns = result.size[result.dims - 1];
    float* values = result.ptr<float>(image);
    if (description.output == Output::Index) {
      const cv::Mat grid(rows, columns, CV_32FC1, values);
      checkIndex(grid);
      return detail::indexImage(description, grid, size);
    }
    const Shape shape{description.output_channels, rows, columns};
    cv::Mat scores(shape, CV_32FC1, values);
    if (description.output == Output::Probabilities) takeLogarithms(scores);
    return ScoreImage::computeDistances(scores);
  }

  void checkIndex(const cv::Mat& grid) const {
    for (const float value : cv::Mat_<float>(grid)) {
      if (!(value >= 0 && value <= kLargestIndex && value == std::floor(value)))
        fail("output '" + output + "' has the value " + std::to_string(value) +
             ": no channel number, so its layout is not index");
    }
  }

  void takeLogarithms(cv::Mat& scores) const {
    // Room for the rounding of a softmax.
    constexpr float kLargest = 1.001f;
    for (float& value : cv::Mat_<float>(scores.reshape(1, 1))) {
      if (value < 0 || value > kLargest)
        fail("output '" + output + "' has the value " + std::to_string(value) +
             ": no probability, so its layout is not probabilities");
      value = std::log(value);
    }
  }

  const NetworkDescription& description;
  detail::NetworkInput input;
  cv::dnn::Net net;
  std::string output;
};

SegmentationNetwork::SegmentationNetwork(NetworkDescription description)
    : description_(std::move(description)), network_(std::make_unique<Network>(description_)) {}

SegmentationNetwork::~SegmentationNetwork() = default;

std::vector<std::shared_ptr<const SemanticImage>> SegmentationNetwork::segment(
    const std::vector<cv::Mat>& images, const RawToClass& class_of) {
  for (const cv::Mat& image : images) {
    if (image.empty() || image.dims != 2 || (image.type() != CV_8UC1 && image.type() != CV_8UC3))
      throw std::invalid_argument("a network needs images with 8 bits a channel, gray or BGR");
  }
  std::vector<std::shared_ptr<const SemanticImage>> labels;
  const auto batch = static_cast<std::size_t>(description_.batch);
  for (std::size_t first = 0; first < images.size(); first += batch) {
    const auto begin = images.begin() + static_cast<std::ptrdiff_t>(first);
    const auto count = static_cast<std::ptrdiff_t>(std::min(batch, images.size() - first));
    const std::vector<cv::Mat> together(begin, begin + count);
    cv::Mat result = network_->run(together);
    for (std::size_t i = 0; i < together.size(); ++i) {
      const cv::Size size = together[i].size();
      const cv::Mat stored = network_->storedForm(result, static_cast<int>(i), size);
      labels.push_back(detail::semanticImage(description_, stored, size, class_of));
    }
  }
  return labels;
}

}  // namespace csom
