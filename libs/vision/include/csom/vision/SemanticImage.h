// SPDX-License-Identifier: BSD-3-Clause
// What an image says about the classes of its pixels.
#pragma once

#include <csom/core/types.h>

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace csom {

/// In images of classes (CV_16UC1): a pixel without a class of the label set.
constexpr ClassId kIgnoredPixel = 0xffff;  ///< the label set ignores what is there
constexpr ClassId kUnknownPixel = 0xfffe;  ///< the label set does not know it

/// The class that a raw id or an output channel stands for; kIgnoredPixel or kUnknownPixel if none.
using RawToClass = std::function<ClassId(std::uint32_t raw)>;

/// The best class at a pixel and how sure it is, in [0, 1]. `id` may be kIgnoredPixel or
/// kUnknownPixel, then `confidence` is 0.
struct PixelClass {
  ClassId id = kUnknownPixel;
  float confidence = 0;
};

/// Classes, or scores of classes, over one camera image. Pixels are those of the camera image,
/// whatever the resolution of the classes. Immutable, hence thread-safe.
class SemanticImage {
 public:
  virtual ~SemanticImage() = default;
  /// Of the camera image.
  virtual cv::Size size() const = 0;
  /// Best class at a pixel, which need not be whole but must lie in the image.
  virtual PixelClass classAt(const Eigen::Vector2d& pixel) const = 0;
  /// The same class, and writes the distribution over the classes 0 … scores.size()−1: non-negative
  /// and summing to 1, with the shares of channels without a class taken out; all 0 if classAt()
  /// has no class. Logits are divided by `temperature` (> 0) before the softmax: above 1 is less
  /// sure. `confidence` is the best class's share in it; that of classAt() has temperature 1.
  /// Throws std::out_of_range if the image has a class that `scores` has no place for.
  virtual PixelClass scoresAt(const Eigen::Vector2d& pixel, double temperature,
                              std::vector<float>& scores) const = 0;
  /// Class of every pixel of the camera image: CV_16UC1 of size().
  virtual cv::Mat classes() const = 0;
};

/// An image of raw ids: CV_8UC1 or CV_16UC1, of the size of the camera image. The nearest pixel
/// counts, with confidence 1.
class LabelImage : public SemanticImage {
 public:
  /// Throws std::invalid_argument if `raw` is empty or of another type.
  LabelImage(const cv::Mat& raw, const RawToClass& class_of);

  /// The raw ids, as they were given.
  const cv::Mat& raw() const { return raw_; }
  cv::Size size() const override { return classes_.size(); }
  PixelClass classAt(const Eigen::Vector2d& pixel) const override;
  PixelClass scoresAt(const Eigen::Vector2d& pixel, double temperature,
                      std::vector<float>& scores) const override;
  cv::Mat classes() const override { return classes_.clone(); }

 private:
  cv::Mat raw_;
  cv::Mat classes_;
};

/// Where the grid of a network's output lies in a camera image: the pixel (u, v) has grid
/// coordinates (u·scale_x + offset_x, v·scale_y + offset_y), cell centres being whole numbers.
struct GridPlacement {
  double scale_x = 1;
  double scale_y = 1;
  double offset_x = 0;
  double offset_y = 0;
};

/// Scores of channels on a grid, as a network puts them out, interpolated bilinearly where they are
/// asked for; outside of the grid its border counts. The best class is that of the best channel,
/// even if other channels together say more for another class.
///
/// They are held as distances in log-score to the best channel of the cell, in steps of 1/16 and
/// at most 255/16 = 15.9 (a probability ratio of 1e-7): one byte a channel. Images in a cache are
/// exactly these bytes, so that a cached image gives the bits that the network gave.
class ScoreImage : public SemanticImage {
 public:
  static constexpr double kStep = 1.0 / 16;

  /// `distances`: CV_8UC1 with rows·channels rows: all rows of channel 0, then channel 1 … A cell
  /// whose distances are all 255 says nothing; pixels that no other cell reaches are kUnknownPixel.
  /// `class_of_channel` has one entry a channel; several channels may have the same class.
  /// `distances` are shared, not copied. Throws std::invalid_argument if the sizes do not fit.
  ScoreImage(const cv::Mat& distances, std::vector<ClassId> class_of_channel, cv::Size image_size,
             const GridPlacement& placement);

  /// From logits: CV_32F, channels × rows × columns (three dimensions). Log-probabilities are
  /// logits too, −∞ among them. A cell with a NaN or +∞, or nothing but −∞, says nothing.
  static cv::Mat computeDistances(const cv::Mat& logits);

  const cv::Mat& distances() const { return distances_; }
  cv::Size size() const override { return image_size_; }
  PixelClass classAt(const Eigen::Vector2d& pixel) const override;
  PixelClass scoresAt(const Eigen::Vector2d& pixel, double temperature,
                      std::vector<float>& scores) const override;
  cv::Mat classes() const override;

 private:
  class Sample;
  cv::Size gridSize() const;
  Sample sampleAt(const Eigen::Vector2d& pixel) const;
  PixelClass evaluate(const Eigen::Vector2d& pixel, double temperature,
                      std::vector<float>* scores) const;
  /// The best channel of each cell: CV_16UC1.
  cv::Mat bestChannels() const;

  cv::Mat distances_;
  std::vector<ClassId> class_of_channel_;
  cv::Size image_size_;
  GridPlacement placement_;
};

}  // namespace csom
