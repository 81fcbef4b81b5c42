// SPDX-License-Identifier: BSD-3-Clause
// Files beside a log that its observations refer to.
#include "ExternalFiles.h"

#include <mrpt/io/lazy_load_path.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationStereoImages.h>

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

}  // namespace

std::vector<std::string> externalFilesOf(const mrpt::obs::CObservation& observation) {
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

}  // namespace csom::detail
