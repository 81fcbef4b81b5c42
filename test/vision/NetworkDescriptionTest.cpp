// SPDX-License-Identifier: BSD-3-Clause
// The YAML file that describes a network: what it says, and what is wrong with it.
#include <csom/core/Error.h>
#include <csom/vision/SegmentationNetwork.h>

#include <tuple>

#include "TestFiles.h"

namespace csom::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class NetworkDescriptionFile : public testing::Test {
 protected:
  NetworkDescription load(const std::string& yaml, const std::string& model = "") const {
    writeBytes(file_, yaml);
    return NetworkDescription::load(file_, model);
  }

  /// The message for a file, without its name.
  std::string errorOf(const std::string& yaml) const {
    try {
      load(yaml);
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), StartsWith(file_ + ":"));
      return std::string(error.what()).substr(file_.size() + 1);
    }
    ADD_FAILURE() << "no ConfigError for:\n" << yaml;
    return "";
  }

  TempFolder folder_;
  std::string file_ = folder_ / "network.yaml";
};

constexpr const char* kShort =
    "model: net.onnx\n"
    "input: {width: 64, height: 32}\n"
    "output: {layout: logits, channels: 5}\n";

TEST_F(NetworkDescriptionFile, HasDefaults) {
  const NetworkDescription network = load(kShort);
  EXPECT_EQ(network.file, file_);
  EXPECT_EQ(network.model, folder_ / "net.onnx");
  EXPECT_EQ(network.config, "");
  EXPECT_EQ(network.width, 64);
  EXPECT_EQ(network.height, 32);
  EXPECT_EQ(network.resize, NetworkDescription::Resize::Stretch);
  EXPECT_EQ(network.channels, NetworkDescription::Channels::Rgb);
  EXPECT_EQ(network.scale, 1.0 / 255);
  EXPECT_THAT(network.mean, ElementsAre(0, 0, 0));
  EXPECT_THAT(network.deviation, ElementsAre(1, 1, 1));
  EXPECT_EQ(network.batch, 1);
  EXPECT_EQ(network.output_name, "");
  EXPECT_EQ(network.output, NetworkDescription::Output::Logits);
  EXPECT_EQ(network.output_channels, 5);
  EXPECT_TRUE(network.classes.empty());
}

TEST_F(NetworkDescriptionFile, SaysEverything) {
  const NetworkDescription network = load(
      "model: /models/net.caffemodel\n"
      "config: sub/net.prototxt\n"
      "input:\n"
      "  width: 640\n"
      "  height: 480\n"
      "  resize: letterbox\n"
      "  channels: bgr\n"
      "  scale: 1\n"
      "  mean: [104, 117.5, 123]\n"
      "  deviation: [57, 58, 59]\n"
      "  batch: 4\n"
      "output: {name: score, layout: probabilities}\n"
      "classes: [road, ignore, road, wall]\n");
  EXPECT_EQ(network.model, "/models/net.caffemodel");
  EXPECT_EQ(network.config, folder_ / "sub/net.prototxt");
  EXPECT_EQ(network.width, 640);
  EXPECT_EQ(network.height, 480);
  EXPECT_EQ(network.resize, NetworkDescription::Resize::Letterbox);
  EXPECT_EQ(network.channels, NetworkDescription::Channels::Bgr);
  EXPECT_EQ(network.scale, 1);
  EXPECT_THAT(network.mean, ElementsAre(104, 117.5, 123));
  EXPECT_THAT(network.deviation, ElementsAre(57, 58, 59));
  EXPECT_EQ(network.batch, 4);
  EXPECT_EQ(network.output_name, "score");
  EXPECT_EQ(network.output, NetworkDescription::Output::Probabilities);
  EXPECT_EQ(network.output_channels, 4);
  EXPECT_THAT(network.classes, ElementsAre("road", "ignore", "road", "wall"));
}

TEST_F(NetworkDescriptionFile, GrayInputHasOneChannel) {
  const NetworkDescription network = load(
      "model: n\n"
      "input: {width: 4, height: 2, channels: gray, mean: [0.5], deviation: [0.25]}\n"
      "output: {layout: index}\n");
  EXPECT_EQ(network.channels, NetworkDescription::Channels::Gray);
  EXPECT_EQ(network.mean[0], 0.5);
  EXPECT_EQ(network.deviation[0], 0.25);
  EXPECT_EQ(network.output, NetworkDescription::Output::Index);
  EXPECT_EQ(network.output_channels, 0);
}

TEST_F(NetworkDescriptionFile, ModelCanBeNamedFromOutside) {
  EXPECT_EQ(load(kShort, "elsewhere/net.onnx").model, "elsewhere/net.onnx");
  const std::string without_model =
      "input: {width: 64, height: 32}\noutput: {layout: logits, channels: 5}\n";
  EXPECT_EQ(load(without_model, "net.onnx").model, "net.onnx");
  EXPECT_THAT(errorOf(without_model), StartsWith("1: the description of a network has no 'model'"));
}

TEST_F(NetworkDescriptionFile, ErrorsNameTheLineAndTheValue) {
  // Replaces one line of a file that is right, and expects the message.
  const std::vector<std::string> lines{"model: net.onnx",
                                       "input:",
                                       "  width: 64",
                                       "  height: 32",
                                       "  resize: stretch",
                                       "  channels: rgb",
                                       "  scale: 1",
                                       "  mean: [0, 0, 0]",
                                       "  deviation: [1, 1, 1]",
                                       "  batch: 1",
                                       "output:",
                                       "  name: out",
                                       "  layout: logits",
                                       "  channels: 2",
                                       "classes: [road, wall]"};
  const std::vector<std::tuple<std::size_t, std::string, std::string>> cases{
      {1, "model: [a]", "1: model must be a text"},
      {1, "model: \"\"", "1: model must be a text"},
      {1, "modell: a", "1: the description of a network has no 'model'"},
      {3, "  breadth: 64", "3: input has no 'width'"},
      {3, "  width: 0", "3: width must be a whole number from 1 to 16384, not '0'"},
      {3, "  width: 64.5", "3: width must be a whole number from 1 to 16384, not '64.5'"},
      {3, "  width: 99999", "3: width must be a whole number from 1 to 16384, not '99999'"},
      {4, "  height: -1", "4: height must be a whole number from 1 to 16384, not '-1'"},
      {4, "  height: [2]", "4: height must be a whole number from 1 to 16384"},
      {5, "  resize: crop", "5: resize = 'crop': must be one of stretch, letterbox"},
      {6, "  channels: 3", "6: channels = '3': must be one of rgb, bgr, gray"},
      {7, "  scale: 0", "7: scale must be a number above 0, not '0'"},
      {7, "  scale: 1/255", "7: scale must be a number above 0, not '1/255'"},
      {7, "  scale: .inf", "7: scale must be a number above 0, not '.inf'"},
      {8, "  mean: [0, 0]", "8: mean must be a list of 3 numbers"},
      {8, "  mean: 0.5", "8: mean must be a list of 3 numbers"},
      {8, "  mean: [0, x, 0]", "8: mean must be a number, not 'x'"},
      {9, "  deviation: [1, 0, 1]", "9: deviation must be a number above 0, not '0'"},
      {10, "  batch: 1000", "10: batch must be a whole number from 1 to 256, not '1000'"},
      {10, "  batsch: 1", "10: unknown key 'batsch' in input"},
      {10, "  width: 64", "10: key 'width' stands twice in input"},
      {12, "  nam: out", "12: unknown key 'nam' in output"},
      {13, "  layout: softmax",
       "13: layout = 'softmax': must be one of logits, probabilities, index"},
      {13, "", "12: output has no 'layout'"},
      {13, "  layout: index", "14: channels: an index has none"},
      {14, "  channels: 3", "14: channels = 3, but classes names 2"},
      {15, "classes: road", "15: classes must be a list of class names"},
      {15, "classes: []", "15: classes must be a list of class names"},
      {15, "classes: [road, [wall]]", "15: each of classes must be a text"},
      {15, "colors: 1", "15: unknown key 'colors' in the description of a network"},
      {15, "input: {}", "15: key 'input' stands twice"},
      {15, "classes: [road", "no valid YAML"},
  };
  for (const auto& [line, text, message] : cases) {
    std::string yaml;
    for (std::size_t i = 0; i < lines.size(); ++i) yaml += (i + 1 == line ? text : lines[i]) + "\n";
    EXPECT_THAT(errorOf(yaml), HasSubstr(message)) << text;
  }
}

TEST_F(NetworkDescriptionFile, NeedsTheNumberOfChannelsIfNoClassesAreNamed) {
  EXPECT_THAT(errorOf("model: n\ninput: {width: 4, height: 2}\noutput: {layout: logits}\n"),
              StartsWith("3: output has no 'channels'"));
}

TEST_F(NetworkDescriptionFile, OtherFilesAreRefused) {
  EXPECT_THAT(errorOf(""), HasSubstr("cannot be read, or is empty"));
  EXPECT_THAT(errorOf("just words"), StartsWith("1: the description of a network must be a map"));
  EXPECT_THAT(errorOf("model: n\ninput: 5\n"), StartsWith("2: input must be a map"));
  EXPECT_THROW(NetworkDescription::load(folder_ / "missing.yaml"), ConfigError);
  EXPECT_THROW(NetworkDescription::load(folder_.path()), ConfigError);
}

TEST(NetworkDescriptions, OfTheProjectAreValid) {
  const std::string folder = CSOM_SOURCE_DIR "/config/networks/";
  const NetworkDescription network = NetworkDescription::load(folder + "espnetv2-cityscapes.yaml");
  EXPECT_EQ(network.model, folder + "espnetv2_s2.0_cityscapes_1280x320.onnx");
  EXPECT_EQ(network.scale, 1.0 / 255);
  EXPECT_EQ(network.output_channels, 20);
}

}  // namespace
}  // namespace csom::test
