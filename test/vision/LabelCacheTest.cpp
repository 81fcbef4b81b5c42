// SPDX-License-Identifier: BSD-3-Clause
// What a network said, found again as it was, or not at all.
#include <csom/vision/LabelCache.h>

#include <array>
#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <thread>

#include "TestFiles.h"
#include "vision/TinyModel.h"

namespace csom::test {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::SizeIs;

ClassId classOf(std::uint32_t channel) {
  return channel == 1 ? kIgnoredPixel : static_cast<ClassId>(channel + 2);
}

void expectSameBits(const SemanticImage& a, const SemanticImage& b) {
  ASSERT_EQ(a.size(), b.size());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> across(-0.5, a.size().width - 0.5);
  std::uniform_real_distribution<double> down(-0.5, a.size().height - 0.5);
  std::vector<float> scores_a(8);
  std::vector<float> scores_b(8);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d pixel(across(random), down(random));
    const PixelClass best_a = a.scoresAt(pixel, 1.5, scores_a);
    const PixelClass best_b = b.scoresAt(pixel, 1.5, scores_b);
    ASSERT_EQ(best_a.id, best_b.id);
    ASSERT_EQ(best_a.confidence, best_b.confidence);
    ASSERT_EQ(scores_a, scores_b);
  }
  EXPECT_EQ(cv::norm(a.classes(), b.classes(), cv::NORM_INF), 0);
}

class LabelCacheTest : public testing::Test {
 protected:
  LabelCacheTest() {
    model_.weights = {{3, 0, 0}, {0, 3, 1}, {-1, -1, 4}};
    model_.biases = {0.5f, 0, 0.25f};
    model_.cell = 2;
    model_.width = 48;
    model_.height = 32;
    network_.file = "tiny.yaml";
    network_.model = folder_ / "tiny.onnx";
    writeBytes(network_.model, model_.onnx());
    network_.width = model_.width;
    network_.height = model_.height;
    network_.resize = NetworkDescription::Resize::Letterbox;
    network_.output_channels = 3;
  }

  std::shared_ptr<const SemanticImage> segment(const cv::Mat& image) const {
    return SegmentationNetwork(network_).segment({image}, classOf).at(0);
  }

  std::vector<std::string> cached() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(cache_folder_))
      names.push_back(entry.path().string());
    return names;
  }

  TempFolder folder_;
  const std::string cache_folder_ = folder_ / "new/cache";
  TinyModel model_;
  NetworkDescription network_;
  const cv::Mat image_ = randomImage({50, 30}, CV_8UC3, 1);
};

TEST_F(LabelCacheTest, FindsTheSameBits) {
  const LabelCache cache(cache_folder_, network_);
  EXPECT_EQ(cache.find(image_, classOf), nullptr);
  const auto labels = segment(image_);
  cache.store(image_, *labels);
  const auto found = cache.find(image_, classOf);
  ASSERT_NE(found, nullptr);
  expectSameBits(*labels, *found);
  // Another run.
  const auto found_later = LabelCache(cache_folder_, network_).find(image_, classOf);
  ASSERT_NE(found_later, nullptr);
  expectSameBits(*labels, *found_later);
  EXPECT_THAT(cached(), ElementsAre(EndsWith(".png")));
}

TEST_F(LabelCacheTest, FindsTheSameIndices) {
  model_.head = TinyModel::Head::ArgMax;
  writeBytes(network_.model, model_.onnx());
  network_.output = NetworkDescription::Output::Index;
  network_.output_channels = 0;
  const LabelCache cache(cache_folder_, network_);
  const auto labels = segment(image_);
  cache.store(image_, *labels);
  const auto found = cache.find(image_, classOf);
  ASSERT_NE(found, nullptr);
  expectSameBits(*labels, *found);
}

TEST_F(LabelCacheTest, KeepsChannelsRatherThanClasses) {
  const LabelCache cache(cache_folder_, network_);
  cache.store(image_, *segment(image_));
  const auto other_class = [](std::uint32_t) -> ClassId { return 5; };
  const auto found = cache.find(image_, other_class);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->classAt({3, 3}).id, 5);
}

TEST_F(LabelCacheTest, AFileUnderTheNameOfAnotherIsNotBelieved) {
  const LabelCache cache(cache_folder_, network_);
  cache.store(image_, *segment(image_));
  const cv::Mat other = randomImage({50, 30}, CV_8UC3, 2);
  cache.store(other, *segment(other));
  const auto files = cached();
  ASSERT_EQ(files.size(), 2U);
  std::filesystem::copy_file(files[0], files[1], std::filesystem::copy_options::overwrite_existing);
  const bool first = cache.find(image_, classOf) != nullptr;
  const bool second = cache.find(other, classOf) != nullptr;
  EXPECT_NE(first, second);
}

TEST_F(LabelCacheTest, PicturesAreNotMistakenForEachOther) {
  const LabelCache cache(cache_folder_, network_);
  cache.store(image_, *segment(image_));
  cv::Mat changed = image_.clone();
  changed.at<cv::Vec3b>(29, 49)[2] ^= 1;
  EXPECT_EQ(cache.find(changed, classOf), nullptr);
  EXPECT_EQ(cache.find(image_.reshape(3, 50), classOf), nullptr);
  EXPECT_EQ(cache.find(image_.reshape(1), classOf), nullptr);
  EXPECT_EQ(cache.find(image_(cv::Rect(0, 0, 50, 29)), classOf), nullptr);
  // Only pixels count, not how they lie in memory.
  cv::Mat frame(40, 70, CV_8UC3, cv::Scalar(7, 7, 7));
  const cv::Mat inside = frame(cv::Rect(5, 5, 50, 30));
  image_.copyTo(inside);
  EXPECT_NE(cache.find(inside, classOf), nullptr);
}

TEST_F(LabelCacheTest, NetworksAreNotMistakenForEachOther) {
  using Network = NetworkDescription;
  LabelCache(cache_folder_, network_).store(image_, *segment(image_));
  const std::vector<std::function<void(Network&)>> changes{
      [](Network& n) { n.width = 64; },
      [](Network& n) { n.height = 64; },
      [](Network& n) { n.resize = Network::Resize::Stretch; },
      [](Network& n) { n.channels = Network::Channels::Bgr; },
      [](Network& n) { n.scale = 1; },
      [](Network& n) { n.mean[2] = 0.5; },
      [](Network& n) { n.deviation[0] = 0.5; },
      [](Network& n) { n.output_name = "scores"; },
      [](Network& n) { n.output = Network::Output::Probabilities; },
      [](Network& n) { n.output_channels = 4; },
      [](Network& n) { n.config = n.model; }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Network other = network_;
    changes[i](other);
    EXPECT_EQ(LabelCache(cache_folder_, other).find(image_, classOf), nullptr) << i;
  }
  Network same = network_;
  same.file = "other.yaml";
  same.batch = 7;
  same.classes = {"a", "b", "c"};
  same.model = folder_ / "copy.onnx";
  writeBytes(same.model, model_.onnx());
  EXPECT_NE(LabelCache(cache_folder_, same).find(image_, classOf), nullptr);
  model_.biases[0] = 0.75f;
  writeBytes(same.model, model_.onnx());
  EXPECT_EQ(LabelCache(cache_folder_, same).find(image_, classOf), nullptr);
}

TEST_F(LabelCacheTest, DamagedFilesAreMadeAnew) {
  const LabelCache cache(cache_folder_, network_);
  const auto labels = segment(image_);
  cache.store(image_, *labels);
  const std::string file = cached().at(0);
  const std::string bytes = readBytes(file);
  std::vector<std::string> contents{"", "no picture", bytes.substr(8)};
  for (std::size_t size = 1; size < bytes.size(); size += 37)
    contents.push_back(bytes.substr(0, size));
  // Pictures of another kind, or of another size.
  for (const cv::Mat& other :
       {cv::Mat(48, 24, CV_8UC3, cv::Scalar(1, 2, 3)), cv::Mat(48, 24, CV_16UC1, cv::Scalar(1)),
        cv::Mat(47, 24, CV_8UC1, cv::Scalar(1))}) {
    std::vector<std::uint8_t> png;
    cv::imencode(".png", other, png);
    contents.emplace_back(png.begin(), png.end());
  }
  for (const std::string& content : contents) {
    writeBytes(file, content);
    EXPECT_EQ(cache.find(image_, classOf), nullptr) << content.size() << " bytes";
  }
  cache.store(image_, *labels);
  ASSERT_NE(cache.find(image_, classOf), nullptr);
  expectSameBits(*cache.find(image_, classOf), *labels);
}

TEST_F(LabelCacheTest, AFileWithAFlippedBitIsNotBelieved) {
  const LabelCache cache(cache_folder_, network_);
  cache.store(image_, *segment(image_));
  const std::string file = cached().at(0);
  const std::string bytes = readBytes(file);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string flipped = bytes;
    flipped[i] = static_cast<char>(flipped[i] ^ (1 << (i % 8)));
    writeBytes(file, flipped);
    ASSERT_EQ(cache.find(image_, classOf), nullptr) << "byte " << i;
  }
}

TEST_F(LabelCacheTest, ThreadsSeeCompleteFilesOrNone) {
  const LabelCache cache(cache_folder_, network_);
  const auto labels = segment(image_);
  const cv::Mat expected = dynamic_cast<const ScoreImage&>(*labels).distances();
  cache.store(image_, *labels);
  std::array<int, 4> good{};
  std::vector<std::thread> threads;
  for (int& count : good) {
    threads.emplace_back([&] {
      for (int i = 0; i < 100; ++i) {
        cache.store(image_, *labels);
        const auto found = cache.find(image_, classOf);
        if (found && cv::norm(dynamic_cast<const ScoreImage&>(*found).distances(), expected,
                              cv::NORM_INF) == 0)
          ++count;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(good, ElementsAre(100, 100, 100, 100));
  EXPECT_THAT(cached(), SizeIs(1));
}

TEST_F(LabelCacheTest, FailuresNameTheFile) {
  writeBytes(folder_ / "file", "x");
  EXPECT_THAT(fileErrorOf([&] { LabelCache(folder_ / "file", network_); }),
              HasSubstr(folder_ / "file"));
  EXPECT_THAT(fileErrorOf([&] { LabelCache(folder_ / "file/sub", network_); }),
              HasSubstr(folder_ / "file/sub"));
  const LabelCache cache(cache_folder_, network_);
  const auto labels = segment(image_);
  std::filesystem::remove_all(cache_folder_);
  EXPECT_THAT(fileErrorOf([&] { cache.store(image_, *labels); }), HasSubstr(cache_folder_));
  network_.model = folder_ / "missing.onnx";
  EXPECT_THAT(fileErrorOf([&] { LabelCache(cache_folder_, network_); }),
              HasSubstr(network_.model + ": cannot be read"));
}

}  // namespace
}  // namespace csom::test
