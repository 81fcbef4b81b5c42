// SPDX-License-Identifier: BSD-3-Clause
// Networks whose answers are known, read from real ONNX files.
#include <csom/vision/SegmentationNetwork.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>
#include <stdexcept>

#include "TestFiles.h"
#include "vision/TinyModel.h"

namespace csom::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using Head = TinyModel::Head;
using Channels = NetworkDescription::Channels;
using Output = NetworkDescription::Output;
using Resize = NetworkDescription::Resize;

ClassId sameNumber(std::uint32_t channel) {
  return static_cast<ClassId>(channel);
}

/// From red, green and blue: four channels.
TinyModel colorModel(cv::Size size) {
  TinyModel model;
  model.weights = {{3, 0, 0}, {0, 3, 1}, {-1, -1, 4}, {1, 1, -2}};
  model.biases = {0.5f, 0, 0, 0.75f};
  model.width = size.width;
  model.height = size.height;
  return model;
}

/// What colorModel() says about red, green and blue in 0 … 1.
std::array<double, 4> colorLogits(double red, double green, double blue) {
  return {3 * red + 0.5, 3 * green + blue, -red - green + 4 * blue, red + green - 2 * blue + 0.75};
}

class SegmentationNetworkTest : public testing::Test {
 protected:
  /// The description that fits the model, which is written to a file.
  NetworkDescription describe(const TinyModel& model, Output output = Output::Logits) const {
    NetworkDescription description;
    description.file = "tiny.yaml";
    description.model = folder_ / "tiny.onnx";
    writeBytes(description.model, model.onnx());
    description.width = model.width;
    description.height = model.height;
    description.batch = model.batch;
    description.output = output;
    description.output_channels =
        output == Output::Index ? 0 : static_cast<int>(model.weights.size());
    if (model.weights.front().size() == 1) description.channels = Channels::Gray;
    return description;
  }

  static std::shared_ptr<const SemanticImage> segmentOne(const NetworkDescription& description,
                                                         const cv::Mat& image) {
    return SegmentationNetwork(description).segment({image}, sameNumber).at(0);
  }

  static cv::Mat computeDistances(const SemanticImage& image) {
    return dynamic_cast<const ScoreImage&>(image).distances();
  }

  /// Every pixel's scores are the softmax of colorLogits() of its color, up to the quantisation.
  static void expectColorScores(const SemanticImage& labels, const cv::Mat& bgr,
                                double scale = 1.0 / 255) {
    std::vector<float> scores(4);
    for (int v = 0; v < bgr.rows; ++v) {
      for (int u = 0; u < bgr.cols; ++u) {
        const cv::Vec3b pixel = bgr.at<cv::Vec3b>(v, u);
        const auto logits = colorLogits(scale * pixel[2], scale * pixel[1], scale * pixel[0]);
        double sum = 0;
        for (const double logit : logits) sum += std::exp(logit);
        labels.scoresAt({u, v}, 1, scores);
        for (std::size_t k = 0; k < scores.size(); ++k)
          ASSERT_NEAR(scores[k], std::exp(logits[k]) / sum, 0.02) << u << ' ' << v << ' ' << k;
      }
    }
  }

  TempFolder folder_;
};

constexpr int kSide = 24;
const cv::Size kSize(kSide, 16);

TEST_F(SegmentationNetworkTest, LogitsOfRgbImages) {
  const cv::Mat image = randomImage(kSize, CV_8UC3, 1);
  const auto labels = segmentOne(describe(colorModel(kSize)), image);
  EXPECT_EQ(labels->size(), kSize);
  expectColorScores(*labels, image);
}

TEST_F(SegmentationNetworkTest, ImagesMayBePartsOfLargerOnes) {
  const cv::Mat large = randomImage({40, 30}, CV_8UC3, 2);
  const cv::Mat part = large(cv::Rect(5, 7, kSide, 16));
  expectColorScores(*segmentOne(describe(colorModel(kSize)), part), part);
}

TEST_F(SegmentationNetworkTest, ProbabilitiesSayWhatTheirLogitsSay) {
  const cv::Mat image = randomImage(kSize, CV_8UC3, 3);
  const cv::Mat from_logits = computeDistances(*segmentOne(describe(colorModel(kSize)), image));
  TinyModel model = colorModel(kSize);
  model.head = Head::Softmax;
  const auto labels = segmentOne(describe(model, Output::Probabilities), image);
  expectColorScores(*labels, image);
  EXPECT_LE(cv::norm(computeDistances(*labels), from_logits, cv::NORM_INF), 1);
}

TEST_F(SegmentationNetworkTest, IndexIsTheBestChannel) {
  const cv::Mat image = randomImage(kSize, CV_8UC3, 4);
  for (const Head head : {Head::ArgMax, Head::ArgMaxWithChannel}) {
    TinyModel model = colorModel(kSize);
    model.head = head;
    const auto labels = segmentOne(describe(model, Output::Index), image);
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        const cv::Vec3b pixel = image.at<cv::Vec3b>(v, u);
        const auto logits = colorLogits(pixel[2] / 255.0, pixel[1] / 255.0, pixel[0] / 255.0);
        const auto best = std::max_element(logits.begin(), logits.end()) - logits.begin();
        ASSERT_EQ(labels->classAt({u, v}).id, best) << u << ' ' << v;
      }
    }
  }
}

TEST_F(SegmentationNetworkTest, OutputIsChosenByItsName) {
  const cv::Mat image = randomImage(kSize, CV_8UC3, 11);
  TinyModel model = colorModel(kSize);
  model.head = Head::Softmax;
  model.second_output = true;
  NetworkDescription description = describe(model, Output::Probabilities);
  const std::string error = fileErrorOf([&] { SegmentationNetwork network(description); });
  EXPECT_THAT(error,
              AllOf(HasSubstr("'scores'"), HasSubstr("'other'"), HasSubstr("must name one")));
  description.output_name = "scores";
  expectColorScores(*segmentOne(description, image), image);
}

TEST_F(SegmentationNetworkTest, ChannelsMayBeInBgrOrder) {
  const cv::Mat image = randomImage(kSize, CV_8UC3, 5);
  TinyModel model = colorModel(kSize);
  for (auto& row : model.weights) std::reverse(row.begin(), row.end());
  NetworkDescription description = describe(model);
  description.channels = Channels::Bgr;
  expectColorScores(*segmentOne(description, image), image);
}

TEST_F(SegmentationNetworkTest, InputIsNormalised) {
  const cv::Mat image = randomImage(kSize, CV_8UC3, 6);
  // logit = w · x + b with x = x'·deviation + mean of the normalised x'.
  TinyModel model = colorModel(kSize);
  NetworkDescription normalised;
  normalised.mean = {0.25, 0.5, 0.125};
  normalised.deviation = {0.5, 0.25, 2};
  for (std::size_t k = 0; k < model.weights.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      model.biases[k] += model.weights[k][c] * static_cast<float>(normalised.mean[c]);
      model.weights[k][c] *= static_cast<float>(normalised.deviation[c]);
    }
  }
  NetworkDescription description = describe(model);
  description.scale = 1.0 / 100;
  description.mean = normalised.mean;
  description.deviation = normalised.deviation;
  expectColorScores(*segmentOne(description, image), image, 1.0 / 100);
}

TEST_F(SegmentationNetworkTest, GrayImagesFillAllChannels) {
  const cv::Mat gray = randomImage(kSize, CV_8UC1, 7);
  cv::Mat bgr;
  cv::merge(std::vector<cv::Mat>{gray, gray, gray}, bgr);
  expectColorScores(*segmentOne(describe(colorModel(kSize)), gray), bgr);
}

TEST_F(SegmentationNetworkTest, GrayNetworksTakeColorImages) {
  TinyModel model;
  model.weights = {{4}, {-4}};
  model.biases = {0, 3.5f};
  model.width = kSize.width;
  model.height = kSize.height;
  const auto labels =
      segmentOne(describe(model), cv::Mat(kSize, CV_8UC3, cv::Scalar(200, 50, 100)));
  const double gray = 0.114 * 200 + 0.587 * 50 + 0.299 * 100;
  const double logit = 8 * gray / 255 - 3.5;
  EXPECT_EQ(labels->classAt({3, 3}).id, 1);
  EXPECT_NEAR(labels->classAt({3, 3}).confidence, 1 / (1 + std::exp(logit)), 0.01);
}

// --- where a pixel's scores come from ------------------------------------------------------------

/// Brightness grows by 3 a pixel; class 1 wins above `threshold`.
struct Ramp {
  static constexpr double kThreshold = 90;

  static cv::Mat image(cv::Size size, bool down) {
    cv::Mat ramp(size, CV_8UC1);
    for (int v = 0; v < size.height; ++v) {
      for (int u = 0; u < size.width; ++u)
        ramp.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(3 * (down ? v : u) + 10);
    }
    return ramp;
  }
  static TinyModel model(cv::Size input, int cell) {
    TinyModel model;
    model.weights = {{-60}, {60}};
    model.biases = {static_cast<float>(120 * kThreshold / 255), 0};
    model.width = input.width;
    model.height = input.height;
    model.cell = cell;
    return model;
  }
  /// Where class 0 becomes class 1 in the middle of the image.
  static double border(const SemanticImage& labels, bool down) {
    double low = 0;
    double high = (down ? labels.size().height : labels.size().width) - 1;
    const double across = 0.5 * ((down ? labels.size().width : labels.size().height) - 1);
    while (high - low > 1e-3) {
      const double middle = (low + high) / 2;
      const Eigen::Vector2d pixel =
          down ? Eigen::Vector2d(across, middle) : Eigen::Vector2d(middle, across);
      (labels.classAt(pixel).id == 0 ? low : high) = middle;
    }
    return low;
  }
};

TEST_F(SegmentationNetworkTest, ScoresLieWhereTheirPixelsAre) {
  const cv::Size image(70, 40);
  const double expected = (Ramp::kThreshold - 10) / 3;
  for (const cv::Size input : {image, cv::Size(140, 80), cv::Size(100, 36), cv::Size(40, 40)}) {
    for (const int cell : {1, 2}) {
      for (const Resize resize : {Resize::Stretch, Resize::Letterbox}) {
        for (const bool down : {false, true}) {
          NetworkDescription description = describe(Ramp::model(input, cell));
          description.resize = resize;
          const auto labels = segmentOne(description, Ramp::image(image, down));
          // The ramp is rounded when it is scaled (1/6 of a pixel); scores are quantised.
          EXPECT_NEAR(Ramp::border(*labels, down), expected, 0.22)
              << input << " cell " << cell << (resize == Resize::Stretch ? "" : " letterbox")
              << (down ? " down" : "");
        }
      }
    }
  }
}

TEST_F(SegmentationNetworkTest, IndicesLieWhereTheirPixelsAre) {
  const cv::Size image(70, 40);
  const double expected = (Ramp::kThreshold - 10) / 3;
  for (const bool down : {false, true}) {
    TinyModel model = Ramp::model({140, 100}, 1);
    model.head = Head::ArgMax;
    NetworkDescription description = describe(model, Output::Index);
    description.resize = Resize::Letterbox;
    const auto labels = segmentOne(description, Ramp::image(image, down));
    // A label image has a class a pixel.
    EXPECT_NEAR(Ramp::border(*labels, down), expected, 0.51) << down;
  }
}

TEST_F(SegmentationNetworkTest, LetterboxIsFilledWithTheMean) {
  // A row of 4 pixels lies in row 1 of 4; cells of 2 × 2 average it with a row beside.
  TinyModel model;
  model.weights = {{0}, {8}};
  model.biases = {0, 0};
  model.cell = 2;
  model.width = 4;
  model.height = 4;
  NetworkDescription description = describe(model);
  description.resize = Resize::Letterbox;
  description.mean = {0.2, 0, 0};
  const auto labels = segmentOne(description, cv::Mat(1, 4, CV_8UC1, cv::Scalar(0.6 * 255)));
  const double logit = 8 * (0.6 - 0.2) / 2;
  const cv::Mat distances = computeDistances(*labels);
  ASSERT_EQ(distances.size(), cv::Size(2, 4));
  EXPECT_EQ(distances.at<std::uint8_t>(0, 0), std::lround(16 * logit));
  EXPECT_EQ(distances.at<std::uint8_t>(2, 0), 0);
  EXPECT_EQ(distances.at<std::uint8_t>(1, 0), 0);
  EXPECT_EQ(distances.at<std::uint8_t>(3, 0), 0);
}

// --- batches, threads ----------------------------------------------------------------------------

TEST_F(SegmentationNetworkTest, BatchesSayWhatSingleImagesSay) {
  std::vector<cv::Mat> images;
  for (unsigned i = 0; i < 5; ++i)
    images.push_back(randomImage({30 + static_cast<int>(i), 20}, CV_8UC3, i));
  TinyModel model = colorModel({32, 32});
  SegmentationNetwork alone(describe(model));
  model.batch = 2;
  SegmentationNetwork together(describe(model));
  const auto labels = together.segment(images, sameNumber);
  ASSERT_EQ(labels.size(), images.size());
  for (std::size_t i = 0; i < images.size(); ++i) {
    EXPECT_EQ(labels[i]->size(), images[i].size());
    const auto expected = alone.segment({images[i]}, sameNumber).at(0);
    EXPECT_EQ(cv::norm(computeDistances(*labels[i]), computeDistances(*expected), cv::NORM_INF), 0)
        << i;
  }
  EXPECT_TRUE(together.segment({}, sameNumber).empty());
}

TEST_F(SegmentationNetworkTest, ThreadsDoNotChangeTheScores) {
  const cv::Mat image = randomImage({300, 200}, CV_8UC3, 9);
  SegmentationNetwork network(describe(colorModel({256, 256})));
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const cv::Mat single = computeDistances(*network.segment({image}, sameNumber).at(0));
  cv::setNumThreads(2);
  const cv::Mat two = computeDistances(*network.segment({image}, sameNumber).at(0));
  cv::setNumThreads(threads);
  EXPECT_EQ(cv::norm(single, two, cv::NORM_INF), 0);
}

TEST_F(SegmentationNetworkTest, ChannelsBecomeClassesOfTheLabelSet) {
  const cv::Mat image = randomImage(kSize, CV_8UC3, 10);
  SegmentationNetwork network(describe(colorModel(kSize)));
  const auto channels = network.segment({image}, sameNumber).at(0);
  const auto classes =
      network
          .segment({image},
                   [](std::uint32_t channel) -> ClassId {
                     return channel == 2 ? kIgnoredPixel : static_cast<ClassId>(channel + 7);
                   })
          .at(0);
  const cv::Mat expected = channels->classes();
  const cv::Mat mapped = classes->classes();
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const ClassId channel = expected.at<ClassId>(v, u);
      ASSERT_EQ(mapped.at<ClassId>(v, u), channel == 2 ? kIgnoredPixel : channel + 7);
    }
  }
}

// --- what does not fit ---------------------------------------------------------------------------

class BadNetworks : public SegmentationNetworkTest {
 protected:
  /// One short line that begins with the model's name.
  static void expectError(const NetworkDescription& description, const std::string& reason) {
    const std::string error = fileErrorOf([&] {
      SegmentationNetwork network(description);
      network.segment({randomImage(kSize, CV_8UC3, 1)}, sameNumber);
    });
    EXPECT_THAT(error, AllOf(StartsWith(description.model + ": "), HasSubstr(reason),
                             Not(HasSubstr("\n"))));
    EXPECT_LT(error.size(), description.model.size() + 400) << error;
  }
};

TEST_F(BadNetworks, MissingOrDamagedFiles) {
  const TinyModel model = colorModel(kSize);
  const std::string bytes = model.onnx();
  NetworkDescription description = describe(model);
  description.model = folder_ / "missing.onnx";
  expectError(description, "no such file");
  description.model = folder_.path();
  expectError(description, "no such file");
  description.model = folder_ / "bad.onnx";
  for (const std::string& content :
       {std::string(), bytes.substr(0, bytes.size() / 2), std::string(1000, '\xff'),
        std::string("hello"), bytes.substr(bytes.size() / 2)}) {
    writeBytes(description.model, content);
    expectError(description, "");
  }
  description.model = folder_ / "model.txt";
  writeBytes(description.model, bytes);
  expectError(description, "no model that OpenCV can use");
  description = describe(model);
  description.config = folder_ / "missing.prototxt";
  EXPECT_THAT(fileErrorOf([&] { SegmentationNetwork network(description); }),
              StartsWith(description.config + ": no such file"));
}

TEST_F(BadNetworks, OtherInputs) {
  NetworkDescription description = describe(colorModel(kSize));
  description.channels = Channels::Gray;
  expectError(description, "does not take an input of 1 × 1 × 16 × 24");
}

TEST_F(BadNetworks, OtherOutputs) {
  TinyModel model = colorModel(kSize);
  NetworkDescription description = describe(model);
  description.output_channels = 19;
  expectError(description,
              "output 'scores' is 1 × 4 × 16 × 24, but 1 × 19 × height × width is expected");
  expectError(describe(model, Output::Index), "but 1 × height × width is expected");
  model.head = Head::ArgMax;
  expectError(describe(model), "but 1 × 4 × height × width is expected");
  description = describe(model);
  description.output_name = "labels";
  expectError(description, "has no output 'labels', but 'scores'");
}

TEST_F(BadNetworks, OtherValues) {
  expectError(describe(colorModel(kSize), Output::Probabilities), "no probability");
  TinyModel model = colorModel(kSize);
  model.weights.resize(1);
  model.biases = {0.25f};
  expectError(describe(model, Output::Index), "no channel number");
  model.weights = {{0, 0, 0}};
  model.biases = {70000};
  expectError(describe(model, Output::Index), "no channel number");
}

TEST_F(BadNetworks, OtherImages) {
  SegmentationNetwork network(describe(colorModel(kSize)));
  for (const int type : {CV_16UC1, CV_8UC4, CV_32FC3})
    EXPECT_THROW(network.segment({cv::Mat::zeros(kSize, type)}, sameNumber), std::invalid_argument);
  EXPECT_THROW(network.segment({cv::Mat()}, sameNumber), std::invalid_argument);
}

}  // namespace
}  // namespace csom::test
