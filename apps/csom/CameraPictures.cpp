// SPDX-License-Identifier: BSD-3-Clause
// What cameras saw at the beginning, in the middle and at the end of a run, for its report.
#include "CameraPictures.h"

#include <csom/vision/Overlay.h>

#include <opencv2/core.hpp>

namespace csom {
namespace {

ClassColors colorsOf(const LabelSet& labels) {
  ClassColors colors;
  for (const LabelClass& c : labels.classes()) colors.push_back(c.color);
  return colors;
}

}  // namespace

std::vector<CameraPicture> cameraPictures(const LabelledScan& scan, CameraPicture::Moment moment,
                                          const LabelSet& labels) {
  const ClassColors colors = colorsOf(labels);
  std::vector<CameraPicture> pictures;
  for (std::size_t i = 0; i < scan.views.size(); ++i) {
    const LabelledScan::View& seen = scan.views[i];
    // Where only ids are known there is nothing to see behind the colours.
    const cv::Mat photo =
        seen.photo.empty() ? cv::Mat(seen.labels->size(), CV_8UC1, cv::Scalar(128)) : seen.photo;
    const CameraView view{seen.projection.get(), seen.camera_from_points, seen.labels.get()};
    CameraPicture picture;
    picture.moment = moment;
    picture.sensor_label = seen.sensor_label;
    picture.timestamp = seen.timestamp;
    picture.frame = seen.number;
    picture.segmentation = encodeJpeg(drawSegmentation(photo, *seen.labels, colors));
    picture.points = encodeJpeg(
        drawLabelledPoints(photo, view, static_cast<int>(i), scan.points, scan.labelled, colors));
    picture.classes = classesShown(*seen.labels);
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

}  // namespace csom
