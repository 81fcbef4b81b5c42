// SPDX-License-Identifier: BSD-3-Clause
// Scores of channels on a grid: quantised, interpolated, turned into classes.
#include <csom/vision/SemanticImage.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core/utility.hpp>
#include <stdexcept>

namespace csom {
namespace {

/// The largest distance; all channels of a cell have it only where the cell says nothing.
constexpr int kFarthest = 255;
constexpr std::uint16_t kNoChannel = 0xffff;

/// The two cells around a coordinate, and the weight of the second: a multiple of 2⁻²⁰, with which
/// interpolation is exact and cells that agree stay exactly as good as they are.
struct Neighbours {
  int first;
  int second;
  double weight;
};

Neighbours neighboursAt(double coordinate, int cells) {
  constexpr double kSteps = 1 << 20;
  const double inside = std::rint(std::clamp(coordinate, 0.0, cells - 1.0) * kSteps) / kSteps;
  const int first = static_cast<int>(inside);
  return {first, std::min(first + 1, cells - 1), inside - first};
}

bool isClass(ClassId id) {
  return id != kIgnoredPixel && id != kUnknownPixel;
}

}  // namespace

/// The distances of all channels at one point of the grid.
class ScoreImage::Sample {
 public:
  Sample(const ScoreImage& image, const Neighbours& x, const Neighbours& y)
      : distances_(image.class_of_channel_.size()) {
    const std::size_t channel_stride =
        image.distances_.step * static_cast<std::size_t>(image.gridSize().height);
    const std::uint8_t* upper = image.distances_.ptr(y.first);
    const std::uint8_t* lower = image.distances_.ptr(y.second);
    for (std::size_t channel = 0; channel < distances_.size(); ++channel) {
      const double above = upper[x.first] * (1 - x.weight) + upper[x.second] * x.weight;
      const double below = lower[x.first] * (1 - x.weight) + lower[x.second] * x.weight;
      distances_[channel] = above * (1 - y.weight) + below * y.weight;
      if (distances_[channel] < distances_[best_]) best_ = channel;
      upper += channel_stride;
      lower += channel_stride;
    }
  }

  /// False if no cell says anything here.
  bool hasBest() const { return distances_[best_] < kFarthest; }
  /// Of equally good channels the first.
  std::size_t best() const { return best_; }
  /// Score of a channel relative to that of the best.
  float ratio(std::size_t channel, double temperature) const {
    const double distance = kStep * (distances_[channel] - distances_[best_]);
    return static_cast<float>(std::exp(-distance / temperature));
  }

 private:
  cv::AutoBuffer<double, 64> distances_;
  std::size_t best_ = 0;
};

ScoreImage::ScoreImage(const cv::Mat& distances, std::vector<ClassId> class_of_channel,
                       cv::Size image_size, const GridPlacement& placement)
    : distances_(distances),
      class_of_channel_(std::move(class_of_channel)),
      image_size_(image_size),
      placement_(placement) {
  const int channels = static_cast<int>(class_of_channel_.size());
  if (distances.empty() || distances.dims != 2 || distances.type() != CV_8UC1 || channels == 0 ||
      channels >= kNoChannel || distances.rows % channels != 0)
    throw std::invalid_argument("scores must be 8-bit, the same number of rows for each of " +
                                std::to_string(channels) + " channels");
  if (image_size.width <= 0 || image_size.height <= 0)
    throw std::invalid_argument("scores need the size of the image that they are of");
}

cv::Mat ScoreImage::computeDistances(const cv::Mat& logits) {
  if (logits.dims != 3 || logits.type() != CV_32FC1 || logits.empty())
    throw std::invalid_argument("logits must be channels × rows × columns of 32-bit numbers");
  const int channels = logits.size[0];
  const int rows = logits.size[1];
  const int columns = logits.size[2];
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kStepsPerUnit = static_cast<float>(1 / kStep);
  cv::Mat distances(channels * rows, columns, CV_8UC1);
  const auto width = static_cast<std::size_t>(columns);
  std::vector<float> best(width);
  for (int row = 0; row < rows; ++row) {
    std::fill(best.begin(), best.end(), -kInfinity);
    for (int channel = 0; channel < channels; ++channel) {
      const float* logit = logits.ptr<float>(channel, row);
      // A NaN or +∞ stays, as +∞; what is compared with it is no number, or infinitely far.
      for (std::size_t i = 0; i < width; ++i) {
        const float known = logit[i] < kInfinity ? logit[i] : kInfinity;
        best[i] = known > best[i] ? known : best[i];
      }
    }
    for (int channel = 0; channel < channels; ++channel) {
      const float* logit = logits.ptr<float>(channel, row);
      std::uint8_t* out = distances.ptr(channel * rows + row);
      for (std::size_t i = 0; i < width; ++i) {
        const float steps = (best[i] - logit[i]) * kStepsPerUnit + 0.5f;
        out[i] = static_cast<std::uint8_t>(steps < kFarthest ? static_cast<int>(steps) : kFarthest);
      }
    }
  }
  return distances;
}

cv::Size ScoreImage::gridSize() const {
  return {distances_.cols, distances_.rows / static_cast<int>(class_of_channel_.size())};
}

ScoreImage::Sample ScoreImage::sampleAt(const Eigen::Vector2d& pixel) const {
  const cv::Size grid = gridSize();
  return Sample(*this,
                neighboursAt(pixel.x() * placement_.scale_x + placement_.offset_x, grid.width),
                neighboursAt(pixel.y() * placement_.scale_y + placement_.offset_y, grid.height));
}

PixelClass ScoreImage::evaluate(const Eigen::Vector2d& pixel, double temperature,
                                std::vector<float>* scores) const {
  if (!(temperature > 0)) throw std::invalid_argument("a temperature must be greater than 0");
  if (scores != nullptr) std::fill(scores->begin(), scores->end(), 0.0f);
  const Sample sample = sampleAt(pixel);
  const ClassId id = sample.hasBest() ? class_of_channel_[sample.best()] : kUnknownPixel;
  if (!isClass(id)) return {id, 0};
  float sum = 0;
  float best = 0;
  for (std::size_t channel = 0; channel < class_of_channel_.size(); ++channel) {
    const ClassId channel_class = class_of_channel_[channel];
    if (!isClass(channel_class)) continue;
    const float ratio = sample.ratio(channel, temperature);
    sum += ratio;
    if (channel_class == id) best += ratio;
    if (scores != nullptr) scores->at(channel_class) += ratio;
  }
  if (scores != nullptr) {
    for (float& score : *scores) score /= sum;
  }
  return {id, best / sum};
}

PixelClass ScoreImage::classAt(const Eigen::Vector2d& pixel) const {
  return evaluate(pixel, 1, nullptr);
}

PixelClass ScoreImage::scoresAt(const Eigen::Vector2d& pixel, double temperature,
                                std::vector<float>& scores) const {
  return evaluate(pixel, temperature, &scores);
}

cv::Mat ScoreImage::bestChannels() const {
  const cv::Size grid = gridSize();
  cv::Mat best(grid, CV_16UC1, cv::Scalar(kNoChannel));
  std::vector<std::uint8_t> nearest(static_cast<std::size_t>(grid.width));
  for (int row = 0; row < grid.height; ++row) {
    std::fill(nearest.begin(), nearest.end(), std::uint8_t{kFarthest});
    std::uint16_t* out = best.ptr<std::uint16_t>(row);
    for (std::size_t channel = 0; channel < class_of_channel_.size(); ++channel) {
      const std::uint8_t* distance = distances_.ptr(static_cast<int>(channel) * grid.height + row);
      for (std::size_t i = 0; i < nearest.size(); ++i) {
        const bool better = distance[i] < nearest[i];
        nearest[i] = better ? distance[i] : nearest[i];
        out[i] = better ? static_cast<std::uint16_t>(channel) : out[i];
      }
    }
  }
  return best;
}

cv::Mat ScoreImage::classes() const {
  const cv::Size grid = gridSize();
  const cv::Mat best = bestChannels();
  std::vector<Neighbours> columns;
  columns.reserve(static_cast<std::size_t>(image_size_.width));
  for (int u = 0; u < image_size_.width; ++u)
    columns.push_back(neighboursAt(u * placement_.scale_x + placement_.offset_x, grid.width));
  cv::Mat classes(image_size_, CV_16UC1);
  for (int v = 0; v < image_size_.height; ++v) {
    const Neighbours y = neighboursAt(v * placement_.scale_y + placement_.offset_y, grid.height);
    const std::uint16_t* upper = best.ptr<std::uint16_t>(y.first);
    const std::uint16_t* lower = best.ptr<std::uint16_t>(y.second);
    ClassId* out = classes.ptr<ClassId>(v);
    for (const Neighbours& x : columns) {
      // Interpolation cannot change what is the best in all four cells: most pixels are done here.
      std::size_t channel = upper[x.first];
      if (upper[x.second] != channel || lower[x.first] != channel || lower[x.second] != channel) {
        const Sample sample(*this, x, y);
        channel = sample.hasBest() ? sample.best() : kNoChannel;
      }
      *out++ = channel == kNoChannel ? kUnknownPixel : class_of_channel_[channel];
    }
  }
  return classes;
}

}  // namespace csom
