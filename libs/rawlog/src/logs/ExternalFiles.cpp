// SPDX-License-Identifier: BSD-3-Clause
// Files beside a log that its observations refer to.
#include "logs/ExternalFiles.h"

#include <mrpt/io/lazy_load_path.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationStereoImages.h>

#include <algorithm>
#include <exception>
#include <filesystem>

namespace csom::detail {
namespace {

void addImage(std::vector<std::string>& files, const mrpt::img::CImage& image) {
  if (image.isExternallyStored())
    files.push_back(mrpt::io::lazy_load_absolute_path(image.getExternalStorageFile()));
}

void addRangeScan(std::vector<std::string>& files, const mrpt::obs::CObservation3DRangeScan& scan) {
  if (scan.points3D_isExternallyStored())
    files.push_back(scan.points3D_getExternalStorageFileAbsolutePath());
  if (scan.rangeImage_isExternallyStored())
    files.push_back(scan.rangeImage_getExternalStorageFileAbsolutePath(""));
  if (scan.hasIntensityImage) addImage(files, scan.intensityImage);
  if (scan.hasConfidenceImage) addImage(files, scan.confidenceImage);
}

/// All images of an observation that may be externalised.
std::vector<mrpt::img::CImage*> imagesOf(mrpt::obs::CObservation& observation) {
  if (auto* mono = dynamic_cast<mrpt::obs::CObservationImage*>(&observation)) return {&mono->image};
  if (auto* pair = dynamic_cast<mrpt::obs::CObservationStereoImages*>(&observation))
    return {&pair->imageLeft, &pair->imageRight, &pair->imageDisparity};
  if (auto* scan = dynamic_cast<mrpt::obs::CObservation3DRangeScan*>(&observation))
    return {&scan->intensityImage, &scan->confidenceImage};
  return {};
}

}  // namespace

std::vector<std::string> listExternalFiles(const mrpt::obs::CObservation& observation) {
  std::vector<std::string> files;
  if (const auto* image = dynamic_cast<const mrpt::obs::CObservationImage*>(&observation)) {
    addImage(files, image->image);
  } else if (const auto* pair =
                 dynamic_cast<const mrpt::obs::CObservationStereoImages*>(&observation)) {
    addImage(files, pair->imageLeft);
    if (pair->hasImageRight) addImage(files, pair->imageRight);
    if (pair->hasImageDisparity) addImage(files, pair->imageDisparity);
  } else if (const auto* scan =
                 dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation)) {
    addRangeScan(files, *scan);
  } else if (const auto* cloud =
                 dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&observation)) {
    if (cloud->isExternallyStored())
      files.push_back(mrpt::io::lazy_load_absolute_path(cloud->getExternalStorageFile()));
  }
  return files;
}

void loadImages(mrpt::obs::CObservation& observation) {
  for (const mrpt::img::CImage* image : imagesOf(observation)) {
    try {
      if (image->isExternallyStored()) image->forceLoad();
    } catch (const std::exception&) {
      // Tried again, and reported, where the image is needed.
    }
  }
}

mrpt::obs::CObservation::Ptr withAbsoluteImagePaths(
    const mrpt::obs::CObservation::Ptr& observation) {
  const auto in_file = [](const mrpt::img::CImage* image) { return image->isExternallyStored(); };
  const std::vector<mrpt::img::CImage*> images = imagesOf(*observation);
  if (std::none_of(images.begin(), images.end(), in_file)) return observation;
  const auto copy =
      std::dynamic_pointer_cast<mrpt::obs::CObservation>(observation->duplicateGetSmartPtr());
  for (mrpt::img::CImage* image : imagesOf(*copy)) {
    if (!image->isExternallyStored()) continue;
    const std::string file = mrpt::io::lazy_load_absolute_path(image->getExternalStorageFile());
    image->setExternalStorage(std::filesystem::absolute(file).lexically_normal().string());
    image->unload();
  }
  return copy;
}

}  // namespace csom::detail
