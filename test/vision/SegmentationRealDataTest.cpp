// SPDX-License-Identifier: BSD-3-Clause
// A real network on a real image of the folder $CSOM_DATA: a street with a traffic jam.
#include <csom/io/LabelSet.h>
#include <csom/vision/LabelCache.h>

#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "TestFiles.h"

namespace csom::test {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

class StreetImage : public testing::Test {
 protected:
  void SetUp() override {
    const char* data = std::getenv("CSOM_DATA");
    ASSERT_NE(data, nullptr) << "set CSOM_DATA to the folder with the data sets";
    const std::string folder = data;
    description_ =
        NetworkDescription::load(CSOM_SOURCE_DIR "/config/networks/espnetv2-cityscapes.yaml",
                                 folder + "/models/espnetv2_s2.0_cityscapes_1280x320.onnx");
    image_ = cv::imread(folder + "/kitti_2011_09_26/image_02/data/0000000000.png");
    ASSERT_FALSE(image_.empty());
  }

  RawToClass classOf() const {
    return [this](std::uint32_t channel) -> ClassId {
      const LabelSet::Raw raw = labels_.classOfRaw(channel);
      if (raw.kind == LabelSet::RawKind::Class) return raw.id;
      return raw.kind == LabelSet::RawKind::Ignored ? kIgnoredPixel : kUnknownPixel;
    };
  }

  std::string nameAt(const SemanticImage& image, double u, double v) const {
    const PixelClass best = image.classAt({u, v});
    if (best.id == kIgnoredPixel) return "ignored";
    return best.id == kUnknownPixel ? "unknown" : labels_.classes().at(best.id).name;
  }

  static cv::Mat computeDistances(const SemanticImage& image) {
    return dynamic_cast<const ScoreImage&>(image).distances();
  }

  LabelSet labels_ = LabelSet::load(CSOM_SOURCE_DIR "/config/labels/cityscapes.yaml");
  NetworkDescription description_;
  cv::Mat image_;
};

TEST_F(StreetImage, IsSegmentedAsAPersonWould) {
  const auto labels = SegmentationNetwork(description_).segment({image_}, classOf()).at(0);
  ASSERT_EQ(labels->size(), image_.size());
  for (const auto& [u, v] : {std::pair{470, 300}, {630, 335}, {760, 350}, {740, 240}})
    EXPECT_EQ(nameAt(*labels, u, v), "road") << u << ' ' << v;
  for (const auto& [u, v] : {std::pair{300, 60}, {640, 20}, {880, 15}})
    EXPECT_EQ(nameAt(*labels, u, v), "ignored") << u << ' ' << v;
  for (const auto& [u, v] : {std::pair{50, 30}, {300, 150}, {530, 130}, {615, 115}})
    EXPECT_EQ(nameAt(*labels, u, v), "vegetation") << u << ' ' << v;
  for (const auto& [u, v] : {std::pair{200, 260}, {630, 220}, {630, 280}, {712, 195}})
    EXPECT_EQ(nameAt(*labels, u, v), "car") << u << ' ' << v;
  for (const auto& [u, v] : {std::pair{420, 180}, {880, 100}, {900, 180}})
    EXPECT_THAT(nameAt(*labels, u, v), AnyOf("car", "truck", "bus", "train")) << u << ' ' << v;
  // The left edge of the roof of the car in front: labels are where the pixels are.
  EXPECT_EQ(nameAt(*labels, 572, 215), "car");
  EXPECT_EQ(nameAt(*labels, 545, 215), "road");
}

TEST_F(StreetImage, HasTheSameScoresWithAnyNumberOfThreadsAndFromTheCache) {
  SegmentationNetwork network(description_);
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const auto single = network.segment({image_}, classOf()).at(0);
  cv::setNumThreads(2);
  const auto two = network.segment({image_}, classOf()).at(0);
  cv::setNumThreads(threads);
  EXPECT_EQ(cv::norm(computeDistances(*single), computeDistances(*two), cv::NORM_INF), 0);

  const TempFolder folder;
  const LabelCache cache(folder.path(), description_);
  cache.store(image_, *single);
  const auto found = cache.find(image_, classOf());
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(cv::norm(computeDistances(*single), computeDistances(*found), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(single->classes(), found->classes(), cv::NORM_INF), 0);
}

TEST_F(StreetImage, ModelForOneImageRefusesBatches) {
  description_.batch = 2;
  EXPECT_THAT(fileErrorOf([&] { SegmentationNetwork network(description_); }),
              HasSubstr("does not take an input of 2 × 3 × 320 × 1280"));
}

}  // namespace
}  // namespace csom::test
