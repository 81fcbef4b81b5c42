// SPDX-License-Identifier: BSD-3-Clause
// An image of raw ids becomes an image of classes.
#include <csom/vision/SemanticImage.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace csom {
namespace {

constexpr ClassId kNotAsked = 0xfffd;

/// Asks `class_of` once for each raw id that occurs: a label set looks it up in a tree.
template <class Raw>
cv::Mat classesOf(const cv::Mat& raw, const RawToClass& class_of) {
  std::vector<ClassId> table(std::size_t{1} << (8 * sizeof(Raw)), kNotAsked);
  cv::Mat classes(raw.size(), CV_16UC1);
  for (int row = 0; row < raw.rows; ++row) {
    const Raw* in = raw.ptr<Raw>(row);
    ClassId* out = classes.ptr<ClassId>(row);
    for (int column = 0; column < raw.cols; ++column) {
      ClassId& id = table[in[column]];
      if (id == kNotAsked) id = class_of(in[column]);
      out[column] = id;
    }
  }
  return classes;
}

int nearest(double coordinate, int size) {
  return static_cast<int>(std::clamp(std::floor(coordinate + 0.5), 0.0, size - 1.0));
}

}  // namespace

LabelImage::LabelImage(const cv::Mat& raw, const RawToClass& class_of) {
  if (raw.empty()) throw std::invalid_argument("an image of class ids is empty");
  if (raw.dims != 2 || (raw.type() != CV_8UC1 && raw.type() != CV_16UC1))
    throw std::invalid_argument(
        "an image of class ids must be gray with 8 or 16 bits a pixel, not " +
        cv::typeToString(raw.type()));
  // A copy: the caller may go on to use the memory of its image.
  raw_ = raw.clone();
  classes_ = raw.depth() == CV_8U ? classesOf<std::uint8_t>(raw_, class_of)
                                  : classesOf<std::uint16_t>(raw_, class_of);
}

PixelClass LabelImage::classAt(const Eigen::Vector2d& pixel) const {
  const ClassId id =
      classes_.at<ClassId>(nearest(pixel.y(), classes_.rows), nearest(pixel.x(), classes_.cols));
  if (id == kIgnoredPixel || id == kUnknownPixel) return {id, 0};
  return {id, 1};
}

PixelClass LabelImage::scoresAt(const Eigen::Vector2d& pixel, double /*temperature*/,
                                std::vector<float>& scores) const {
  const PixelClass best = classAt(pixel);
  std::fill(scores.begin(), scores.end(), 0.0f);
  if (best.confidence > 0) scores.at(best.id) = 1;
  return best;
}

}  // namespace csom
