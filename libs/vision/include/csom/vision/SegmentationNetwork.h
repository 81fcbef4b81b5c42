// SPDX-License-Identifier: BSD-3-Clause
// A neural network that labels the pixels of an image.
#pragma once

#include <csom/vision/SemanticImage.h>

#include <array>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace csom {

/// What must be known of a model to use it: the YAML file beside the model (docs/camera.md).
struct NetworkDescription {
  enum class Resize {
    Stretch,   ///< the image is scaled to the input, its aspect ratio may change
    Letterbox  ///< scaled with its aspect ratio and centred; the rest is filled with the mean
  };
  enum class Channels { Rgb, Bgr, Gray };
  enum class Output {
    Logits,         ///< N × K × H × W, any real numbers
    Probabilities,  ///< N × K × H × W, in [0, 1]
    Index           ///< N × H × W or N × 1 × H × W, the channel number itself
  };

  std::string file;    ///< of the description
  std::string model;   ///< path of the model
  std::string config;  ///< second file of Caffe and TensorFlow models; may be empty
  int width = 0;       ///< of the input
  int height = 0;
  Resize resize = Resize::Stretch;
  Channels channels = Channels::Rgb;
  /// input = (pixel · scale − mean) / deviation, a value a channel in the network's order.
  double scale = 1.0 / 255;
  std::array<double, 3> mean{0, 0, 0};
  std::array<double, 3> deviation{1, 1, 1};
  int batch = 1;            ///< most images of one run; 1 for models with a fixed batch
  std::string output_name;  ///< empty: the only output
  Output output = Output::Logits;
  int output_channels = 0;  ///< K; 0 if the output is an index
  /// Class names of the label set by channel (`ignore`: none); empty: channel numbers are raw ids
  /// of the label set.
  std::vector<std::string> classes;

  /// Throws ConfigError "FILE:LINE: …" for what is wrong with the file. `model` replaces the model
  /// that the file names, unless empty. Relative paths in the file are relative to the file.
  /// config/networks/espnetv2-cityscapes.yaml explains every key.
  static NetworkDescription load(const std::string& file, const std::string& model = "");
};

/// A network loaded by cv::dnn. Runs on the processor with OpenCV's threads. Not thread-safe.
class SegmentationNetwork {
 public:
  /// Throws FileError if the model cannot be read, is damaged, does not take the described input,
  /// or does not have the described output.
  explicit SegmentationNetwork(NetworkDescription description);
  ~SegmentationNetwork();

  const NetworkDescription& description() const { return description_; }

  /// Scores for each image (CV_8UC3 in BGR order, or CV_8UC1), up to description().batch of them in
  /// one run. `class_of` maps channel numbers. Throws FileError naming the model if its values are
  /// not those of the described layout, std::invalid_argument for other images.
  std::vector<std::shared_ptr<const SemanticImage>> segment(const std::vector<cv::Mat>& images,
                                                            const RawToClass& class_of);

 private:
  struct Network;
  NetworkDescription description_;
  std::unique_ptr<Network> network_;
};

}  // namespace csom
