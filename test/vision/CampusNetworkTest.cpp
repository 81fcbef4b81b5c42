// SPDX-License-Identifier: BSD-3-Clause
// config/networks/campus.onnx, as it is committed, on images of the drive that it never saw.
#include <csom/io/LabelSet.h>
#include <csom/rawlog/RawlogReader.h>
#include <csom/vision/SegmentationNetwork.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationImage.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace csom {
namespace {

using mrpt::obs::CObservationImage;

const std::string kSource = CSOM_SOURCE_DIR;

struct LabelledImage {
  cv::Mat image;
  cv::Mat ids;  ///< of the label set `simulator`, 0 where there is sky
};

/// Every `step`-th image of the campus drive.
std::vector<LabelledImage> campusImages(int step) {
  std::vector<LabelledImage> images;
  RawlogReader reader(kSource + "/rawlogs/campus.rawlog");
  int frames = 0;
  while (const auto entry = reader.next()) {
    LabelledImage found;
    for (const auto& observation : entry->observations) {
      const auto image = std::dynamic_pointer_cast<CObservationImage>(observation);
      if (image == nullptr) continue;
      const cv::Mat pixels = image->image.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY);
      (image->sensorLabel == "camera" ? found.image : found.ids) = pixels;
    }
    if (!found.image.empty() && frames++ % step == 0) images.push_back(found);
  }
  return images;
}

/// Channel → class, by the names in the description.
std::vector<ClassId> classesOf(const NetworkDescription& description, const LabelSet& labels) {
  std::vector<ClassId> classes;
  for (const std::string& name : description.classes)
    classes.push_back(name == "ignore" ? kIgnoredPixel : labels.classByName(name).value());
  return classes;
}

TEST(CampusNetworkTest, LabelsImagesItNeverSaw) {
  const LabelSet labels = LabelSet::load(kSource + "/config/labels/simulator.yaml");
  SegmentationNetwork network(NetworkDescription::load(kSource + "/config/networks/campus.yaml"));
  const std::vector<ClassId> classes = classesOf(network.description(), labels);
  const auto class_of = [&](std::uint32_t channel) { return classes.at(channel); };

  std::int64_t pixels = 0, right = 0, surface_pixels = 0, surface_right = 0;
  for (const LabelledImage& labelled : campusImages(8)) {
    const cv::Mat predicted = network.segment({labelled.image}, class_of).at(0)->classes();
    ASSERT_EQ(predicted.size(), labelled.ids.size());
    for (int v = 0; v < predicted.rows; ++v) {
      for (int u = 0; u < predicted.cols; ++u) {
        const bool sky = labelled.ids.at<std::uint8_t>(v, u) == kFreeClass;
        const ClassId truth = sky ? kIgnoredPixel : labelled.ids.at<std::uint8_t>(v, u);
        const bool is_right = predicted.at<ClassId>(v, u) == truth;
        ++pixels;
        right += is_right;
        surface_pixels += !sky;
        surface_right += is_right && !sky;
      }
    }
  }
  ASSERT_EQ(pixels, 9 * 320 * 240);
  // docs/networks.md has the figures of the whole drive.
  EXPECT_GE(static_cast<double>(right) / static_cast<double>(pixels), 0.98);
  EXPECT_GE(static_cast<double>(surface_right) / static_cast<double>(surface_pixels), 0.975);
}

TEST(CampusNetworkTest, ModelIsSmall) {
  EXPECT_LE(std::filesystem::file_size(kSource + "/config/networks/campus.onnx"), 200'000U);
}

}  // namespace
}  // namespace csom
